#include "navigation/operation/bone_watch.h"

namespace arthronaut::operation {

BoneWatch::BoneWatch(const geometry::Surface* surface) {
  if (surface != nullptr) check_.emplace(surface->mesh());
}

void BoneWatch::on_source(const Eigen::Vector2i& image_size_px) {
  on_source_end();
  if (!check_) return;
  check_->reserve_for(image_size_px);
  luma_.reserve(static_cast<std::size_t>(image_size_px.prod()));
}

void BoneWatch::on_source_end() {
  if (check_) check_->end();
  drift_.reset();
  looks_.reset();
  doubt_.end();
}

void BoneWatch::on_registration(const RegistrationInForce& in_force) {
  const bool stands = in_force.standing == Standing::Stands;
  const auto is_there = [&](const geometry::RigidTransform& now) {
    return marker_from_bone_->translation_mm == now.translation_mm &&
           marker_from_bone_->rotation.coeffs() == now.rotation.coeffs();
  };
  if (stands && marker_from_bone_ && is_there(in_force.registration->marker_from_bone)) return;
  marker_from_bone_.reset();
  if (stands) marker_from_bone_ = in_force.registration->marker_from_bone;
  doubt_.end();
  begins_anew_ = true;
}

void BoneWatch::look_anew() {
  looks_.reset();
  doubt_.end();
  begins_anew_ = true;
}

void BoneWatch::look(const camera::Frame& picture, const pipeline::FrameResult& frame,
                     const tools::ToolSet& tools, const RegistrationInForce& in_force, bool hears_only) {
  // Where an outside tracker has the markers, no picture tells where the lens is.
  if (!check_ || tools.tracker) return;
  if (in_force.standing != Standing::Stands) {
    const bool told_it =
        in_force.standing == Standing::Alarm && check_->verdict().state == contour::ContourState::Drifted;
    if (!told_it) check_->end();
    return;
  }
  if (!check_->has_begun() || begins_anew_) {
    check_->begin(in_force.registration->marker_from_bone);
    begins_anew_ = false;
  }
  std::optional<geometry::RigidTransform> camera_from_world;
  covered_.clear();
  if (frame.camera_from_world.is_valid) {
    camera_from_world = frame.camera_from_world.target_from_source;
    const std::size_t worlds = tools.world_markers.size();
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
      if (!frame.bodies[i].is_tracked()) continue;
      const geometry::RigidTransform& camera_from_body = frame.bodies[i].camera_from_body;
      if (i < worlds)
        covered_.add_world_marker(frame.camera, camera_from_body, tools.world_markers[i]);
      else
        covered_.add_tool(frame.camera, camera_from_body, tools.tools[i - worlds]);
    }
  }
  const contour::ContourVerdict& verdict =
      check_->look(camera::luma_of(picture, luma_), frame.camera, camera_from_world, covered_.places(),
                   frame.timestamp_ns);
  if (hears_only) return;
  if (verdict.state == contour::ContourState::Drifted) drift_ = {verdict.drift_mm, verdict.held_until_ns};
  // Where nothing is checked, a doubt stays.
  const bool looks_otherwise = verdict.state == contour::ContourState::LooksOtherwise;
  if ((looks_otherwise || verdict.state == contour::ContourState::Holds) && looks_otherwise != doubt_.holds())
    looks_ = {looks_otherwise, verdict.held_until_ns};
}

void BoneWatch::tell(const SeenDrift& drift) {
  if (!drift_) drift_ = drift;
}

std::optional<SeenLooks> BoneWatch::take_looks() {
  auto looks = std::exchange(looks_, std::nullopt);
  return looks && looks->otherwise != doubt_.holds() ? looks : std::nullopt;
}

contour::ContourVerdict BoneWatch::verdict() const {
  return check_ ? check_->verdict() : contour::ContourVerdict();
}

}  // namespace arthronaut::operation
