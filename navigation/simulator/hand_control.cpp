#include "navigation/simulator/hand_control.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/hand_push.h"
#include "navigation/simulator/script.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {

namespace {

using Eigen::Vector3d;

constexpr double kTouch_mm = 0.05;    // nearer than that is on the bone
constexpr double kSubstep_mm = 0.25;  // no wall of the bone is that thin
constexpr double kGlide_s = 1.2;      // of the scope from one tool's view to the other's

}  // namespace

HandControl::HandControl(const HandStart& start, const geometry::Surface& bone, const HandLimits& limits)
    : bone_(bone), limits_(limits), start_(start) {
  for (const double limit : {limits.tool_mm_s, limits.tool_deg_s, limits.scope_mm_s, limits.scope_deg_s,
                             limits.lens_deg_s, limits.drill_mm_s, limits.settle_s, limits.longest_step_s})
    if (!(limit > 0)) throw InvalidInput("hand control: every limit must be above 0");
  state_.held = start.held;
  state_.bone_from_camera =
      start.held == Held::Probe ? start.bone_from_camera_probe : start.bone_from_camera_guide;
  state_.mark_angle_deg = start.mark_angle_deg;
  state_.probe_tip_mm = start.probe_tip_mm;
  state_.probe_handle = start.probe_handle.normalized();
  state_.guide_point_mm = start.guide_point_mm;
  state_.guide_direction = start.guide_direction.normalized();
}

const HandState& HandControl::step(const HandInput& input, double dt_s) {
  const double dt = std::isfinite(dt_s) ? std::clamp(dt_s, 0.0, limits_.longest_step_s) : 0;
  if (input.held != state_.held) take(input.held);
  const double share = 1 - std::exp(-dt / limits_.settle_s);
  const auto settle = [&](auto& speed, const auto& wanted) { speed += share * (wanted - speed); };
  const Vector3d move = cut_all(input.move);
  const Vector3d tilt = cut_all(input.tilt);
  const double tool = input.moves_scope ? 0 : 1, scope = 1 - tool;
  settle(speeds_.tool, Vector3d(tool * limits_.tool_mm_s * move));
  settle(speeds_.tool_tilt, Vector3d(tool * geometry::rad_from_deg(limits_.tool_deg_s) * tilt));
  settle(speeds_.scope, Vector3d(scope * limits_.scope_mm_s * move));
  settle(speeds_.scope_tilt, Vector3d(scope * geometry::rad_from_deg(limits_.scope_deg_s) * tilt));
  settle(speeds_.lens, limits_.lens_deg_s * cut(input.turn_lens));
  follow_staged_view(dt);
  move_scope(dt);
  move_tool(dt);
  drill(std::max(0.0, cut(input.drill)), dt);
  state_.time_s += dt;
  return state_;
}

void HandControl::take(Held held) {
  state_.held = held;
  speeds_.tool.setZero();
  speeds_.tool_tilt.setZero();
  glide_from_ = state_.bone_from_camera;
  glide_share_ = 0;
}

void HandControl::follow_staged_view(double dt_s) {
  if (glide_share_ >= 1) return;
  glide_share_ = std::min(1.0, glide_share_ + dt_s / kGlide_s);
  const double eased = glide_share_ * glide_share_ * (3 - 2 * glide_share_);
  const auto& wanted =
      state_.held == Held::Probe ? start_.bone_from_camera_probe : start_.bone_from_camera_guide;
  state_.bone_from_camera = between(glide_from_, wanted, eased);
}

void HandControl::move_scope(double dt_s) {
  geometry::RigidTransform& view = state_.bone_from_camera;
  const Vector3d step = dt_s * view.rotate(speeds_.scope);
  const Vector3d eye = view.translation_mm + step;
  const double now_mm = bone_.signed_distance_mm(view.translation_mm);
  const double then_mm = bone_.signed_distance_mm(eye);
  if (then_mm >= limits_.scope_clear_mm || then_mm >= now_mm) view.translation_mm = eye;
  const Vector3d turn = dt_s * speeds_.scope_tilt;
  // The view turns right and down: about the picture's y, and about its x the other way.
  view.rotation =
      (view.rotation * Eigen::AngleAxisd(turn.x(), Vector3d::UnitY()) *
       Eigen::AngleAxisd(-turn.y(), Vector3d::UnitX()) * Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()))
          .normalized();
  state_.mark_angle_deg = std::fmod(state_.mark_angle_deg + dt_s * speeds_.lens + 720, 360.0);
}

Vector3d HandControl::kept_out(const Vector3d& from_mm, const Vector3d& step_mm) const {
  const int count = std::max(1, static_cast<int>(std::ceil(step_mm.norm() / kSubstep_mm)));
  Vector3d at = from_mm;
  for (int i = 0; i < count; ++i) {
    at += step_mm / count;
    if (bone_.signed_distance_mm(at) < 0) at = bone_.closest_point(at).point_mm;
  }
  return at;
}

void HandControl::move_tool(double dt_s) {
  const bool is_probe = state_.held == Held::Probe;
  Vector3d& point = is_probe ? state_.probe_tip_mm : state_.guide_point_mm;
  const bool is_fixed = !is_probe && state_.drilled_depth_mm > 0;
  if (!is_fixed) {
    point = kept_out(point, dt_s * state_.bone_from_camera.rotate(speeds_.tool));
    const Vector3d way_rad = dt_s * state_.bone_from_camera.rotate(speeds_.tool_tilt);
    if (is_probe)
      state_.probe_handle = (turn_of_push(state_.probe_handle, way_rad) * state_.probe_handle).normalized();
    else  // the handle is behind the point
      state_.guide_direction =
          (turn_of_push(-state_.guide_direction, way_rad) * state_.guide_direction).normalized();
  }
  const double off_mm = bone_.signed_distance_mm(point);
  state_.touches_bone = off_mm <= kTouch_mm;
  state_.off_bone_mm = std::max(off_mm, 0.0);
}

void HandControl::drill(double share, double dt_s) {
  if (state_.held != Held::Guide || share <= 0) return;
  const bool bites = state_.drilled_depth_mm > 0 ||
                     bone_.signed_distance_mm(state_.guide_point_mm) <= limits_.drill_reach_mm;
  if (bites) state_.drilled_depth_mm += share * limits_.drill_mm_s * dt_s;
}

}  // namespace arthronaut::simulator
