// Path-traced recordings of a real femur, whose truth is known exactly: what digitisation, registration and
// guidance make of the true poses.
#include <gtest/gtest.h>

#include <cmath>

#include "navigation/experiments/registration_trial.h"
#include "navigation/guidance/guidance.h"
#include "navigation/registration/registration.h"
#include "navigation/registration/registration_file.h"
#include "navigation/strokes/curves.h"
#include "planning/bones/mesh_file.h"
#include "planning/files/csv_table.h"
#include "planning/files/json_document.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {

namespace {

tunnels::Tunnel read_truth_tunnel(const std::filesystem::path& file) {
  const auto document = files::read_json(file, "arthronaut-acceptance.tunnel", 1);
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = document.vector3("entry_mm");
  tunnel.direction = document.vector3("direction").normalized();
  return tunnel;
}

}  // namespace

// The tip seen from the world marker, from true poses, is the curve that the renderer wrote: 0.01 mm is the
// rounding of quaternions in the file, seen 26 mm away.
TEST(RealDigitisation, TruePosesGiveTheTrueCurve) {
  ARTHRONAUT_REQUIRE_DATA(set, "arthroscopy/probe_wet");
  const auto curves =
      strokes::digitise(strokes::read_poses_file(set / "gt/poses.csv"),
                        tools::read_tools_file(set / "tools.json"), bones::BoneKind::Femur, "probe");
  const auto truth = strokes::read_curves_file(set / "gt/curves.csv");
  ASSERT_EQ(curves.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((curves[i].position_mm - truth[i].position_mm).norm(), 0.01) << "point " << i;
  }
}

// Curves without noise on a real femur: found from nothing with any seed, with and without the prior of the
// marker.
TEST(RealRegistration, CleanCurvesAreFoundFromNothing) {
  ARTHRONAUT_REQUIRE_DATA(set, "arthroscopy/probe_wet");
  const auto plan = read_truth_tunnel(set.parent_path() / "guide_wet/gt/tunnel.json");
  const auto truth = registration::read_registration_file(set / "gt/registration_gt.json");
  const auto curves = strokes::read_curves_file(set / "gt/curves.csv");
  const registration::SurfaceIndex bone(bones::read_mesh(set / "bone.stl"));
  for (const bool use_marker_prior : {true, false}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto found = registration::register_curves(bone, curves, {seed, use_marker_prior, plan.entry_mm});
      ASSERT_TRUE(found.has_pose);
      const double error_mm =
          (found.marker_from_bone * plan.entry_mm - truth.marker_from_bone * plan.entry_mm).norm();
      EXPECT_TRUE(found.reliable) << (found.reasons.empty() ? "" : found.reasons.front());
      EXPECT_LT(error_mm, 0.1) << "seed " << seed << (use_marker_prior ? " with" : " without") << " prior";
    }
  }
}

// Strokes on one person's femur never register reliably to another's, whatever the noise, and always to their
// own.
TEST(RealRegistration, AnotherPersonsFemurIsRefused) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/mri-femora");
  const auto mesh = bones::read_mesh(folder / "femur_mesh_10k_pts.vtk");
  const auto other = bones::read_mesh(folder / "3_RIGHT_femur_Nov_02_2021.vtk");
  const registration::SurfaceIndex own_bone(mesh), other_bone(other);
  const geometry::Surface surface(mesh);
  const auto wall = experiments::find_lateral_notch_wall(mesh, surface, bones::Side::Right);
  ASSERT_TRUE(wall.has_value());
  for (const auto noise : {experiments::TrialNoise::Dry, experiments::TrialNoise::ExVivo}) {
    for (const std::uint64_t seed : {1, 2}) {
      const auto trial = experiments::make_trial(mesh, surface, *wall, experiments::setting_of(noise), seed);
      const auto own = registration::register_curves(own_bone, trial.curves, {seed, true, *wall});
      EXPECT_TRUE(own.reliable);
      EXPECT_LT((own.marker_from_bone * *wall - trial.marker_from_bone * *wall).norm(), 1.0);
      EXPECT_FALSE(registration::register_curves(other_bone, trial.curves, {seed, true, *wall}).reliable);
    }
  }
  // Few strokes, half of them off the bone, fit the other femur well now and then, and here with no rival in
  // sight.
  const auto hard = experiments::setting_of(experiments::TrialNoise::Hard);
  for (const std::uint64_t seed : {13008, 13009, 13010, 13011}) {
    const auto trial = experiments::make_trial(mesh, surface, *wall, hard, seed);
    EXPECT_FALSE(registration::register_curves(other_bone, trial.curves, {seed, true, *wall}).reliable)
        << seed;
  }
}

// Four strokes of which half are off the bone: found with and without the marker's prior, most of them relied
// on, and what is relied on is right.
TEST(RealRegistration, HardStrokesAreFoundAndMostlyReliedOn) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/mri-femora");
  const auto mesh = bones::read_mesh(folder / "femur_mesh_10k_pts.vtk");
  const registration::SurfaceIndex bone(mesh);
  const geometry::Surface surface(mesh);
  const auto wall = experiments::find_lateral_notch_wall(mesh, surface, bones::Side::Right);
  ASSERT_TRUE(wall.has_value());
  const auto hard = experiments::setting_of(experiments::TrialNoise::Hard);
  int found_count = 0, relied_on_count = 0;
  for (const std::uint64_t seed : {1000004, 1000006, 1000008, 1000010, 1000012, 1000014, 1000016, 1000018}) {
    const auto trial = experiments::make_trial(mesh, surface, *wall, hard, seed);
    for (const bool use_marker_prior : {true, false}) {
      const auto found = registration::register_curves(bone, trial.curves, {seed, use_marker_prior, *wall});
      const double error_mm = (found.marker_from_bone * *wall - trial.marker_from_bone * *wall).norm();
      found_count += error_mm < 2;
      relied_on_count += found.reliable;
      EXPECT_TRUE(error_mm < 2 || !found.reliable) << "seed " << seed << " off by " << error_mm;
    }
  }
  EXPECT_GE(found_count, 15);
  EXPECT_GE(relied_on_count, 10);
  // Here two searches without the marker come to a wrong pose, which leads clearly, before one finds the
  // right one.
  constexpr std::uint64_t kFoundLate = 1000159;
  const auto trial = experiments::make_trial(mesh, surface, *wall, hard, kFoundLate);
  const auto found = registration::register_curves(bone, trial.curves, {kFoundLate, false, *wall});
  EXPECT_LT((found.marker_from_bone * *wall - trial.marker_from_bone * *wall).norm(), 2.0);
}

