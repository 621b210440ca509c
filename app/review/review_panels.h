// The panels of Review. Each reads and draws; what the mouse asks for is given back.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/review/playback.h"
#include "app/review/review_marks.h"
#include "app/review/session_review.h"
#include "app/review/today_run.h"
#include "app/widgets/controls.h"
#include "navigation/training/score.h"
#include "planning/postop/comparison.h"

namespace arthronaut::review {

class CheckRun;
class ReportRun;
class SessionList;

// What the panels read. Preconditions: the session has frames.
struct ReviewScreen {
  const SessionReview& review;
  const recording::SessionMarks& marks;
  const Playback& playback;
  const TodayResult* today = nullptr;      // null: today's program was not run on it
  const training::Score* score = nullptr;  // of an exercise; null: it is none, or none was kept
  // What a CT after the operation showed; null or empty: none was compared.
  const std::map<tunnels::TunnelKey, postop::Comparison>* ct = nullptr;

  [[nodiscard]] const recording::SessionTimeline& timeline() const { return *review.timeline; }
  [[nodiscard]] const recording::RecordedFrame& frame() const {
    return review.timeline->frame(playback.frame);
  }
  // Why there was no guidance at this moment, or that the record of it is damaged: then nobody knows.
  [[nodiscard]] std::string no_guidance_words() const {
    const recording::RecordedFrame& at = frame();
    return review.timeline->is_readable(playback.frame) ? std::string(guidance::to_text(at.guidance.state))
                                                        : "this frame's record is damaged";
  }
  // What guidance stood on at this moment.
  [[nodiscard]] const Standing& standing() const {
    return review.standing_at(review.timeline->frames()[playback.frame].index);
  }
};

// Which part of the session the time line shows, as shares of its frames.
struct TimeLineZoom {
  double from = 0, to = 1;
};
// Nearer or farther about a place of the time line (0 left, 1 right): factor < 1 shows less. At least
// `least` of the session, all of it at most.
[[nodiscard]] TimeLineZoom zoomed(const TimeLineZoom& zoom, double about, double factor, double least);

// Where the guide was further off than the offset's strip shows: there the strip tells no number.
[[nodiscard]] std::vector<Stretch> beyond_strip(const std::vector<recording::FrameGlance>& frames,
                                                double shown_mm);

// From left to right, pixels.
struct Span {
  float from = 0, to = 0;
};
// What of it is shown; nullopt: nothing.
[[nodiscard]] std::optional<Span> within(const Span& span, const Span& shown);

struct NoteRoom {
  float from = 0, to = 0;  // free of other notes, within the panel
};
// Where a mark's note begins: to its right, or to its left where it would run out of the panel. Pixels.
[[nodiscard]] float note_left(float mark_x, float width, float gap, const NoteRoom& room);

// Tracks, offset, what happened, marks, differences and the cursor; the frame that the mouse asks for. The
// wheel zooms.
[[nodiscard]] std::optional<std::size_t> draw_time_line(const widgets::Ui& ui, const widgets::Rect& area,
                                                        const ReviewScreen& screen, TimeLineZoom& zoom);
// Everything that happened, and every mark, as a list; the frame of the one that was clicked on.
[[nodiscard]] std::optional<std::size_t> draw_moments(const widgets::Ui& ui, const ReviewScreen& screen);
// The same of a session without frames, in which there is nowhere to go.
void draw_moments_without_frames(const widgets::Ui& ui, const std::vector<Moment>& moments);
// The guide against the plan as the surgeon saw it; nothing where it was not shown. axes: of the bone.
void draw_bullseye(const widgets::Ui& ui, const widgets::Rect& area, const ReviewScreen& screen,
                   const landmarks::AnatomicalAxes& axes);
// The numbers of this moment, the registration, today's numbers beside them, and planned against achieved.
void draw_moment(const widgets::Ui& ui, const widgets::Rect& area, const ReviewScreen& screen);
// Whether the record is as it was recorded; reasons name the files within the session alone.
void draw_check(const widgets::Ui& ui, const CheckRun& run, const SessionList& sessions);
// By which calibration it was recorded; nothing where that is not known.
void draw_camera(const widgets::Ui& ui, const SessionReview& review);
// What it was recorded of: as large as the word in the bar above, and in its colour, since what a recording
// is of changes nothing of what it is.
void draw_origin(const widgets::Ui& ui, const widgets::Rect& area, const recording::SessionHeader& header);
// Of whichever session it was asked for: its file names it. null: none was. refusal: why the one that was
// asked for last was not begun. Of a plan that was changed since (not of now) it is no tick.
void draw_report(const widgets::Ui& ui, const ReportRun* report, const std::string& refusal, bool is_of_now);

}  // namespace arthronaut::review
