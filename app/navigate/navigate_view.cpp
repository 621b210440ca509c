#include "app/navigate/navigate_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/case/case_calibration.h"
#include "app/navigate/known_streams.h"
#include "app/navigate/picture_keeping.h"
#include "app/scene/scene_camera.h"
#include "navigation/camera/medium.h"
#include "navigation/sources/connected_cameras.h"
#include "navigation/sources/source_files.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::navigate {

namespace {
using Phase = theatre::LiveState::Phase;

constexpr double kRefusal_s = 6;  // long enough to be read
}  // namespace

NavigateView::NavigateView(std::function<void()> make_current, std::function<void()> wake,
                           const sources::DeviceTurns& turns, std::function<void(Elsewhere)> go_elsewhere,
                           std::shared_ptr<PoseSharing> sharing)
    : turns_(turns),
      go_elsewhere_(std::move(go_elsewhere)),
      scene_(std::move(make_current)),
      sharing_(std::move(sharing)),
      bones_(wake, [sharing = sharing_](const theatre::LiveState& live) { sharing->tell(live); }),
      resume_(wake) {
  bones_.keep_pictures_as(load_picture_keeping(picture_keeping_file()));
}
NavigateView::~NavigateView() = default;

mode::ModeTitle NavigateView::title() const {
  return {"navigate", "mode.navigate", "Navigate", "In theatre", GLFW_KEY_F2};
}

void NavigateView::case_opened(const mode::OpenCase& opened) {
  bones_.open(opened.model, opened.folder, opened.read_only);
  live_ = TheatreBones::nothing();
  words_ = words_of_before_ = {};
  started_ = {};
  lent_.reset();
  choices_ = {};
  drilled_.clear();
  notice_.clear();
  model_ = opened.model;
  case_folder_ = opened.folder;
  depth_ = {};
  cameras_.close();
  cameras_.forget_tracker();
  resume_.open(*opened.model, opened.folder, !opened.read_only.empty(), opened.left_by_crash_since);
  patient_.clear();
  judged_.open(case_folder_);
  judged_edited_.open(case_folder_);
  try {  // who it is is never guessed: what cannot be read is said
    if (const auto identity = cases::load_identity(case_folder_)) patient_ = identity->in_words();
  } catch (const std::runtime_error& error) {
    notice_ = error.what();
  }
  if (!model_->has_bone(choices_.bone)) choices_.bone = bones::BoneKind::Tibia;
  look_along_plan();
}

void NavigateView::enter() {
  resume_.look_again();
  choices_.videos = sources::videos_in(case_folder_);
  choices_.has_real_scope = has_real_scope(case_folder_);
  choices_.has_camera_file =
      !case_folder_.empty() && std::filesystem::exists(cases::camera_file(case_folder_));
  choices_.tools.reset();
  try {
    // The built-in ones are the simulator's: of a real scope nobody has said yet what its tools are.
    if (!choices_.has_real_scope || std::filesystem::exists(cases::tools_file(case_folder_)))
      choices_.tools = open_case::tools_of(!choices_.has_real_scope, case_folder_);
  } catch (const std::runtime_error& error) {  // what is wrong with them is a step that is not done
    notice_ = error.what();
  }
}

void NavigateView::turn_to(bones::BoneKind bone) {
  if (bone != choices_.bone) take_other_bone();
}

void NavigateView::end_source() {
  started_.on_end_asked(live_->phase == Phase::Starting);
  choices_.guidance_seen_s = -1e9;
  notice_.clear();
  if (theatre::LiveOperation* const operation = bones_.known(choices_.bone)) operation->end_source();
}

void NavigateView::take_other_bone() {
  if (refuses_while_lent()) return;
  if (is_under_way(*live_)) {
    notice_ = "Stop the source first, then take the other bone";
    return;
  }
  choices_.take_other_bone();
  cameras_.close();
  notice_.clear();
  heard_ = {};
  started_.on_other_bone();
  depth_ = {};
  read_live();  // what is asked next is asked of this bone
  look_along_plan();
}

bool NavigateView::refuses_while_lent() {
  if (!lent_) return false;
  notice_ = "An exercise runs here: end it in Train (F6) first";
  lent_->refused_s = theatre::LiveOperation::now_s();
  return true;
}