// Everything that cannot hold a real femur is refused, each with its own reason.
TEST(RealRegistration, RefusesWithTheRightReason) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/mri-femora");
  const auto mesh = bones::read_mesh(folder / "1_RIGHT_femur_Nov_02_2021.vtk");
  geometry::TriangleMesh image = mesh;
  for (Eigen::Vector3d& vertex : image.vertices_mm) vertex.x() = -vertex.x();
  for (auto& triangle : image.triangles) std::swap(triangle[1], triangle[2]);
  const registration::SurfaceIndex bone(mesh), mirrored(image),
      other(bones::read_mesh(folder / "3_RIGHT_femur_Nov_02_2021.vtk"));
  const geometry::Surface surface(mesh);
  const auto wall = experiments::find_lateral_notch_wall(mesh, surface, bones::Side::Right);
  ASSERT_TRUE(wall.has_value());
  const auto trial_of = [&](double radius_mm) {
    auto setting = experiments::setting_of(experiments::TrialNoise::Dry);
    setting.area_radius_mm = radius_mm;
    return experiments::make_trial(mesh, surface, *wall, setting, 1);
  };
  const auto trial = trial_of(16), patch = trial_of(3);
  const auto expect = [](const registration::SurfaceIndex& on, const strokes::Curves& curves,
                         const std::string& words) {
    const auto found = registration::register_curves(on, curves);
    EXPECT_FALSE(found.reliable) << words;
    std::string all;
    for (const std::string& reason : found.reasons) all += reason + "; ";
    EXPECT_NE(all.find(words), std::string::npos) << "wanted: " << words << "; said: " << all;
  };
  expect(mirrored, trial.curves, "other side");
  expect(other, trial.curves, "this patient's bone");
  expect(bone, patch.curves, "patch");
  expect(bone, {trial.curves.begin(), trial.curves.begin() + 10}, "only 10 points");
  strokes::Curves line, ball = patch.curves, metres = trial.curves, equal = trial.curves;
  const Eigen::Vector3d along = (trial.curves[40].position_mm - trial.curves[0].position_mm).normalized();
  for (int i = 0; i < 200; ++i) line.push_back({0, i / 60.0, trial.curves[0].position_mm + 0.1 * i * along});
  const Eigen::Vector3d center = trial.marker_from_bone * (*wall - 15 * surface.closest_point(*wall).normal);
  for (auto& point : ball) point.position_mm = center + 15 * (point.position_mm - center).normalized();
  for (auto& point : metres) point.position_mm *= 1e-3;
  for (auto& point : equal) point.position_mm = {3, 4, 5};
  expect(bone, line, "straight line");
  expect(bone, ball, "patch");
  expect(bone, metres, "metres");
  expect(bone, equal, "the same");
}

// True poses and the true registration give the numbers that the renderer wrote, in every frame.
TEST(RealGuidance, TruePosesGiveTheTrueNumbers) {
  ARTHRONAUT_REQUIRE_DATA(set, "arthroscopy/guide_wet");
  const auto plan = read_truth_tunnel(set / "gt/tunnel.json");
  auto truth = registration::read_registration_file(set / "gt/registration_gt.json");
  const auto tools = tools::read_tools_file(set / "tools.json");
  const auto poses = strokes::read_poses_file(set / "gt/poses.csv");
  const auto table = files::CsvTable::read(
      set / "gt/guide.csv",
      {"frame", "tip_to_entry_mm", "axis_to_entry_mm", "angle_deg", "tip_x_mm", "dir_x"});
  const tools::Tool* guide = tools.find_tool("femoral guide");
  ASSERT_TRUE(guide != nullptr && guide->axis);

  for (std::size_t row = 0; row < table.row_count(); ++row) {
    guidance::GuidanceInput input;
    input.plan = &plan;
    input.registration = &truth;
    input.axis = &*guide->axis;
    for (const strokes::PoseRow& pose : poses) {
      if (pose.frame != table.integer(row, "frame")) continue;
      geometry::TrackedPose tracked;
      tracked.target_from_source = pose.camera_from_marker;
      tracked.is_valid = true;
      if (pose.marker_id == 0) input.camera_from_world_marker = tracked;
      if (pose.marker_id == guide->marker_id) input.camera_from_guide = tracked;
    }
    const auto numbers = guidance::compute_guidance(input);
    ASSERT_TRUE(numbers.is_valid()) << guidance::to_text(numbers.state);
    EXPECT_NEAR(numbers.tip_to_entry_mm, table.number(row, "tip_to_entry_mm"), 0.01);
    EXPECT_NEAR(numbers.axis_to_entry_mm, table.number(row, "axis_to_entry_mm"), 0.01);
    EXPECT_NEAR(numbers.angle_deg, table.number(row, "angle_deg"), 0.01);
    EXPECT_LT(std::hypot(numbers.offset_anterior_mm, numbers.offset_proximal_mm), 30.0);
  }
}

}  // namespace arthronaut
