// A recorded session made ready for looking at: what happened when, frame by frame, and how the tunnel as
// drilled lies to the plan. Plain data, read once; no window.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/review/moments.h"
#include "app/widgets/controls.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/session_overview.h"
#include "navigation/recording/session_timeline.h"

namespace arthronaut::review {

// A stretch of frames, [first, last], in which something held.
struct Stretch {
  std::size_t first = 0, last = 0;
};

struct TimeTrack {
  std::string name;  // "Femur marker", "Probe", "Guidance", ...
  std::vector<Stretch> stretches;
  bool is_guidance = false;
};

// What guidance stood on, from a frame of the record on.
struct Standing {
  std::int64_t from_frame = -1;                                           // its index; -1: before the first
  recording::RecordedSession::PlanChange plan;                            // no tunnel where there was none
  std::shared_ptr<const registration::RegistrationSummary> registration;  // null: none yet, or void
};

// A tunnel as navigation measured it, and from where on there was one.
struct DrilledTunnel {
  operation::AchievedTunnel achieved;
  // As deep as it was drilled; where nobody knows that, as it was planned when it was. 0: that is not known
  // either, and it is not drawn.
  double length_mm = 0;
  std::int64_t from_frame = -1;  // of a record that does not say it: before the first
};

struct SessionReview {
  std::filesystem::path folder;
  std::shared_ptr<const recording::SessionOverview> session;   // never null
  std::shared_ptr<const recording::SessionTimeline> timeline;  // its frames; never null
  // Opened while the time line was read, for the one thread that fetches (picture_fetcher.h); null where it
  // could not be: who opens it is told why.
  std::shared_ptr<recording::RecordedPictures> pictures;
  std::vector<Moment> moments;
  std::vector<TimeTrack> tracks;
  // Rising, and never empty. Not what the case plans by now.
  std::vector<Standing> standings = {{}};
  std::vector<DrilledTunnel> drilled;  // none, one, or those of two bundles
  // Of session->curves, so many points were drawn in sessions before this one, by their clocks.
  std::size_t points_of_before = 0;
  std::string
      achieved_problem;  // why one of their files could not be read; empty when it was or is not there
  // What is missing or broken of the session: the rest is shown. Empty where nothing is.
  std::vector<std::string> problems;

  // Some registration of it lays the strokes on the bone. Without one they are known in the world marker's
  // frame alone.
  [[nodiscard]] bool has_pose() const;
  // At the frame of that index.
  [[nodiscard]] const Standing& standing_at(std::int64_t frame_index) const;
  // Those that are to be drawn there: drilled by then, and of a length that is known.
  [[nodiscard]] std::vector<const DrilledTunnel*> drilled_at(std::int64_t frame_index) const;
  // Of session->curves, what was drawn by that time: the first of them. What was taken back or cleared
  // later on is not among them, since the record's curves are those of its end.
  [[nodiscard]] std::span<const strokes::CurvePoint> drawn_until(std::int64_t timestamp_ns) const;
};

// As far as the session is whole. Throws IoError or InvalidInput where nothing can be shown of it: no header,
// or no record of its frames.
[[nodiscard]] SessionReview read_review(const std::filesystem::path& session_folder);

// What guided in that picture, and whether it did in the one after it: what registered with that picture says
// so, as what ended there does.
struct RegistrationRow {
  widgets::Severity severity = widgets::Severity::Quiet;
  std::string text;
};
[[nodiscard]] RegistrationRow registration_row(const SessionReview& review, std::int64_t frame_index);

// What the pictures of a session are, in words to be read from across the room: "RECORDING of a simulation";
// of older records, which do not say it, "RECORDING".
[[nodiscard]] std::string origin_in_words(const recording::SessionHeader& header);

// Stretches of consecutive frames for which `holds`; gaps of up to `bridge` frames are closed.
[[nodiscard]] std::vector<Stretch> stretches_of(const std::vector<bool>& holds, std::size_t bridge);

}  // namespace arthronaut::review
