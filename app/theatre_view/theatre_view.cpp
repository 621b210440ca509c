#include "app/theatre_view/theatre_view.h"

#include <algorithm>

#include "app/scene/scene_camera.h"
#include "navigation/camera/medium.h"
#include "planning/geometry/error.h"

namespace arthronaut::theatre_view {

namespace {

using Phase = OperationStatus::Phase;

// AR can blind: what is drawn over the picture stands out for a while, then fades to a hint by itself.
constexpr double kOverlayFull_s = 8, kOverlayFading_s = 2;
constexpr float kOverlayFaded = 0.25F;
constexpr std::size_t kEnoughPoints = 150;

}  // namespace

TheatreView::TheatreView(std::function<void()> make_current, std::function<void()> wake)
    : wake_(std::move(wake)), pane_(std::move(make_current)) {}
TheatreView::~TheatreView() = default;

void TheatreView::open(const planning_view::PlanModel* model, const std::filesystem::path& case_folder) {
  operation_.reset();
  options_.reset();
  bones_.clear();
  choices_ = {};
  notice_.clear();
  model_ = model;
  case_folder_ = case_folder;
  if (model_ != nullptr && !model_->has_bone(choices_.bone)) choices_.bone = bones::BoneKind::Tibia;
  if (model_ != nullptr) look_along_plan();
}

void TheatreView::start(OperationSetup setup) {
  notice_.clear();
  prepare_bone();
  const BoneState& bone = bones_[choices_.bone];
  setup.prepared_bone = bone.prepared;
  setup.registration = bone.registration;
  if (bone.registration && bone.registration->reliable) setup.digitises = false;
  part_.reset();
  operation_.reset();  // ends and joins the one before
  options_ = std::make_unique<pipeline::PipelineOptions>(setup.pipeline);
  operation_ = std::make_unique<Operation>(std::move(setup), wake_);
  status_ = operation_->status();
  choices_.overlay_shown_at_s = Operation::now_s();
  look_along_plan();
}

void TheatreView::prepare_bone() {
  BoneState& bone = bones_[choices_.bone];
  if (!bone.prepared.valid()) {
    const geometry::TriangleMesh& mesh = model_->knee().bones.at(choices_.bone).mesh;
    const auto cache = case_folder_.empty() ? std::filesystem::path()
                                            : cases::prepared_bone_file(case_folder_, choices_.bone);
    bone.prepared = std::async(std::launch::async, [mesh, cache]() -> PreparedBonePtr {
                      return cache.empty() ? std::make_shared<registration::PreparedBone>(mesh)
                                           : std::make_shared<registration::PreparedBone>(mesh, cache);
                    }).share();
  }
}

void TheatreView::look_along_plan() {
  const auto tunnel = model_->tunnel(choices_.bone);
  if (!tunnel)
    return pane_.look(
        scene::look_from(scene::View::Anterior, model_->knee().side, model_->bounds(choices_.bone), 1));
  const scene::SceneCamera along =
      scene::look_along(tunnel->direction.normalized(), tunnel->entry_mm, 190, Eigen::Vector3d::UnitZ());
  pane_.look(scene::orbited(along, {40, -30}, 600));  // a little from the side: depth is seen too
}

void TheatreView::start_simulation(SimulatedPart part) {
  start(simulated_setup(*model_, choices_.bone, part));
  part_ = part;
}

void TheatreView::start_video() {
  const auto videos = videos_of(case_folder_);
  if (videos.empty()) return;
  choices_.video %= videos.size();
  try {
    start(video_setup(*model_, choices_.bone, case_folder_, videos[choices_.video],
                      choices_.saline ? camera::kSalineIndex : camera::kAirIndex));
    ++choices_.video;
  } catch (const std::runtime_error& error) {  // a file that cannot be used is a notice on this screen
    notice_ = error.what();
  }
}

bool TheatreView::is_running() const { return operation_ != nullptr && status_.phase == Phase::Running; }

bool TheatreView::can_simulate() const {
  return model_ != nullptr && missing_for_simulation(*model_, choices_.bone).empty();
}

std::string TheatreView::next_step() const {
  if (model_ == nullptr) return "open a case";
  if (!model_->tunnel(choices_.bone)) return "plan the tunnel (F1)";
  const bool registered = status_.registration && status_.registration->reliable;
  if (operation_ == nullptr || status_.phase == Phase::Failed)
    return can_simulate() ? "start the simulated operation" : "open the next video";
  if (status_.is_registering) return "wait for the registration";
  if (!registered && status_.trail->size() >= kEnoughPoints) return "register what was touched";
  if (registered && (part_ == SimulatedPart::Scratch || !is_running()) && can_simulate()) return "drill";
  if (!is_running() && !videos_of(case_folder_).empty()) return "open the next video";
  if (registered) return "follow the bullseye";
  return "touch the bone with the probe";
}

void TheatreView::take_next_step() {
  const std::string step = next_step();
  if (step == "start the simulated operation") return start_simulation(SimulatedPart::Scratch);
  if (step == "register what was touched") return operation_->register_curves();
  if (step == "drill") return start_simulation(SimulatedPart::Drill);
  if (step == "open the next video") return start_video();
  if (step == "touch the bone with the probe" && status_.phase == Phase::Ended && can_simulate())
    return start_simulation(SimulatedPart::Scratch);
}

void TheatreView::toggle_recording() {
  if (!status_.recording.empty()) return operation_->stop_recording();
  try {
    operation_->start_recording(cases::create_session_folder(case_folder_));
  } catch (const IoError& error) {
    notice_ = error.what();
  }
}

float TheatreView::overlay_opacity(double now_s) const {
  if (!choices_.overlay_on) return 0;
  const double faded =
      std::clamp((now_s - choices_.overlay_shown_at_s - kOverlayFull_s) / kOverlayFading_s, 0.0, 1.0);
  return 1 - static_cast<float>(faded) * (1 - kOverlayFaded);
}

void TheatreView::cycle_overlay() {
  const double now = Operation::now_s();
  const bool is_full = choices_.overlay_on && overlay_opacity(now) > 0.99F;
  choices_.overlay_on = !is_full;
  choices_.overlay_shown_at_s = now;
}

bool TheatreView::is_busy() const {
  return operation_ != nullptr &&
         (status_.phase == Phase::Running || status_.phase == Phase::Starting || status_.is_registering);
}

void TheatreView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  if (operation_ != nullptr) {
    const std::uint64_t seen = status_.registration_count;
    status_ = operation_->status();
    if (status_.registration) bones_[choices_.bone].registration = status_.registration;
    if (status_.registration_count != seen) choices_.overlay_shown_at_s = Operation::now_s();
  } else {
    status_ = {};
  }
  // The bone is made ready for registration as soon as this mode is looked at.
  if (model_ != nullptr && model_->has_bone(choices_.bone)) prepare_bone();
  const double now = Operation::now_s();
  const OperationStatus* status = operation_ != nullptr ? &status_ : nullptr;
  const TheatreDisplay display = display_of(status, options_.get(), now);
  TheatreScreen screen{status, options_.get(), display};
  if (model_ != nullptr && model_->has_bone(choices_.bone)) {
    screen.plan = model_->tunnel(choices_.bone);
    screen.planned_length_mm = screen.plan ? model_->drawn_length_mm(choices_.bone) : 0;
    screen.surface = model_->shared_surface(choices_.bone);
  }
  screen.overlay_opacity = overlay_opacity(now);
  screen.undistorts = choices_.undistorts;
  screen.title = operation_ != nullptr ? operation_->title() : "";
  screen.next_step = next_step();

  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  const widgets::Rect controls = rest.cut_bottom(ui.theme.px(100), gap);
  const widgets::Rect video = rest.cut_left(std::min(rest.height * 1.0F, rest.width * 0.5F), gap);
  widgets::Rect right = rest.cut_right(rest.width * 0.45F, gap);
  const widgets::Rect bullseye = rest.cut_top(rest.height * 0.54F, gap);
  const widgets::Rect numbers = right.cut_top(right.height * 0.50F, gap);
  draw_video(ui, video, screen, video_);
  draw_bullseye(ui, bullseye, screen);
  draw_numbers(ui, numbers, screen);
  draw_scene(ui, rest, screen);
  draw_tracking(ui, right, screen);
  draw_controls(ui, controls);

