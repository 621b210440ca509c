#include "app/navigate/navigate_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/navigate/known_streams.h"
#include "app/navigate/overlay_lines.h"
#include "app/scene/scene_camera.h"
#include "navigation/camera/medium.h"
#include "navigation/sources/connected_cameras.h"
#include "navigation/sources/source_files.h"
#include "planning/cases/identity.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::navigate {

namespace {

using operation::NextAction;
using Phase = theatre::LiveState::Phase;

constexpr double kGuideAway_s = 2;

}  // namespace

NavigateView::NavigateView(std::function<void()> make_current, std::function<void()> wake,
                           const sources::DeviceTurns& turns)
    : turns_(turns), scene_(std::move(make_current)), bones_(wake), resume_(wake) {}
NavigateView::~NavigateView() = default;

mode::ModeTitle NavigateView::title() const {
  return {"navigate", "mode.navigate", "Navigate", "In theatre", GLFW_KEY_F2};
}

std::optional<sources::SourceKind> NavigateView::source_kind() const {
  if (live_->phase == Phase::NoSource) return std::nullopt;
  // Before its first picture, or where it gives none, the operation knows of the source before it alone.
  const auto started = started_.find(choices_.bone);
  if (live_->picture == nullptr) return started != started_.end() ? std::optional(started->second) : kind_;
  return live_->operation->source->kind;
}

void NavigateView::case_opened(const mode::OpenCase& opened) {
  bones_.open(opened.model, opened.folder, opened.read_only);
  live_ = TheatreBones::nothing();
  words_ = {};
  part_.reset();
  kind_.reset();
  started_.clear();
  stops_once_open_ = false;
  choices_ = {};
  notice_.clear();
  model_ = opened.model;
  case_folder_ = opened.folder;
  depth_ = {};
  cameras_.close();
  resume_.open(*opened.model, opened.folder, !opened.read_only.empty());
  patient_.clear();
  try {  // who it is is never guessed: what cannot be read is said
    if (const auto identity = cases::load_identity(case_folder_)) patient_ = identity->in_words();
  } catch (const std::runtime_error& error) {
    notice_ = error.what();
  }
  if (!model_->has_bone(choices_.bone)) choices_.bone = bones::BoneKind::Tibia;
  look_along_plan();
}

void NavigateView::enter() { choices_.videos = sources::videos_in(case_folder_); }

void NavigateView::end_source() {
  choices_.guidance_seen_s = -1e9;
  notice_.clear();
  // Nothing cuts an opening short; it ends right after it, before its first picture.
  stops_once_open_ = live_->phase == Phase::Starting;
  if (theatre::LiveOperation* const operation = bones_.known(choices_.bone)) operation->end_source();
}

void NavigateView::take_other_bone() {
  if (is_under_way(*live_)) {
    notice_ = "Stop the source first, then take the other bone";
    return;
  }
  choices_.take_other_bone();
  cameras_.close();
  notice_.clear();
  part_.reset();
  depth_ = {};
  read_live();  // what is asked next is asked of this bone
  look_along_plan();
}

void NavigateView::start(theatre::TheatreSource source) {
  notice_.clear();
  choices_.layout.reset();
  cameras_.close();
  choices_.guidance_seen_s = -1e9;
  stops_once_open_ = false;
  kind_ = started_[choices_.bone] = source.setup.kind;
  part_.reset();
  resume_.answer(choices_.bone);  // it begins: afresh, unless it was resumed
  bones_.used(choices_.bone).start(std::move(source));
  read_live();
  choices_.overlay_shown_at_s = theatre::LiveOperation::now_s();
  look_along_plan();
}

void NavigateView::ask(operation::Command command) { bones_.used(choices_.bone).apply(std::move(command)); }

void NavigateView::start_simulation(SimulatedPart part) {
  try {
    start(simulated_setup(*model_, *bones_.guided(choices_.bone), case_folder_, part));
    part_ = part;
  } catch (const std::runtime_error& error) {  // as in start_video()
    notice_ = error.what();
  }
}

