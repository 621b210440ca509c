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
#include "app/navigate/finish_words.h"
#include "app/navigate/judged_plan.h"
#include "app/navigate/navigate_choices.h"
#include "app/navigate/navigate_panels.h"
#include "app/navigate/navigate_scene.h"
#include "app/navigate/navigate_setup.h"
#include "app/navigate/pose_sharing.h"
#include "app/navigate/resting_tip.h"
#include "app/navigate/started_source.h"
#include "app/navigate/theatre_bones.h"
#include "app/navigate/theatre_layout.h"
#include "app/sounds/player.h"
#include "app/sounds/sound_watch.h"
#include "navigation/operation/drilled_tunnels.h"

namespace arthronaut::navigate {

// Steps of an operation that have a screen of their own.
enum class Elsewhere { Plan, SetUp };

class NavigateView : public mode::Mode {
 public:
  // wake: ends the window's wait for input; called from other threads. turns: shared with whatever else opens
  // cameras. go_elsewhere: shows another mode. sharing: what other programs hear of it.
  NavigateView(std::function<void()> make_current, std::function<void()> wake,
               const sources::DeviceTurns& turns, std::function<void(Elsewhere)> go_elsewhere,
               std::shared_ptr<PoseSharing> sharing);
  ~NavigateView() override;

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"navigate."}; }
  // The model is read whenever an operation is started.
  void case_opened(const mode::OpenCase& opened) override;
  void enter() override;  // sees anew which videos the case has
  void add_actions(widgets::Actions& actions) override;
  void tick(double now_s) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  void on_screen() override;
  // While pictures come, or have come, nothing but them and what belongs to them is on the screen.
  [[nodiscard]] std::optional<widgets::Rect> header_in(const widgets::Ui& ui,
                                                       const widgets::Rect& window) const override;
  // Says why not where a source runs, or an exercise.
  void turn_to(bones::BoneKind bone);
  // The bone whose operation was cut off is chosen then.
  [[nodiscard]] bool asks_for_front() override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] bool has_running_work() const override { return is_running(); }
  [[nodiscard]] bool pictures_are_late() const override { return navigate::pictures_are_late(*live_); }
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override;
  [[nodiscard]] bool pictures_are_of_now() const override;
  [[nodiscard]] std::string notice() const override;
  [[nodiscard]] bool awaits_text() const override { return depth_.wants_focus() || cameras_.wants_text(); }

  // For a mode that borrows this screen for a source of its own, an exercise. Why it cannot on this bone:
  // something runs, a real operation was begun in this case, or nothing can be simulated; empty: it can.
  [[nodiscard]] std::string refusal_to_lend(bones::BoneKind bone);
  // Precondition: refusal_to_lend() is empty. From here to the next case_opened() this mode starts nothing of
  // its own, and says so; while next_step says something, that is asked for and the pedals do nothing.
  void lend(bones::BoneKind bone, theatre::TheatreSource source, std::function<std::string()> next_step);
  [[nodiscard]] const theatre::LiveStatePtr& live() const { return live_; }  // never null
  [[nodiscard]] const operation::OperationSetup* setup_in_use() const;       // null: no operation yet
  void ask(operation::Command command);
  void end_source();

 private:
  void start(theatre::TheatreSource source);
  void start_simulation(SimulatedPart part);
  void start_video();
  void start_live(const LivePictures& pictures);
  // The one camera that there is, is opened at once; else cameras and streams are offered.
  void choose_camera();
  void offer_cameras();
  void type_address();  // of a stream, a camera or an outside tracker
  // The same kind of source again: nothing but a key of its own ever changes the kind.
  void start_same_kind();
  void take_other_bone();
  // What is on offer now; null: nothing is, or something was begun.
  [[nodiscard]] const LeftBehind* left_behind();
  void resume();
  void decline_resume();
  // How pictures are begun now: "open the camera again".
  [[nodiscard]] std::string words_of_start() const;
  // One pedal: carries out what is a command, and starts nothing but the kind of source that was chosen.
  void take_next_step();
  void act(operation::NextAction action);
  [[nodiscard]] PedalContext pedal_context();
  [[nodiscard]] bool acts_now(const PedalStep& step) const;
  [[nodiscard]] bool covers_question() { return choices_.shows_menu && question() != Question::None; }
  [[nodiscard]] Question question();  // due now, shown or not
  // Of the operation that is shown; before the first source, of the one that would be real.
  [[nodiscard]] sources::SourceKind shown_kind() const;
  // By that kind of source, and as that very plan; null: nobody said so.
  [[nodiscard]] const operation::DrilledTunnel* drilled_as(const operation::PlannedTunnel& plan) const;
  [[nodiscard]] bool marker_is_out(bones::BoneKind bone) const;
  void finish_step(FinishAction action);
  void find_anew();
  [[nodiscard]] bool may_change_medium() const;
  void take_other_medium();
  // Another pedal: one step back, to do it again; after the first step the one of now is shown again.
  void take_step_back();
  [[nodiscard]] Repeat repeat_of(operation::Step step) const;
  void repeat_step(Repeat repeat);
  [[nodiscard]] RailContext rail_context() const;
  [[nodiscard]] Rail rail() const { return rail_of(*live_->operation, rail_context()); }
  // Every bone with a planned tunnel, the one that is navigated first.
  [[nodiscard]] std::vector<FinishedBone> finished_bones() const;
  [[nodiscard]] bool must_set_up() const;  // before pictures can be navigated
  [[nodiscard]] bool simulates() const;    // the source that is started next is the simulated operation
  [[nodiscard]] bool holds_simulated_probe() const;
  void take_touch(bool is_control_point);
  void add_registration_actions(widgets::Actions& actions);
  // Of two tunnels in one bone, which is drilled: tunnel_choice.cpp.
  void add_tunnel_actions(widgets::Actions& actions);
  void choose_tunnel(norms::Bundle bundle);
  // The one that a press of the pedal would choose, where the surgeon has to choose, or may go on to it.
  [[nodiscard]] std::optional<tunnels::TunnelKey> tunnel_to_choose() const;
  void add_answer_actions(widgets::Actions& actions);
  void add_picture_actions(widgets::Actions& actions);
  void cycle_overlay();
  void sound(double now_s);
  void follow_reached(const NavigateDisplay& display, double now_s);
  [[nodiscard]] bool refuses_while_lent();  // and says so
  void look_along_plan();
  // What the step waits for; empty: nothing, or its own words say it.
  [[nodiscard]] std::string missing_now(const PedalStep& step, const Rail& rail);
  [[nodiscard]] std::optional<operation::PlannedTunnel> plan_in_question();
  void judge_plans();  // that in force, and the one that waits to be taken over
  [[nodiscard]] std::string words_of_edited_plan() const;  // that waits to be taken over; empty: none does
  [[nodiscard]] std::string words_of_verdict() const;      // of the plan; empty: nothing speaks against it
  [[nodiscard]] std::string lent_step() const { return lent_ && lent_->next_step ? lent_->next_step() : ""; }
  [[nodiscard]] bool can_simulate() const;
  [[nodiscard]] bool is_running() const;
  [[nodiscard]] const operation::RegistrationState& registration() const {
    return *live_->operation->registration;
  }
  void read_live();
  [[nodiscard]] NavigateLayout layout(double now_s) const;
  [[nodiscard]] NavigateScreen screen_of(const NavigateDisplay& display, double now_s, bool by_processor);
  void note_states(const widgets::Ui& ui, const NavigateScreen& screen);
  [[nodiscard]] float overlay_opacity(double now_s) const;
  [[nodiscard]] bool takes_window() const { return live_->phase != theatre::LiveState::Phase::NoSource; }
  [[nodiscard]] TheatreLayout layout_in(const widgets::Ui& ui, const widgets::Rect& area) const;
  // Before a source runs, what begins one; everything else stands in the menu.
  void draw_controls(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_menu(const widgets::Ui& ui, const widgets::Rect& area, const NavigateScreen& screen);
  // What asks something: an operation that was left, the cameras, the time-out, the depth stop, the check
  // list at the end. False: nothing does.
  bool draw_questions(const widgets::Ui& ui, const TheatreLayout& layout);

  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  sources::DeviceTurns turns_;
  std::function<void(Elsewhere)> go_elsewhere_;
  NavigateScene scene_;
  VideoTextures video_;
  std::shared_ptr<PoseSharing> sharing_;  // also with operations that end behind the screen
  TheatreBones bones_;
  JudgedPlan judged_;         // of the chosen bone
  JudgedPlan judged_edited_;  // of the one that waits to be taken over
  ResumeOffer resume_;
  DepthEntry depth_;
  CameraChoice cameras_;
  struct Used {  // live, last
    LivePictures pictures;
    bool is_new_stream = false;  // and it gave no picture yet
  };
  std::optional<Used> used_before_;
  std::string patient_;  // in words; empty: not known
  NavigateChoices choices_;
  std::map<sources::SourceKind, operation::DrilledTunnels> drilled_;  // before and now
  struct Drawn {
    theatre::LiveStatePtr live;  // and not told to be on the screen yet; else null
    double since_s = 0;          // when that was begun
  } drawn_;
  double judged_s_ = 0;  // when it was judged whether live_ is of now: once for all that a frame shows
  theatre::LiveStatePtr live_ = TheatreBones::nothing();  // of this frame, of the chosen bone; never null
  RestingTip resting_;
  RegistrationWords words_;            // of its registration
  RegistrationWords words_of_before_;  // the same beside a picture that is not of now
  StartedSource started_;              // last
  sounds::SoundWatch heard_;
  sounds::Player player_;
  struct Lent {  // to an exercise: what was started last is its own; see lend()
    std::function<std::string()> next_step;
    double refused_s = -1e9;  // when something was refused because of that
  };
  std::optional<Lent> lent_;
  std::string notice_;
  PassingWords read_notice_;
};

}  // namespace arthronaut::navigate