  ui.log.note_state("guidance", display.guidance_is_valid ? "valid" : display.headline);
  ui.log.note_state("overlay", screen.overlay_opacity > 0.99F ? "full"
                               : screen.overlay_opacity > 0   ? "faded"
                                                              : "off");
  ui.log.note_state("view", choices_.undistorts ? "undistorted" : "as it came");
  ui.log.note_state("next", screen.next_step);
  ui.log.note_state("registration", !status_.registration            ? "none"
                                    : status_.registration->reliable ? "reliable"
                                                                     : "unreliable");
  ui.log.note_state("recording", status_.recording.empty() ? "off" : "on");
  ui.log.note_state("picture", !display.has_picture ? "none" : display.is_live ? "live" : "old");
}

void TheatreView::show_scene(const TheatreScreen& screen) {
  scene::SceneContent content;
  content.bones.push_back({model_->drawn_mesh(choices_.bone), scene::kBoneColor, 1.0});
  if (screen.plan) scene::add_planned_tunnel(content, *screen.plan, screen.planned_length_mm);
  const bool has_pose =
      status_.registration && status_.registration->has_pose && status_.registration->reliable;
  if (has_pose && screen.status != nullptr) {
    const geometry::RigidTransform bone_from_marker = status_.registration->marker_from_bone.inverse();
    std::vector<Eigen::Vector3d> touched;
    for (const Eigen::Vector3d& point : *status_.trail) touched.push_back(bone_from_marker * point);
    scene::add_curve_points(content, touched);
    if (screen.display.overlay_is_valid && status_.live->result.tip_is_valid)
      content.balls.push_back(
          {bone_from_marker * status_.live->result.tip_in_world_mm, 2.5, scene::kGuideColor, false});
  }
  if (status_.online != nullptr && status_.digitises && status_.online->coach.next_patch_in_bone_mm)
    content.balls.push_back({*status_.online->coach.next_patch_in_bone_mm, 5, scene::kAchievedColor, false});
  if (screen.display.guidance_is_valid) {
    const guidance::GuidanceNumbers& g = screen.display.guidance;
    scene::add_guide(content, g.guide_point_mm, g.guide_direction, std::max(g.remaining_mm, 5.0));
  }
  pane_.show(content);
}

void TheatreView::draw_scene(const widgets::Ui& ui, const widgets::Rect& area, const TheatreScreen& screen) {
  if (model_ == nullptr || !model_->has_bone(choices_.bone)) return;
  show_scene(screen);
  pane_.draw(ui, "operate.view", area);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const std::string label =
      screen.display.guidance_is_valid ? "Drill guide and plan"
      : status_.online != nullptr && status_.digitises && status_.online->coach.next_patch_in_bone_mm
          ? "Orange ball: touch there next"
          : "Plan; the guide is not known now";
  const ImVec2 wide = ui.theme.strong->CalcTextSizeA(ui.theme.strong->FontSize, 1e9F, 0, label.c_str());
  draw.AddRectFilled(area.min(), {area.x + wide.x + ui.theme.px(28), area.y + wide.y + ui.theme.px(18)},
                     IM_COL32(12, 15, 19, 200), ui.theme.px(6));
  draw.AddText(ui.theme.strong, ui.theme.strong->FontSize,
               {area.x + ui.theme.px(14), area.y + ui.theme.px(9)},
               screen.display.guidance_is_valid ? widgets::kQuietText : widgets::kCaution, label.c_str());
}

}  // namespace arthronaut::theatre_view