void NavigateView::start_video() {
  enter();
  if (choices_.videos.empty()) {
    notice_ = "There is no video in the folder of the case";
    return;
  }
  choices_.video %= choices_.videos.size();
  try {
    start(video_setup(*model_, choices_.bone, case_folder_, choices_.videos[choices_.video],
                      choices_.saline ? camera::kSalineIndex : camera::kAirIndex));
    ++choices_.video;
  } catch (const std::runtime_error& error) {  // a file that cannot be used is a notice on this screen
    notice_ = error.what();
  }
}

void NavigateView::start_live(const LivePictures& pictures) {
  try {
    start(camera_setup(*model_, choices_.bone, case_folder_, pictures, turns_,
                       choices_.saline ? camera::kSalineIndex : camera::kAirIndex));
    used_before_ = pictures;
    stream_is_new_ = !pictures.device;
  } catch (const std::runtime_error& error) {
    notice_ = error.what();
    cameras_.close();
  }
}

void NavigateView::choose_camera() {
  if (cameras_.is_open()) return cameras_.choose_next();
  cameras_.open(sources::connected_cameras(), load_known_streams(known_streams_file()), used_before_);
  if (const auto only = cameras_.chosen(); only && only->device && cameras_.count() == 1) start_live(*only);
}

bool NavigateView::is_running() const { return live_->phase == Phase::Running; }

bool NavigateView::can_simulate() const {
  if (model_ == nullptr) return false;
  const auto key = bones_.guided(choices_.bone);
  return key && missing_for_simulation(*model_, *key).empty();
}

void NavigateView::start_same_kind() {
  if (!kind_) {
    // Nothing was chosen yet. The built-in knee has nothing but its simulation; a real case never starts one.
    if (can_simulate() && !has_real_scope(case_folder_)) return start_simulation(SimulatedPart::Scratch);
    if (!choices_.videos.empty()) return start_video();
    return choose_camera();
  }
  switch (*kind_) {
    case sources::SourceKind::Live:
      return choose_camera();
    case sources::SourceKind::Recording:
      return start_video();
    case sources::SourceKind::Simulation:
      return start_simulation(registration().in_force.standing == operation::Standing::Stands
                                  ? SimulatedPart::Drill
                                  : SimulatedPart::Scratch);
  }
}

const LeftBehind* NavigateView::left_behind() {
  const bool has_begun = live_->phase != Phase::NoSource || live_->operation->resumed != nullptr;
  return has_begun ? nullptr : resume_.of(choices_.bone);
}

// One step. What is brought back guides nothing until a touch; the source is the next step, of the same kind.
void NavigateView::resume() {
  const LeftBehind* const left = left_behind();
  if (left == nullptr) return;
  kind_ = sources::source_kind_from_text(left->found.header.source_kind);
  // Who resumes it was told by which tunnel.
  if (const auto& was = left->found.operation.plan;
      was && bones_.guided(choices_.bone) != was->tunnel.key() && bones_.planned(was->tunnel.key()))
    bones_.choose(was->tunnel.key());
  ask(left->found.operation);
  notice_ = left->found.operation.registration
                ? "Resumed: what guided before guides again after one touch on the bone"
                : "Resumed without a registration: " + left->found.refusal;
  log::info("resumed: session " + left->found.operation.session);
  resume_.answer(choices_.bone);
}

void NavigateView::decline_resume() {
  if (const LeftBehind* const left = left_behind())
    log::info("not resumed: session " + left->found.operation.session);
  resume_.answer(choices_.bone);
}