void NavigateView::start(theatre::TheatreSource source) {
  if (refuses_while_lent()) return;
  notice_.clear();
  heard_ = {};
  choices_.layout.reset();
  cameras_.close();
  choices_.guidance_seen_s = -1e9;
  choices_.looked_at.reset();
  choices_.shows_menu = false;
  started_.on_start(choices_.bone, source.setup.kind);
  resume_.answer(choices_.bone);  // it begins: afresh, unless it was resumed
  bones_.used(choices_.bone).start(std::move(source));
  read_live();
  choices_.overlay_shown_at_s = theatre::LiveOperation::now_s();
  look_along_plan();
}

std::string NavigateView::refusal_to_lend(bones::BoneKind bone) {
  if (model_ == nullptr) return "no case is open";
  if (is_under_way(*live_)) return "stop what runs in Navigate first";
  if (started_.was_real()) return "an operation was begun in this case: open the built-in knee (F5) to train";
  if (resume_.is_looking()) return "wait: the case's last operation is looked for";
  const auto key = bones_.guided(bone);
  return key ? missing_for_simulation(*model_, *key) : "there is no one planned tunnel to aim at";
}

void NavigateView::lend(bones::BoneKind bone, theatre::TheatreSource source,
                        std::function<std::string()> next_step) {
  if (choices_.bone != bone) take_other_bone();
  start(std::move(source));
  lent_ = Lent{.next_step = std::move(next_step)};
}

const operation::OperationSetup* NavigateView::setup_in_use() const {
  const theatre::LiveOperation* const operation = bones_.known(choices_.bone);
  return operation != nullptr ? &operation->setup() : nullptr;
}

void NavigateView::ask(operation::Command command) { bones_.used(choices_.bone).apply(std::move(command)); }

void NavigateView::start_simulation(SimulatedPart part) {
  if (refuses_while_lent()) return;
  try {
    start(simulated_setup(*model_, *bones_.guided(choices_.bone), case_folder_, part));
    started_.simulates(part);
  } catch (const std::runtime_error& error) {  // as in start_video()
    notice_ = error.what();
  }
}

void NavigateView::start_video() {
  if (refuses_while_lent()) return;
  choices_.videos = sources::videos_in(case_folder_);
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
  if (refuses_while_lent()) return;
  try {
    start(camera_setup(*model_, choices_.bone, case_folder_, pictures, turns_,
                       choices_.saline ? camera::kSalineIndex : camera::kAirIndex, cameras_.tracker()));
    used_before_ = Used{pictures, !pictures.device};
  } catch (const std::runtime_error& error) {
    notice_ = error.what();
    cameras_.close();
  }
}

void NavigateView::choose_camera() {
  if (refuses_while_lent()) return;
  if (cameras_.is_open()) return cameras_.choose_next();
  offer_cameras();
  if (const auto only = cameras_.chosen(); only && only->device && cameras_.count() == 1) start_live(*only);
}

void NavigateView::offer_cameras() {
  choices_.shows_menu = false;  // it would stand over what is asked
  const auto before = used_before_ ? std::optional(used_before_->pictures) : std::nullopt;
  const bool is_open = is_under_way(*live_) && started_.kind() == sources::SourceKind::Live;
  cameras_.open(sources::connected_cameras(), load_known_streams(known_streams_file()), before,
                [turns = turns_, open = is_open ? before : std::nullopt](const LivePictures& one) {
                  return one == open  ? nullptr
                         : one.device ? turns.open_if_free({*one.device})
                                      : turns.open_stream_if_free(one.address);
                });
}

void NavigateView::type_address() {
  if (refuses_while_lent()) return;
  if (!cameras_.is_open()) offer_cameras();
  cameras_.choose_field();
}

bool NavigateView::is_running() const { return live_->phase == Phase::Running; }

bool NavigateView::is_busy() const {
  return is_under_way(*live_) || registration().is_fitting || heard_.waits_to_say() || cameras_.is_open();
}

