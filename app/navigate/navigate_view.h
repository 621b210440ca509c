// Navigation mode: the live picture with the plan on it, beside it the guide relative to the plan, numbers
// and states. Made to be worked by three keys of a pedal: Space does the next sensible step.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "app/case/plan_model.h"
#include "app/mode/mode.h"
#include "app/navigate/beginning_panel.h"
#include "app/navigate/camera_choice.h"
#include "app/navigate/navigate_choices.h"
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
  [[nodiscard]] bool awaits_text() const override { return depth_.wants_focus() || cameras_.wants_text(); }

 private:
  void start(theatre::TheatreSource source);
  void start_simulation(SimulatedPart part);
  void start_video();
  void start_live(const LivePictures& pictures);
  // The one camera that there is, is opened at once; else cameras and streams are offered.
  void choose_camera();
  // The same kind of source again: nothing but a key of its own ever changes the kind.
  void start_same_kind();
  void end_source();
  void take_other_bone();
  // What is on offer now; null: nothing is, or something was begun.
  [[nodiscard]] const LeftBehind* left_behind();
  void resume();
  void decline_resume();
  void take_next_step();
  void ask(operation::Command command);
  void take_touch(bool is_control_point);
  void add_registration_actions(widgets::Actions& actions);
  // Of two tunnels in one bone, which is drilled: tunnel_choice.cpp.
  void add_tunnel_actions(widgets::Actions& actions);
  void choose_tunnel(norms::Bundle bundle);
  // What to choose, in words; empty where nothing is.
  [[nodiscard]] std::string tunnel_to_choose() const;
  // Another plan than the one in force is offered to an operation that runs, and nothing stands before it.
  [[nodiscard]] bool waits_for_take_over() const;
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

  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  sources::DeviceTurns turns_;
  NavigateScene scene_;
  VideoTextures video_;
  TheatreBones bones_;
  ResumeOffer resume_;
  DepthEntry depth_;
  CameraChoice cameras_;
  std::optional<LivePictures> used_before_;  // live, last
  bool stream_is_new_ = false;               // that, and it gave no picture yet
  std::string patient_;                      // in words; empty: not known
  NavigateChoices choices_;
  theatre::LiveStatePtr live_ = TheatreBones::nothing();  // of this frame, of the chosen bone; never null
  RegistrationWords words_;                               // of its registration
  std::optional<SimulatedPart> part_;                     // of the simulation that was started last
  std::optional<sources::SourceKind> kind_;  // of the source that was started last; empty: none yet
  std::map<bones::BoneKind, sources::SourceKind> started_;  // the same, of each bone's
  bool stops_once_open_ = false;  // the source that is being opened is not wanted any more
  std::string notice_;
};

}  // namespace arthronaut::navigate
