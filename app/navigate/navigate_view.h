// Navigation mode: the live picture with the plan on it, beside it the guide relative to the plan, numbers
// and states. Made to be worked by three keys of a pedal: Space does the next sensible step.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "app/case/plan_model.h"
#include "app/mode/mode.h"
#include "app/navigate/beginning_panel.h"
#include "app/navigate/navigate_panels.h"
#include "app/navigate/navigate_scene.h"
#include "app/navigate/navigate_setup.h"
#include "app/navigate/theatre_bones.h"

namespace arthronaut::navigate {

class NavigateView : public mode::Mode {
 public:
  // wake: ends the window's wait for input; called from other threads. turns: shared with whatever else opens
  // cameras.
  NavigateView(std::function<void()> make_current, std::function<void()> wake,
               const sources::DeviceTurns& turns);
  ~NavigateView() override;

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"navigate."}; }
  // The model is read whenever an operation is started.
  void case_opened(const mode::OpenCase& opened) override;
  void enter() override;  // sees anew which videos the case has
  void add_actions(widgets::Actions& actions) override;
  void tick(double now_s) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] bool has_running_work() const override { return is_running(); }
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override;
  [[nodiscard]] std::string notice() const override { return notice_; }
  [[nodiscard]] bool awaits_text() const override { return depth_.wants_focus(); }

 private:
  void start(theatre::TheatreSource source);
  void start_simulation(SimulatedPart part);
  void start_video();
  void start_camera(const sources::ConnectedCamera& camera);
  // One camera is opened at once, several are offered, none is told.
  void choose_camera();
  // The same kind of source again: nothing but a key of its own ever changes the kind.
  void start_same_kind();
  void end_source();
  // What is on offer now; null: nothing is, or something was begun.
  [[nodiscard]] const LeftBehind* left_behind();
  void resume();
  void decline_resume();
  void take_next_step();
  void ask(operation::Command command);
  void take_touch(bool is_control_point);
  void add_registration_actions(widgets::Actions& actions);
  void add_answer_actions(widgets::Actions& actions);
  void cycle_overlay();
  void look_along_plan();
  [[nodiscard]] std::string next_step();
  [[nodiscard]] bool can_simulate() const;
  [[nodiscard]] bool is_running() const;
  [[nodiscard]] const operation::RegistrationState& registration() const {
    return *live_->operation->registration;
  }
  void read_live();
  [[nodiscard]] NavigateLayout layout(double now_s) const;
  [[nodiscard]] NavigateScreen screen_of(const NavigateDisplay& display, double now_s);
  void note_states(const widgets::Ui& ui, const NavigateScreen& screen);
  [[nodiscard]] float overlay_opacity(double now_s) const;
  void draw_controls(const widgets::Ui& ui, const widgets::Rect& area);
  // What asks something: an operation that was left, the cameras, the time-out, the depth stop.
  void draw_questions(const widgets::Ui& ui, const widgets::Rect& video);
  void draw_cameras(const widgets::Ui& ui, const widgets::Rect& area) const;

  struct Choices {
    bones::BoneKind bone = bones::BoneKind::Femur;
    bool saline = true;
    std::vector<std::filesystem::path> videos;  // of the case, when this mode was entered
    std::size_t video = 0;                      // the next of those
    bool overlay_on = true;
    double overlay_shown_at_s = 0;
    bool undistorts = false;
    std::optional<NavigateLayout> layout;           // empty: as things stand
    double guidance_seen_s = -1e9;                  // when guidance was valid last
    int stroke = -1;                                // selected
    std::vector<sources::ConnectedCamera> cameras;  // on offer now; empty: none
    std::size_t camera = 0;                         // of those
  };

  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  sources::DeviceTurns turns_;
  NavigateScene scene_;
  VideoTextures video_;
  TheatreBones bones_;
  ResumeOffer resume_;
  DepthEntry depth_;
  std::string patient_;  // in words; empty: not known
  Choices choices_;
  theatre::LiveStatePtr live_ = TheatreBones::nothing();  // of this frame, of the chosen bone; never null
  RegistrationWords words_;                               // of its registration
  std::optional<SimulatedPart> part_;                     // of the simulation that was started last
  std::optional<sources::SourceKind> kind_;  // of the source that was started last; empty: none yet
  std::string notice_;
};

}  // namespace arthronaut::navigate