std::string NavigateView::next_step() {
  if (model_ == nullptr) return "open a case";
  if (resume_.is_looking()) return "wait: the case's last operation is looked for";
  if (left_behind() != nullptr) return "resume the operation that was left";
  if (cameras_.is_open()) {
    const auto pictures = cameras_.chosen();
    return pictures ? "open " + pictures->name : "type the address of a stream, then Enter";
  }
  const NextAction action = live_->operation->next_action;
  if (const std::string choice = tunnel_to_choose(); !choice.empty()) return choice;
  const auto guided = bones_.guided(choices_.bone);
  if (!guided) return words_of(NextAction::PlanTunnel);
  if (waits_for_take_over() && guided->bundle != norms::Bundle::Whole)
    return "take over the tunnel " + tunnels::name_of(*guided);
  if (live_->phase == Phase::Starting)
    return stops_once_open_ ? "wait: it stops once it is open" : "wait for the first picture";
  const bool starts = action == NextAction::StartSource || action == NextAction::PlanTunnel;
  if (!starts) return words_of(action);
  const bool simulates =
      kind_ ? *kind_ == sources::SourceKind::Simulation : can_simulate() && !has_real_scope(case_folder_);
  const bool stands = registration().in_force.standing == operation::Standing::Stands;
  if (simulates) return stands ? "drill (simulation)" : "start the simulated operation";
  if (kind_ == sources::SourceKind::Live) return "open the camera again";
  return kind_ || !choices_.videos.empty() ? "open the next video" : "choose a camera";
}

// One pedal: carries out what is a command, and starts nothing but the kind of source that was chosen.
void NavigateView::take_next_step() {
  if (cameras_.is_open()) {
    if (const auto pictures = cameras_.chosen()) start_live(*pictures);
    return;
  }
  if (resume_.is_looking()) return;
  if (left_behind() != nullptr) return resume();
  if (live_->phase == Phase::Starting || !bones_.guided(choices_.bone)) return;
  if (waits_for_take_over()) return ask(operation::TakePlanOver{});
  switch (live_->operation->next_action) {
    case NextAction::StartSource:
    case NextAction::PlanTunnel:  // of an operation that was not told yet of the plan that is there
      return start_same_kind();
    case NextAction::ConfirmTimeOut:
      return ask(operation::ConfirmTimeOut{!patient_.empty()});
    case NextAction::Draw:
    case NextAction::RegisterAnew:
      return ask(operation::Draw{true});
    case NextAction::RegisterStrokes:
      return ask(operation::RegisterStrokes{});
    case NextAction::TakePlanOver:
      return ask(operation::TakePlanOver{});
    case NextAction::ConfirmByTouch:
    case NextAction::VerifyByTouch:
      return take_touch(false);
    case NextAction::CheckWorldMarker:
    case NextAction::SetControlPoint:
    case NextAction::CheckControlPoint:
      return take_touch(true);
    case NextAction::CheckGuide:
      return ask(operation::CheckGuide{});
    case NextAction::RecordDrilled:
      return ask(operation::TunnelDrilled{});
    case NextAction::ShowWorldMarker:
    case NextAction::GoOnDrawing:
    case NextAction::WaitForRegistration:
    case NextAction::BringGuide:
    case NextAction::FollowBullseye:
    case NextAction::Finish:
      return;  // what is to be done is not done by a pedal
  }
}

// The probe stops drawing with a touch; the screen stays, so that the distance is read in large.
void NavigateView::take_touch(bool is_control_point) {
  choices_.layout = layout(theatre::LiveOperation::now_s());
  if (is_control_point)
    ask(operation::TouchControlPoint{});
  else
    ask(operation::TakeTouch{});
}

float NavigateView::overlay_opacity(double now_s) const {
  if (!choices_.overlay_on) return 0;
  return navigate::overlay_opacity(now_s - choices_.overlay_shown_at_s);
}

void NavigateView::cycle_overlay() {
  const double now = theatre::LiveOperation::now_s();
  const bool is_full = choices_.overlay_on && overlay_opacity(now) > 0.99F;
  choices_.overlay_on = !is_full;
  choices_.overlay_shown_at_s = now;
}

bool NavigateView::is_busy() const { return is_under_way(*live_) || registration().is_fitting; }

