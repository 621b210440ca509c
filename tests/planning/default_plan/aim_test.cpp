#include "planning/default_plan/aim.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "planning/geometry/rigid_transform.h"
#include "planning/landmarks/propose.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/tunnels/portal.h"

namespace arthronaut::default_plan {
namespace {

using bones::BoneKind;
using bones::Side;

// The default is one of the ways that Plan shows through the portal (O).
TEST(DefaultAim, ComesThroughThePortalThatPlanShows) {
  constexpr double kDrill_mm = 4.5, kBetweenAims_deg = 3;
  for (const Side side : {Side::Right, Side::Left}) {
    const auto knee = phantom::make_phantom_knee({.side = side, .edge_length_mm = 1.5});
    const geometry::Surface femur(knee.femur.mesh);
    const auto proposal = landmarks::propose(knee.femur.mesh, BoneKind::Femur, {.side = side});
    for (landmarks::Landmarks marks : {proposal.landmarks, knee.femur_landmarks}) {
      marks.erase("native_footprint");
      const auto made =
          plan_bone({.bone = &knee.femur, .surface = &femur, .landmarks = marks, .states = {}}, side);
      ASSERT_TRUE(made.is_usable()) << made.message;
      const auto axes = landmarks::anatomical_axes(BoneKind::Femur, side, marks, knee.femur.mesh);
      const auto hinge = graft::flexion_axis(marks, knee.femur.mesh, axes);
      ASSERT_TRUE(hinge);
      const auto aims = tunnels::portal_aims(made.tunnel.entry_mm, kDrill_mm,
                                             tunnels::anteromedial_portal(*hinge, axes), *hinge, femur);
      EXPECT_LT(tunnels::off_portal_deg(made.tunnel.direction, aims), kBetweenAims_deg)
          << bones::to_text(side) << ", by " << graft::to_text(hinge->origin);
    }
  }
}

// One whose every direction is measured alike however it lies: a single one that is said to break out turns
// the mean of all that are as good. Half a degree is what another scan may turn it by; this is the same
// surface.
TEST(DefaultAim, IsTheSameHoweverTheSameSurfaceLies) {
  constexpr double kSame_deg = 0.2;
  const auto knee = phantom::make_phantom_knee({.seed = 2, .edge_length_mm = 1.3});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 2, -0.5).normalized()).matrix();
  const auto direction_of = [](const bones::Bone& femur) {
    const geometry::Surface surface(femur.mesh);
    const auto made =
        plan_bone({.bone = &femur, .surface = &surface, .landmarks = {}, .states = {}}, Side::Right);
    EXPECT_TRUE(made.is_usable()) << made.message;
    return made.tunnel.direction;
  };
  bones::Bone turned = knee.femur;
  for (Eigen::Vector3d& p : turned.mesh.vertices_mm) p = turn * p;
  EXPECT_LT(geometry::deg_from_rad(
                geometry::angle_between_rad(direction_of(turned), turn * direction_of(knee.femur))),
            kSame_deg);
}

// Where another direction leaves through bone that somebody has seen, none is taken that leaves where the
// images end or through a hole that was filled in; where every one does, the default says so.
TEST(DefaultAim, Hazard46LeavesWhereBoneWasSeen) {
  const auto knee = phantom::make_phantom_knee({.edge_length_mm = 1.5});
  for (const bones::Bone* bone : {&knee.femur, &knee.tibia}) {
    const bool is_femur = bone->kind == BoneKind::Femur;
    const geometry::Surface surface(bone->mesh);
    BoneInput input{.bone = bone,
                    .surface = &surface,
                    .landmarks = is_femur ? knee.femur_landmarks : knee.tibia_landmarks,
                    .states = {}};
    const auto exit_of = [&](const DefaultTunnel& made) {
      EXPECT_TRUE(made.is_usable()) << made.message;
      return tunnels::measure(made.tunnel, surface).exit_mm;
    };
    const auto usual = plan_bone(input, Side::Right);
    const Eigen::Vector3d usual_exit = exit_of(usual);
    input.unseen.filled_holes = {{.at_mm = usual_exit, .across_mm = 4}};
    const auto beside = plan_bone(input, Side::Right);
    EXPECT_EQ(input.unseen.reached(exit_of(beside)), "") << bones::to_text(bone->kind);
    EXPECT_EQ(beside.tunnel.entry_mm, usual.tunnel.entry_mm) << "the norm's place stays";
    // Everything in front of the usual exit, or behind it.
    for (const double front : {1.0, -1.0}) {
      const Eigen::Vector3d out(0, -front, 0);
      input.unseen = {.image_cuts = {{.at_mm = usual_exit - 0.5 * out, .out = out, .area_mm2 = 500}}};
      EXPECT_EQ(input.unseen.reached(exit_of(plan_bone(input, Side::Right))), "")
          << bones::to_text(bone->kind) << ' ' << front;
    }
    input.unseen = {.filled_holes = {{.at_mm = usual_exit, .across_mm = 60}}};
    const auto anywhere = plan_bone(input, Side::Right);
    EXPECT_TRUE(std::ranges::any_of(anywhere.failed, [](const tunnels::PlanCheck& check) {
      return check.name == "Exit" && check.verdict == tunnels::PlanCheck::Verdict::NotChecked;
    })) << "every direction leaves there";
  }
}

}  // namespace
}  // namespace arthronaut::default_plan
