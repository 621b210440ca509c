// Review mode: the sessions of the case, their time line, and picture, 3D view and numbers at any moment of
// it.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/mode/mode.h"
#include "app/review/picture_fetcher.h"
#include "app/review/session_review.h"
#include "app/widgets/controls.h"
#include "app/widgets/scene_pane.h"
#include "app/widgets/video_texture.h"

namespace arthronaut::review {

// Where on the time line the user is, and whether it plays.
struct ReviewCursor {
  std::size_t frame = 0;
  bool plays = false;
  double play_started_s = 0, play_from_s = 0;
};

class ReviewView : public mode::Mode {
 public:
  ReviewView(std::function<void()> make_current, std::function<void()> wake);

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"review."}; }
  void case_opened(const mode::OpenCase& opened) override;
  void enter() override;  // reads the list of sessions again; chooses the newest where none is chosen
  void add_actions(widgets::Actions& actions) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] bool is_busy() const override;
  // Whatever a session was made of, what is shown of it is a recording; draw_origin() says what of.
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override;
  [[nodiscard]] std::string notice() const override { return notice_; }

 private:
  void choose(std::size_t session);
  void take_opened();
  void play(double now_s);
  void step(long frames);
  [[nodiscard]] bool has_frames() const;
  void draw_sessions(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_origin(const widgets::Ui& ui, const widgets::Rect& area) const;
  void draw_picture(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_scene(const widgets::Ui& ui, const widgets::Rect& area);
  void show_scene();

  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  std::function<void()> wake_;
  widgets::ScenePane pane_;
  widgets::VideoTexture video_;
  std::vector<std::filesystem::path> sessions_;
  std::optional<std::size_t> chosen_;
  std::future<SessionReview> opening_;
  std::optional<SessionReview> review_;
  std::unique_ptr<PictureFetcher> pictures_;
  ReviewCursor cursor_;
  std::optional<std::size_t> shown_frame_;  // of the 3D view
  std::string notice_;
};

// Tracks, events and the cursor; returns the frame that the mouse asks for.
[[nodiscard]] std::optional<std::size_t> draw_time_line(const widgets::Ui& ui, const widgets::Rect& area,
                                                        const SessionReview& review,
                                                        const ReviewCursor& cursor);
// The numbers of this moment, the registration, and planned against achieved.
void draw_moment(const widgets::Ui& ui, const widgets::Rect& area, const SessionReview& review,
                 std::size_t frame);

}  // namespace arthronaut::review