void NavigateView::read_live() {
  const theatre::LiveStatePtr seen = live_;
  if (const theatre::LiveOperation* const operation = bones_.known(choices_.bone)) {
    live_ = operation->latest();
    if (const std::string failure = operation->failure(); !failure.empty()) notice_ = failure;
  } else {
    live_ = TheatreBones::nothing();
  }
  if (const auto before = resume_.take_drilled()) {
    drilled_[sources::SourceKind::Live].add_before(before->tunnels);
    bones_.go_on_after(before->newest);
  }
  drilled_[shown_kind()].follow(*live_->operation);
  const pipeline::FrameResult& frame = live_->operation->frame;
  resting_.follow(frame.timestamp_ns,
                  frame.tip_is_valid ? std::optional(frame.tip_in_world_mm) : std::nullopt);
  if (choices_.goes_to_other_bone && !is_under_way(*live_)) {
    choices_.goes_to_other_bone = false;
    take_other_bone();
    return;
  }
  // An address that gave no picture is not worth keeping.
  const bool gives_pictures = live_->phase == Phase::Running && live_->picture != nullptr;
  // That a source runs may still be news of the one before.
  if (used_before_ && used_before_->is_new_stream && gives_pictures &&
      live_->operation->source->title == used_before_->pictures.name) {
    used_before_->is_new_stream = false;
    note_stream(known_streams_file(), used_before_->pictures.address);
  }
  if (live_->operation->registration == seen->operation->registration && live_->phase == seen->phase &&
      operation::unverified_of(*live_->operation) == operation::unverified_of(*seen->operation) &&
      is_of_source_before(*live_) == is_of_source_before(*seen))
    return;
  words_ = words_of(*live_);
  words_of_before_ = without_praise(words_);
  if (registration().change_count != seen->operation->registration->change_count)
    choices_.overlay_shown_at_s = theatre::LiveOperation::now_s();
}

NavigateLayout NavigateView::layout(double now_s) const {
  return choices_.layout.value_or(layout_of(*live_, now_s - choices_.guidance_seen_s, choices_.looked_at,
                                            now_s - choices_.touch_asked_s));
}

void NavigateView::follow_reached(const NavigateDisplay& display, double now_s) {
  const bool has_plan =
      model_ != nullptr && model_->has_bone(choices_.bone) && live_->operation->plan.has_value();
  if (display.guidance_is_valid && has_plan)
    choices_.reached.follow(display.grades, now_s);
  else
    choices_.reached = {};
}

NavigateScreen NavigateView::screen_of(const NavigateDisplay& display, double now_s, bool by_processor) {
  const bool is_of_before = display.has_picture && !display.is_live;
  NavigateScreen screen{live_.get(), display, is_of_before ? words_of_before_ : words_, choices_.bone};
  if (model_ != nullptr && model_->has_bone(choices_.bone)) {
    // The one that guides: an edit that was not taken over is drawn in Plan alone.
    if (const auto& plan = live_->operation->plan) {
      screen.plan = plan->tunnel;
      screen.planned_length_mm = plan->length_mm;
      const tunnels::TunnelKey key = plan->tunnel.key();
      if (key.bundle != norms::Bundle::Whole)
        screen.tunnel = tunnels::name_of(key) + (drilled_as(*plan) != nullptr ? ", drilled" : "");
    }
    screen.surface = model_->shared_surface(choices_.bone);
    screen.drawn_bone = by_processor ? model_->moving_mesh(choices_.bone) : model_->drawn_mesh(choices_.bone);
  }
  screen.overlay_opacity = overlay_opacity(now_s);
  screen.layout = layout(now_s);
  screen.selected_stroke = choices_.stroke;
  screen.undistorts = choices_.undistorts;
  const PedalContext context = pedal_context();
  const PedalStep step = pedal_step(*live_, context);
  screen.next_step = words_of(step, *live_, context);
  screen.is_exercise = !context.exercise.empty();
  choices_.note_pedal(step, now_s);
  screen.pedal_acts = covers_question() || acts_now(step);
  screen.rail = rail();
  if (screen.is_exercise)  // none of the operation's steps is to be done now
    for (RailStep& one : screen.rail)
      if (one.state == StepState::Now) one.state = StepState::Open;
  screen.looked_at = choices_.looked_at;
  // What was pressed and not done is said at once.
  const std::string& missing = choices_.missing.follow(missing_now(step, screen.rail), now_s);
  screen.missing = refusal_notice(*live_, now_s);
  if (screen.missing.empty()) screen.missing = missing;
  screen.is_wrong = (judged_.verdict().is_wrong() && screen.missing == words_of_verdict()) ||
                    (judged_edited_.verdict().is_wrong() && screen.missing == words_of_edited_plan());
  screen.patient = patient_;
  screen.verdict = &judged_.verdict();
  follow_reached(display, now_s);
  screen.reached_for_s = choices_.reached.since(now_s);
  screen.is_muted = player_.is_muted();
  screen.sound_trouble = player_.trouble();
  screen.sharing = sharing_->words();
  return screen;
}

