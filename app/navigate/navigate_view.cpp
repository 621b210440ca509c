#include "app/navigate/navigate_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/navigate/overlay_lines.h"
#include "app/scene/scene_camera.h"
#include "navigation/camera/medium.h"
#include "navigation/sources/source_files.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {

namespace {

using Phase = OperationStatus::Phase;

constexpr double kGuideAway_s = 2;
constexpr std::size_t kEnoughPoints = 150;
constexpr const char* kDrill = "drill";
constexpr const char* kVerifyOrDrill = "verify by touches, or drill";

}  // namespace

NavigateView::NavigateView(std::function<void()> make_current, std::function<void()> wake,
                           const sources::DeviceTurns& turns)
    : wake_(std::move(wake)), turns_(turns), scene_(std::move(make_current)) {}
NavigateView::~NavigateView() = default;

mode::ModeTitle NavigateView::title() const {
  return {"navigate", "mode.navigate", "Navigate", "In theatre", GLFW_KEY_F2};
}

std::optional<sources::SourceKind> NavigateView::source_kind() const {
  return operation_ != nullptr ? std::optional(kind_) : std::nullopt;
}

void NavigateView::case_opened(const mode::OpenCase& opened) {
  end_operation();
  // A bone that is just being made ready would be waited for.
  ending_.end(std::exchange(bones_, {}));
  choices_ = {};
  notice_.clear();
  model_ = opened.model;
  case_folder_ = opened.folder;
  if (!model_->has_bone(choices_.bone)) choices_.bone = bones::BoneKind::Tibia;
  look_along_plan();
}

void NavigateView::enter() { choices_.videos = sources::videos_in(case_folder_); }

void NavigateView::end_operation() {
  part_.reset();
  choices_.guidance_seen_s = -1e9;
  if (operation_ == nullptr) return;
  operation_->request_stop();
  ending_.end(std::move(operation_));
  const auto bone = status_.bone;
  status_ = {};
  status_.bone = bone;
}

void NavigateView::start(OperationSetup setup) {
  end_operation();
  notice_.clear();
  choices_.layout.reset();
  choices_.cameras.clear();
  BoneState& bone = bones_[choices_.bone];
  if (bone.registration != nullptr) {
    const std::shared_ptr<const RegistrationStatus> known = bone.registration->status();
    if (known->in_force != nullptr && known->in_force->reliable) setup.digitises = false;
    // Made anew while nothing hangs on it: the plan, its target, may have changed.
    if (known->drawn->empty() && known->history->empty()) bone.registration.reset();
    if (!known->bone_trouble.empty()) bone = {};  // tried again
  }
  prepare_bone();
  setup.registration = bone.registration;
  operation_ = std::make_unique<Operation>(std::move(setup), wake_);
  read_status();
  choices_.overlay_shown_at_s = Operation::now_s();
  look_along_plan();
}

void NavigateView::prepare_bone() {
  BoneState& bone = bones_[choices_.bone];
  if (!bone.prepared.valid()) {
    const geometry::TriangleMesh& mesh = model_->knee().bones.at(choices_.bone).mesh;
    const auto cache = case_folder_.empty() ? std::filesystem::path()
                                            : cases::surface_index_file(case_folder_, choices_.bone);
    bone.prepared = std::async(std::launch::async, [mesh, cache]() -> SurfaceIndexPtr {
                      return cache.empty() ? std::make_shared<registration::SurfaceIndex>(mesh)
                                           : std::make_shared<registration::SurfaceIndex>(mesh, cache);
                    }).share();
  }
  if (bone.registration != nullptr) return;
  std::optional<registration::CartilageRegion> covered;
  try {
    if (!case_folder_.empty())
      if (const auto cartilage = cases::load_cartilage(case_folder_, choices_.bone))
        covered.emplace().points_mm = cartilage->vertices_mm;
  } catch (const std::runtime_error&) {  // without what it declares the bone would be registered wrongly
    std::promise<SurfaceIndexPtr> broken;
    broken.set_exception(std::current_exception());
    bone.prepared = broken.get_future().share();
  }
  bone.registration =
      std::make_shared<BoneRegistration>(bone.prepared, model_->tunnel(choices_.bone),
                                         model_->shared_surface(choices_.bone), std::move(covered));
}

BoneRegistration* NavigateView::bone_registration() const {
  const auto found = bones_.find(choices_.bone);
  return found == bones_.end() ? nullptr : found->second.registration.get();
}

void NavigateView::look_along_plan() {
  const auto tunnel = model_->tunnel(choices_.bone);
  if (!tunnel)
    return scene_.look(
        scene::look_from(scene::View::Anterior, model_->knee().side, model_->bounds(choices_.bone), 1));
  const scene::SceneCamera along =
      scene::look_along(tunnel->direction.normalized(), tunnel->entry_mm, 150, Eigen::Vector3d::UnitZ());
  scene_.look(scene::orbited(along, {40, -30}, 600));  // a little from the side: depth is seen too
}

