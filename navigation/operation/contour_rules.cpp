// The registered bone against the picture: what of it an operation heeds.
#include "navigation/operation/operation_parts.h"

namespace arthronaut::operation {

void Operation::Parts::end_contour() {
  if (contour.check) contour.check->end();
  contour.drift.reset();
  contour.looks.reset();
  contour.is_in_doubt = false;
}

// The probe, or the surgeon, has said that the bone lies where it lay.
void Operation::Parts::look_anew() {
  contour.looks.reset();
  contour.is_in_doubt = false;
  contour.begins_anew = true;
}

void Operation::Parts::expect_pictures(const Eigen::Vector2i& size_px) {
  if (!contour.check) return;
  contour.check->reserve_for(size_px);
  contour.luma.reserve(static_cast<std::size_t>(size_px.prod()));
}

// From the moment on that a registration stands, and anew with every other one. While an alarm holds, what
// told it stays as it was.
void Operation::Parts::check_contour(const camera::Frame& picture) {
  // Where an outside tracker has the markers, no picture tells where the lens is.
  if (!contour.check || source->pipeline.tools.tracker) return;
  const RegistrationInForce& in_force = ledger.in_force();
  if (in_force.standing != Standing::Stands) {
    const bool told_it = in_force.standing == Standing::Alarm &&
                         contour.check->verdict().state == contour::ContourState::Drifted;
    if (!told_it) contour.check->end();
    return;
  }
  if (!contour.check->has_begun() || contour.change != ledger.change_count() || contour.begins_anew) {
    contour.check->begin(in_force.registration->marker_from_bone);
    contour.change = ledger.change_count();
    contour.begins_anew = false;
  }
  std::optional<geometry::RigidTransform> camera_from_world;
  contour.covered.clear();
  if (frame.camera_from_world.is_valid) {
    camera_from_world = frame.camera_from_world.target_from_source;
    const tools::ToolSet& tools = source->pipeline.tools;
    const std::size_t worlds = tools.world_markers.size();
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
      if (!frame.bodies[i].is_tracked()) continue;
      const geometry::RigidTransform& camera_from_body = frame.bodies[i].camera_from_body;
      if (i < worlds)
        contour.covered.add_world_marker(frame.camera, camera_from_body, tools.world_markers[i]);
      else
        contour.covered.add_tool(frame.camera, camera_from_body, tools.tools[i - worlds]);
    }
  }
  const contour::ContourVerdict& verdict =
      contour.check->look(camera::luma_of(picture, contour.luma), frame.camera, camera_from_world,
                          contour.covered.places(), frame.timestamp_ns);
  if (setup.hears_of_drifts) return;
  if (verdict.state == contour::ContourState::Drifted)
    contour.drift = {verdict.drift_mm, verdict.held_until_ns};
  // Where nothing is checked, a doubt stays.
  const bool looks_otherwise = verdict.state == contour::ContourState::LooksOtherwise;
  if ((looks_otherwise || verdict.state == contour::ContourState::Holds) &&
      looks_otherwise != contour.is_in_doubt)
    contour.looks = {looks_otherwise, verdict.held_until_ns};
}

// It is told a second or more after the bone has moved. A control point that was set meanwhile says that the
// bone lies where it lies now, and nothing of whether it moved.
void Operation::Parts::take_drift() {
  if (const auto looks = std::exchange(contour.looks, std::nullopt);
      looks && looks->otherwise != contour.is_in_doubt && ledger.in_force().standing == Standing::Stands) {
    note(JournalKind::BoneLooks, to_text(*looks));
    contour.is_in_doubt = looks->otherwise;
    contour.doubt_has_control_point =
        ledger.touches().has_control_point() && in_view.control_set_ns < looks->held_until_ns;
    contour.touches_before_doubt = ledger.touches().count();
    changed = true;
  }
  if (!contour.drift) return;
  const SeenDrift drift = *std::exchange(contour.drift, std::nullopt);
  if (ledger.in_force().standing != Standing::Stands) return;
  note(JournalKind::BoneMoved, to_text(drift));
  ledger.bone_moved_in_picture(drift.drift_mm, in_view.control_set_ns < drift.held_until_ns);
  follow_ledger();
}

}  // namespace arthronaut::operation