// What may be shown, to be heard: posted, never waited for, whether it is drawn or not.
void NavigateView::sound(double now_s) {
  using operation::Standing;
  const NavigateDisplay display = display_of(live_.get(), now_s);
  follow_reached(display, now_s);
  const bool runs = is_running();
  const Standing standing = registration().in_force.standing;
  const bool doubts =
      standing == Standing::Alarm || standing == Standing::InDoubt || standing == Standing::Void;
  if (const auto due = heard_.follow({.guides = runs && display.guidance_is_valid,
                                      .doubts = runs && doubts,
                                      .reached = runs && choices_.reached.since(now_s).has_value(),
                                      .breaks_out = runs && breaks_out(display),
                                      .runs = runs,
                                      .end_was_asked = started_.end_was_asked(),
                                      .refusals = live_->refusal.count},
                                     now_s))
    player_.play(*due);
}

void NavigateView::tick(double /*now_s*/) {
  if (model_ != nullptr) bones_.offer_plans();
  read_live();
  const double now = judged_s_ = theatre::LiveOperation::now_s();
  if (read_notice_.are_read(notice_, now) && is_running()) notice_.clear();
  sound(now);
}

void NavigateView::on_screen() {
  const theatre::LiveStatePtr seen = std::exchange(drawn_.live, nullptr);
  if (auto* const shows = bones_.known(choices_.bone); shows != nullptr && seen)
    shows->shown(*seen, drawn_.since_s);
}

void NavigateView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  // Made ready for registration as soon as this mode is looked at.
  if (model_ != nullptr && model_->has_bone(choices_.bone)) (void)bones_.operation(choices_.bone);
  read_live();
  if (model_ != nullptr) judge_plans();
  drawn_.live = live_;
  const double now = judged_s_ = drawn_.since_s = theatre::LiveOperation::now_s();
  NavigateDisplay display = display_of(live_.get(), now);
  const bool was_refused = lent_ && now - lent_->refused_s < kRefusal_s;
  if (live_->phase == Phase::NoSource && !acts_now(pedal_step(*live_, pedal_context())))
    display.detail.clear();
  if ((live_->phase == Phase::NoSource || was_refused) && !notice_.empty()) display.detail = notice_;
  if (!live_->operation->plan && model_ != nullptr && bones_.must_choose(choices_.bone))
    display.detail = "Two tunnels are planned in this bone: choose AM (1) or PL (2)";
  // A guide that comes into view gets the screen; where its numbers may not be shown, why not does.
  if (gets_screen(display, *live_->operation)) {
    if (now - choices_.guidance_seen_s > kGuideAway_s) choices_.layout.reset();
    choices_.guidance_seen_s = now;
  }
  const NavigateScreen screen = screen_of(display, now, ui.by_processor);
  const TheatreLayout layout = layout_in(ui, area);
  draw_video(ui, layout.video, screen, video_);
  draw_rail(ui, layout.rail, screen);
  draw_words(ui, layout.words, screen);
  draw_states(ui, layout.states, screen);
  choices_.note_asked(choices_.shows_menu ? Question::None : question(), now);
  const bool is_covered = choices_.shows_menu || draw_questions(ui, layout);
  if (choices_.shows_menu) draw_menu(ui, layout.block, screen);
  // Where nothing is registered there is nobody to coach.
  const bool is_all_scene =
      screen.is_exercise && screen.layout == NavigateLayout::Register && layout.scene_is_in_block;
  if (!is_covered || !layout.scene_is_in_block)
    scene_.draw(ui, is_all_scene ? layout.block : layout.scene, screen);
  if (!is_covered && !is_all_scene) {
    if (layout.target.width > 0) draw_bullseye(ui, layout.target, screen);
    if (screen.layout == NavigateLayout::Register)
      draw_registration(ui, layout.main, screen);
    else if (screen.display.guidance_is_valid)
      draw_numbers(ui, layout.main, screen);
    else
      draw_reason(ui, layout.main, screen);
  }
  if (!takes_window()) draw_controls(ui, layout.buttons);
  note_states(ui, screen);
}

}  // namespace arthronaut::navigate