void NavigateView::start_simulation(SimulatedPart part) {
  try {
    start(simulated_setup(*model_, choices_.bone, case_folder_, part));
    part_ = part;
    kind_ = sources::SourceKind::Simulation;
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
    kind_ = sources::SourceKind::Recording;
    ++choices_.video;
  } catch (const std::runtime_error& error) {  // a file that cannot be used is a notice on this screen
    notice_ = error.what();
  }
}

void NavigateView::start_camera(const sources::ConnectedCamera& camera) {
  try {
    start(camera_setup(*model_, choices_.bone, case_folder_, camera, turns_,
                       choices_.saline ? camera::kSalineIndex : camera::kAirIndex));
    kind_ = sources::SourceKind::Live;
  } catch (const std::runtime_error& error) {
    notice_ = error.what();
    choices_.cameras.clear();
  }
}

void NavigateView::choose_camera() {
  if (!choices_.cameras.empty()) {
    choices_.camera = (choices_.camera + 1) % choices_.cameras.size();
    return;
  }
  std::vector<sources::ConnectedCamera> cameras = sources::connected_cameras();
  if (cameras.empty()) {
    notice_ = "No camera is connected: there is no /dev/video";
    return;
  }
  if (cameras.size() == 1) return start_camera(cameras.front());
  choices_.camera = 0;
  choices_.cameras = std::move(cameras);
}

bool NavigateView::is_running() const { return operation_ != nullptr && status_.phase == Phase::Running; }

bool NavigateView::can_simulate() const {
  return model_ != nullptr && missing_for_simulation(*model_, choices_.bone).empty();
}

std::string NavigateView::next_step() const {
  if (model_ == nullptr) return "open a case";
  if (!choices_.cameras.empty()) return "open " + choices_.cameras[choices_.camera].name;
  if (!model_->tunnel(choices_.bone)) return "plan the tunnel (F1)";
  if (!status_.bone->alarm.empty()) return "check the world marker";
  const bool registered = status_.bone->in_force != nullptr && status_.bone->in_force->reliable;
  if (operation_ == nullptr || status_.phase == Phase::Failed)
    return can_simulate() ? "start the simulated operation" : "open the next video";
  if (status_.is_registering) return "wait for the registration";
  // While the probe draws the registration runs along by itself.
  const bool draws = is_running() && status_.digitises;
  if (!registered && !draws && status_.bone->drawn->size() >= kEnoughPoints)
    return "register what was touched";
  if (registered && (part_ == SimulatedPart::Scratch || !is_running()) && can_simulate())
    return is_running() && !is_verified(*status_.bone) ? kVerifyOrDrill : kDrill;
  if (!is_running() && !choices_.videos.empty()) return "open the next video";
  if (registered) return status_.digitises ? "verify by touches, or take the guide" : "follow the bullseye";
  return "touch the bone with the probe";
}

void NavigateView::take_next_step() {
  if (!choices_.cameras.empty())
    return start_camera(sources::ConnectedCamera(choices_.cameras[choices_.camera]));
  const std::string step = next_step();
  if (step == "start the simulated operation") return start_simulation(SimulatedPart::Scratch);
  if (step == "register what was touched") return operation_->register_curves();
  if (step == kDrill || step == kVerifyOrDrill) return start_simulation(SimulatedPart::Drill);
  if (step == "open the next video") return start_video();
  if (step == "touch the bone with the probe" && status_.phase == Phase::Ended && can_simulate())
    return start_simulation(SimulatedPart::Scratch);
}

// The probe stops drawing with a touch; the screen stays, so that the distance is read in large.
void NavigateView::take_touch(bool is_control_point) {
  choices_.layout = layout(Operation::now_s());
  operation_->take_touch(is_control_point);
}

void NavigateView::toggle_recording() {
  if (!status_.recording.empty()) return operation_->stop_recording();
  try {
    operation_->start_recording(cases::create_session_folder(case_folder_));
  } catch (const IoError& error) {
    notice_ = error.what();
  }
}

float NavigateView::overlay_opacity(double now_s) const {
  if (!choices_.overlay_on) return 0;
  return navigate::overlay_opacity(now_s - choices_.overlay_shown_at_s);
}

void NavigateView::cycle_overlay() {
  const double now = Operation::now_s();
  const bool is_full = choices_.overlay_on && overlay_opacity(now) > 0.99F;
  choices_.overlay_on = !is_full;
  choices_.overlay_shown_at_s = now;
}

bool NavigateView::is_busy() const { return operation_ != nullptr && operation_->is_busy(); }