void NavigateView::read_live() {
  const theatre::LiveStatePtr seen = live_;
  if (const theatre::LiveOperation* const operation = bones_.known(choices_.bone)) {
    live_ = operation->latest();
    if (const std::string failure = operation->failure(); !failure.empty()) notice_ = failure;
  } else {
    live_ = TheatreBones::nothing();
  }
  choices_.follow(*live_->operation);
  // An address that gave no picture is not worth keeping.
  const bool gives_pictures = live_->phase == Phase::Running && live_->picture != nullptr;
  // That a source runs may still be news of the one before.
  if (stream_is_new_ && gives_pictures && live_->operation->source->title == used_before_->name) {
    stream_is_new_ = false;
    note_stream(known_streams_file(), used_before_->address);
  }
  const bool is_same = live_->operation->registration == seen->operation->registration;
  if (is_same && is_of_source_before(*live_) == is_of_source_before(*seen)) return;
  words_ = words_of(*live_);
  if (registration().change_count != seen->operation->registration->change_count)
    choices_.overlay_shown_at_s = theatre::LiveOperation::now_s();
}

NavigateLayout NavigateView::layout(double now_s) const {
  return choices_.layout.value_or(layout_of(*live_, now_s - choices_.guidance_seen_s));
}

NavigateScreen NavigateView::screen_of(const NavigateDisplay& display, double now_s) {
  NavigateScreen screen{live_.get(), display, words_, choices_.bone};
  if (model_ != nullptr && model_->has_bone(choices_.bone)) {
    // The one that guides: an edit that was not taken over is drawn in Plan alone.
    if (const auto& plan = live_->operation->plan) {
      screen.plan = plan->tunnel;
      screen.planned_length_mm = plan->length_mm;
      const tunnels::TunnelKey key = plan->tunnel.key();
      if (key.bundle != norms::Bundle::Whole)
        screen.tunnel =
            tunnels::name_of(key) + (choices_.is_drilled(*live_->operation, *plan) ? ", drilled" : "");
    }
    screen.surface = model_->shared_surface(choices_.bone);
    screen.drawn_bone = model_->drawn_mesh(choices_.bone);
  }
  screen.overlay_opacity = overlay_opacity(now_s);
  screen.layout = layout(now_s);
  screen.selected_stroke = choices_.stroke;
  screen.undistorts = choices_.undistorts;
  screen.next_step = next_step();
  screen.patient = patient_;
  return screen;
}

void NavigateView::tick(double /*now_s*/) {
  if (model_ != nullptr) bones_.offer_plans();
  read_live();
}

void NavigateView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  // The bone is made ready for registration as soon as this mode is looked at.
  if (model_ != nullptr && model_->has_bone(choices_.bone)) (void)bones_.operation(choices_.bone);
  read_live();
  const double now = theatre::LiveOperation::now_s();
  NavigateDisplay display = display_of(live_.get(), now);
  if (live_->phase == Phase::NoSource && !notice_.empty()) display.detail = notice_;
  if (!live_->operation->plan && model_ != nullptr && bones_.must_choose(choices_.bone))
    display.detail = "Two tunnels are planned in this bone: choose AM (1) or PL (2)";
  if (display.guidance_is_valid) {
    // A guide that comes into view gets the screen, whatever was looked at before.
    if (now - choices_.guidance_seen_s > kGuideAway_s) choices_.layout.reset();
    choices_.guidance_seen_s = now;
  }
  const NavigateScreen screen = screen_of(display, now);

  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  const widgets::Rect controls = rest.cut_bottom(ui.theme.px(100), gap);
  const widgets::Rect video = rest.cut_left(std::min(rest.height * 1.0F, rest.width * 0.5F), gap);
  draw_video(ui, video, screen, video_);
  draw_questions(ui, video);
  if (screen.layout == NavigateLayout::Register) {
    draw_registration(ui, rest.cut_right(rest.width * 0.5F, gap), screen);
    const widgets::Rect tracking = rest.cut_bottom(rest.height * 0.47F, gap);
    scene_.draw(ui, rest, screen);
    draw_tracking(ui, tracking, screen);
  } else {
    widgets::Rect right = rest.cut_right(rest.width * 0.45F, gap);
    draw_bullseye(ui, rest.cut_top(rest.height * 0.54F, gap), screen);
    draw_numbers(ui, right.cut_top(right.height * 0.46F, gap), screen);
    scene_.draw(ui, rest, screen);
    draw_tracking(ui, right, screen);
  }
  draw_controls(ui, controls);
  note_states(ui, screen);
}

}  // namespace arthronaut::navigate
