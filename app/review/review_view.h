// Review mode: the sessions of the case, their time line, and picture, 3D view, bullseye and numbers at any
// moment of it; what happened, marks with notes, and what today's program makes of the same pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/mode/mode.h"
#include "app/review/check_run.h"
#include "app/review/picture_fetcher.h"
#include "app/review/postop_page.h"
#include "app/review/report_run.h"
#include "app/review/review_panels.h"
#include "app/review/session_list.h"
#include "app/widgets/scene_pane.h"
#include "app/widgets/video_texture.h"
#include "navigation/recording/declined_resume.h"
#include "navigation/worker/awaited.h"
#include "navigation/worker/letting_go.h"

namespace arthronaut::review {

// The session that is looked at, and everything that belongs to looking at it.
struct OpenSession {
  SessionReview review;
  std::unique_ptr<PictureFetcher> pictures;  // null: no video was kept
  MarkBook marks;
  Playback playback;
  TimeLineZoom zoom;
  std::unique_ptr<TodayRun> today;         // null: was not asked for
  std::optional<training::Score> score;    // of an exercise whose score was kept
  std::unique_ptr<CheckRun> check;         // whether it is as it was recorded; never null once it is open
  std::optional<std::size_t> shown_frame;  // of the 3D view
  std::size_t shown_points = 0;            // of the session's curves, likewise
  bool shows_off_bone = false;             // some of these do not lie on the bone
  bool can_be_resumed = false;             // it was declined, and no newer session of its bone decides

  [[nodiscard]] const recording::SessionTimeline& timeline() const { return *review.timeline; }
  [[nodiscard]] const recording::FrameGlance& glance() const { return timeline().frames()[playback.frame]; }
  [[nodiscard]] const Standing& standing() const { return review.standing_at(glance().index); }
};

// Leaves it: what computes of it is told to stop, and waited for beside the screen. No effect for null.
void let_go(std::unique_ptr<OpenSession> session, worker::LettingGo& letting_go);

class ReviewView : public mode::Mode {
 public:
  // to_theatre: shows Navigate, turned to that bone.
  ReviewView(std::function<void()> make_current, std::function<void()> wake,
             std::function<void(bones::BoneKind)> to_theatre);

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"review."}; }
  void case_opened(const mode::OpenCase& opened) override;
  void enter() override;  // reads the list of sessions again; chooses the newest where none is chosen
  void leave() override { pane_.let_go_of_picture(); }
  void add_actions(widgets::Actions& actions) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] bool awaits_text() const override { return note_.takes_focus || postop_.awaits_text(); }
  // A comparison or a report that another case or the end of the program would cut off.
  [[nodiscard]] bool has_running_work() const override { return postop_.is_running() || is_writing_report(); }
  // Images after the operation, dropped on the window: compared with the plan.
  void take_dropped(const std::filesystem::path& images, const std::string& series = {});
  // Whatever a session was made of, what is shown of it is a recording; draw_origin() says what of.
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override;
  [[nodiscard]] std::string notice() const override { return notice_; }
  [[nodiscard]] std::vector<mode::HeldKeys> held_keys() const override {
    return {{"Left button", "Dragged over the 3D view: turns it"},
            {"Right button", "Dragged over it: shifts it; the wheel goes nearer and farther"}};
  }

 private:
  // The field in which the note of a mark is written.
  struct NoteField {
    bool is_open = false, takes_focus = false;
    std::string text;
    recording::SessionMark at = {};  // the moment that it was begun for, wherever one looks meanwhile
  };
  void choose(std::size_t session);
  void follow_recording(double now_s);
  void draw_end(const widgets::Ui& ui) const;
  void look_at(std::size_t session);  // as the user chooses one: in the place of a CT after the operation
  void take_opened();
  void look_at_tunnel();
  void step(long frames);
  void jump(bool forward);
  void add_playing_actions(widgets::Actions& actions);
  void add_mark_actions(widgets::Actions& actions);
  void add_postop_actions(widgets::Actions& actions);
  void add_folder_actions(widgets::Actions& actions);
  void begin_mark();
  void keep_mark();
  // A change that the disk refuses is told, and the marks stay as they were.
  void change_marks(const std::function<void(MarkBook&)>& change);
  void toggle_today();
  void add_resume_action(widgets::Actions& actions);
  [[nodiscard]] bool can_be_resumed() const {  // precondition: open_
    return read_only_.empty() && recording::can_be_taken_back(case_folder_, open_->review.folder);
  }
  void resume();
  [[nodiscard]] bool has_frames() const;
  [[nodiscard]] bool shows_frames() { return has_frames() && !shows_postop_; }
  [[nodiscard]] bool runs_today() const;
  // Keys are meant for the folders in which a CT is looked for.
  [[nodiscard]] bool browses() { return shows_postop_ && postop_.browser() != nullptr; }
  // Whether it is written, and the plan is still the one that it tells of.
  [[nodiscard]] bool is_report_of_now() const;
  [[nodiscard]] bool is_writing_report() const { return report_ != nullptr && !report_->has_ended(); }
  [[nodiscard]] ReviewScreen screen() const;
  void draw_side(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_buttons(const widgets::Ui& ui);
  void draw_note_field(const widgets::Ui& ui);
  void draw_picture(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_scene(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_numbers(const widgets::Ui& ui, widgets::Rect area);
  [[nodiscard]] std::string no_report_reason();  // empty: one may be written
  void find_score();
  void show_scene();
  [[nodiscard]] bool shows_strokes_alone() const;  // without a bone, which no registration has found
  // Strokes by where they lie: what is known not to lie on the bone is not drawn as if it did.
  struct LaidStrokes {
    std::shared_ptr<const registration::RegistrationSummary> by;
    struct Point {
      Eigen::Vector3d in_bone_mm;
      bool is_off_bone;
    };
    std::vector<Point> points;  // as in the session's curves
  };
  const LaidStrokes& laid_by(const std::shared_ptr<const registration::RegistrationSummary>& registration);
  [[nodiscard]] bool is_of_another_surface() const;  // than the case has of its bone by now

  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  std::string read_only_;
  std::function<void()> wake_;
  std::function<void(bones::BoneKind)> to_theatre_;
  widgets::ScenePane pane_;
  widgets::VideoTexture video_;
  SessionList sessions_;
  std::optional<std::size_t> chosen_;
  worker::Awaited<SessionReview> opening_;
  bool opens_for_another_case_ = false;  // what opening_ reads is of the case that was open before
  std::unique_ptr<OpenSession> open_;    // null: none
  std::optional<LaidStrokes> laid_;      // of the session that is open
  std::map<std::filesystem::path, std::unique_ptr<TodayRun>> todays_;  // of sessions looked at before; ended
  std::unique_ptr<ReportRun> report_;                                  // null: none was asked for
  std::string no_report_;                      // why the one that was asked for last was not begun
  double looked_at_end_s_ = -1;                // whether what is being recorded has ended
  std::optional<std::int64_t> comes_back_to_;  // the frame that was looked at before it was read again
  NoteField note_;
  PostopPage postop_;
  bool shows_postop_ = false;  // in the place of the session
  std::string notice_;
  worker::LettingGo letting_go_;  // of sessions that were left, and of reports that another case cut off
};

}  // namespace arthronaut::review
