// Frames as a pipeline would give them, made up with all numbers different.
#pragma once

#include "navigation/recording/session.h"
#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut::test {

inline recording::SessionHeader session_header() {
  recording::SessionHeader header;
  header.id = "2026-01-02T03-04-05";
  header.started_utc = "2026-01-02T03:04:05Z";
  header.bone = bones::BoneKind::Femur;
  header.side = bones::Side::Left;
  header.refractive_index = 1.3345;
  header.probe_name = "probe";
  header.guide_name = "femoral guide";
  header.source = "test";
  header.program_version = "0.1.0";
  return header;
}

inline pipeline::FrameResult frame_result(std::int64_t index) {
  const double x = static_cast<double>(index);
  pipeline::FrameResult result;
  result.frame_index = index;
  result.timestamp_ns = index * 1'000'000'000 / 60;
  result.intrinsics_are_known = true;
  result.lens.circle_found = true;
  result.lens.circle = {{80.1 + x, 60.2}, 55.3};
  result.lens.circle_coverage_deg = 300;
  result.lens.mark = lens::MarkState::Found;
  result.lens.polarity = lens::MarkPolarity::DarkInward;
  result.lens.mark_angle_deg = 12.345678901234 + x / 7;
  result.lens.mark_sigma_deg = 0.1;
  result.lens.is_stale = false;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.1 + x / 100, Eigen::Vector3d(1, 2, 3).normalized()));
  result.markers = {seen(0, {turn, {x, 2.5, 25}}), lost(2, markers::MarkerState::Glare),
                    seen(3, {turn, {0, x / 3, 19}})};
  result.markers[0].rms_px = 0.123456789;
  result.tip_is_valid = index % 2 == 0;
  result.tip_in_world_mm = {x / 3, -x, 1.0 / 3};
  result.guidance.state =
      index % 3 == 0 ? guidance::GuidanceState::Valid : guidance::GuidanceState::GuideLost;
  result.guidance.timestamp_ns = result.timestamp_ns;
  result.guidance.guide_point_mm = {1, x, 3};
  result.guidance.guide_direction = Eigen::Vector3d(1, 2, 3).normalized();
  result.guidance.axis_to_entry_mm = 1 / (x + 3);
  result.guidance.angle_deg = 2 + x / 9;
  result.guidance.depth_mm = -x;
  result.guidance.offset_lateral_mm = 0.3 + x / 50;
  if (index % 2 == 0) {
    result.guidance.drill.emplace();
    result.guidance.drill->marker_id = 5;
    result.guidance.drill->depth_mm = x;
    result.guidance.drill->remaining_mm = 30 - x;
    result.guidance.drill->to_exit_mm = 31 - x;
    result.guidance.drill->lateral_mm = 0.2 + x / 60;
    result.guidance.drill->sigma_mm = 0.4;
    result.guidance.drill->sigma_offset_mm = 0.5 + x / 70;
    result.guidance.drill->sigma_angle_deg = 0.6 + x / 80;
    result.guidance.drill->tip_mm = {x / 11, 2, -x};
    result.guidance.drill->direction = Eigen::Vector3d(3, 1, x).normalized();
  }
  return result;
}

inline registration::RegistrationSummary some_registration() {
  registration::RegistrationSummary summary;
  summary.has_pose = summary.reliable = true;
  summary.reasons.clear();
  summary.marker_from_bone = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(3, 2, 1).normalized())), {1, -2, 30}};
  summary.covariance = geometry::Matrix6d::Identity() * 0.01;
  summary.rms_mm = 0.2;
  summary.inlier_fraction = 0.9;
  summary.point_count = 400;
  summary.predicted_tre_mm = 0.3;
  return summary;
}

}  // namespace arthronaut::test