void NavigateView::read_status() {
  const std::shared_ptr<const RegistrationStatus> seen = status_.bone;
  if (operation_ != nullptr) status_ = operation_->status();
  BoneRegistration* const bone = bone_registration();
  status_.bone = bone != nullptr ? bone->status() : std::make_shared<RegistrationStatus>();
  if (status_.bone == seen) return;
  words_ = words_of(*status_.bone);
  if (status_.bone->change_count != seen->change_count) choices_.overlay_shown_at_s = Operation::now_s();
}

NavigateLayout NavigateView::layout(double now_s) const {
  if (operation_ == nullptr) return NavigateLayout::Guide;
  return choices_.layout.value_or(layout_of(&status_, now_s - choices_.guidance_seen_s));
}

NavigateScreen NavigateView::screen_of(const NavigateDisplay& display, double now_s) const {
  const OperationStatus* status = operation_ != nullptr ? &status_ : nullptr;
  NavigateScreen screen{status, operation_ != nullptr ? &operation_->options() : nullptr, display, words_,
                        choices_.bone};
  if (model_ != nullptr && model_->has_bone(choices_.bone)) {
    screen.plan = model_->tunnel(choices_.bone);
    screen.planned_length_mm = screen.plan ? model_->drawn_length_mm(choices_.bone) : 0;
    screen.plan_revision = model_->revision();
    screen.surface = model_->shared_surface(choices_.bone);
    screen.drawn_bone = model_->drawn_mesh(choices_.bone);
  }
  screen.overlay_opacity = overlay_opacity(now_s);
  screen.layout = layout(now_s);
  screen.selected_stroke = choices_.stroke;
  screen.undistorts = choices_.undistorts;
  if (operation_ != nullptr) {
    screen.title = operation_->title();
    screen.calibration = operation_->calibration();
  }
  screen.next_step = next_step();
  return screen;
}

void NavigateView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  // The bone is made ready for registration as soon as this mode is looked at.
  if (model_ != nullptr && model_->has_bone(choices_.bone)) prepare_bone();
  read_status();
  const double now = Operation::now_s();
  NavigateDisplay display = operation_ != nullptr ? display_of(&status_, &operation_->options(), now)
                                                  : display_of(nullptr, nullptr, now);
  if (operation_ == nullptr && !notice_.empty()) display.detail = notice_;
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
  if (!choices_.cameras.empty()) draw_cameras(ui, video);
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

void NavigateView::note_states(const widgets::Ui& ui, const NavigateScreen& screen) const {
  const RegistrationPtr& in_force = status_.bone->in_force;
  ui.log.note_state("guidance", screen.display.guidance_is_valid ? "valid" : screen.display.headline);
  ui.log.note_state("overlay", screen.overlay_opacity > 0.99F ? "full"
                               : screen.overlay_opacity > 0   ? "faded"
                                                              : "off");
  ui.log.note_state("view", choices_.undistorts ? "undistorted" : "as it came");
  ui.log.note_state("next", screen.next_step);
  ui.log.note_state("calibration", screen.calibration);
  ui.log.note_state("notice", notice_);
  ui.log.note_state("layout", screen.layout == NavigateLayout::Register ? "register" : "guide");
  ui.log.note_state("registration", in_force == nullptr  ? "none"
                                    : in_force->reliable ? "reliable"
                                                         : "unreliable");
  ui.log.note_state("registrations", std::to_string(status_.bone->history->size()));
  ui.log.note_state("strokes", std::to_string(words_.strokes.size()));
  ui.log.note_state("recording", status_.recording.empty() ? "off" : "on");
  ui.log.note_state("picture", !screen.display.has_picture ? "none"
                               : screen.display.is_live    ? "live"
                                                           : "old");
}

void NavigateView::draw_cameras(const widgets::Ui& ui, const widgets::Rect& area) const {
  const float row = ui.theme.px(56);
  widgets::Rect box = widgets::Rect{area.x, area.center().y, area.width, 0}.inset(0);
  box.height = row * (static_cast<float>(choices_.cameras.size()) + 1.5F);
  box.y = area.center().y - box.height / 2;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(box.min(), box.max(), IM_COL32(10, 12, 15, 240));
  widgets::text_centered(ui, box.cut_top(row), ui.theme.title, widgets::kText, "Which camera?");
  for (std::size_t i = 0; i < choices_.cameras.size(); ++i) {
    const widgets::Rect line = box.cut_top(row);
    const bool is_selected = i == choices_.camera;
    if (is_selected) draw.AddRectFilled(line.min(), line.max(), IM_COL32(28, 74, 104, 255));
    widgets::text_centered(
        ui, line, ui.theme.strong, is_selected ? widgets::kText : widgets::kQuietText,
        choices_.cameras[i].name + "  (/dev/video" + std::to_string(choices_.cameras[i].index) + ")");
  }
  widgets::text_centered(ui, box, ui.theme.body, widgets::kQuietText,
                         "K: the next one    Space: open it    Esc: none");
}

}  // namespace arthronaut::navigate
