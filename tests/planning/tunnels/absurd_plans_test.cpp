// Plans that nobody would drill, each of which had three ticks: said, on either side and however the bone
// lies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/phantom/phantom_knee.h"
#include "planning/tunnels/aim.h"
#include "planning/tunnels/entry_map.h"
#include "planning/tunnels/knee_checks.h"
#include "planning/tunnels/plan_checks.h"
#include "planning/tunnels/portal.h"
#include "planning/tunnels/tunnel_places.h"

namespace arthronaut::tunnels {
namespace {

using bones::BoneKind;
using bones::Side;
using Eigen::Vector3d;
using Verdict = PlanCheck::Verdict;

struct BoneUnderTest {
  std::shared_ptr<const geometry::Surface> surface;
  PlanSurroundings known;
  geometry::TriangleMesh mesh;

  [[nodiscard]] Vector3d furthest(const Vector3d& direction, double above_mm, double below_mm) const {
    const Vector3d* best = nullptr;
    for (const auto& v : mesh.vertices_mm) {
      const double height = v.dot(known.axes->proximal) - known.extents.lowest_mm;
      if (height < above_mm || height > below_mm) continue;
      if (!best || v.dot(direction) > best->dot(direction)) best = &v;
    }
    return *best;
  }
  [[nodiscard]] PlanCheck check(const Tunnel& tunnel, const std::string& name) const {
    for (const auto& check : check_plan(tunnel, measure(tunnel, *surface), known))
      if (check.name == name) return check;
    ADD_FAILURE() << "no check " << name;
    return {};
  }
};

BoneUnderTest bone_of(const bones::Bone& bone, const landmarks::Landmarks& marks, Side side) {
  BoneUnderTest result{std::make_shared<geometry::Surface>(bone.mesh), {}, bone.mesh};
  result.known = surroundings_of(bone.mesh, bone.kind, marks, side, result.surface);
  return result;
}

struct KneeUnderTest {
  explicit KneeUnderTest(Side side)
      : made(phantom::make_phantom_knee({.side = side})),
        femur(bone_of(made.femur, made.femur_landmarks, side)),
        tibia(bone_of(made.tibia, made.tibia_landmarks, side)) {}
  phantom::PhantomKnee made;
  BoneUnderTest femur, tibia;
};

const KneeUnderTest& knee_of(Side side) {
  static const KneeUnderTest right(Side::Right), left(Side::Left);
  return side == Side::Right ? right : left;
}

class AbsurdPlans : public ::testing::TestWithParam<Side> {
 protected:
  const phantom::PhantomKnee& knee_ = knee_of(GetParam()).made;
  BoneUnderTest femur_ = knee_of(GetParam()).femur, tibia_ = knee_of(GetParam()).tibia;
  landmarks::AnatomicalAxes axes_ = *femur_.known.axes;
};
INSTANTIATE_TEST_SUITE_P(EitherSide, AbsurdPlans, ::testing::Values(Side::Right, Side::Left));

// The plan that a surgeon would drill stays as it is.
TEST_P(AbsurdPlans, TheBuiltInPlanIsNone) {
  for (const auto* name : {"Entry", "Exit", "Length", "Wall"}) {
    EXPECT_EQ(femur_.check(knee_.femoral_tunnel, name).verdict, Verdict::Fine) << name;
  }
  for (const auto* name : {"Entry", "Exit", "Length"})
    EXPECT_EQ(tibia_.check(knee_.tibial_tunnel, name).verdict, Verdict::Fine) << name;
}

// On the outer side of the medial condyle, across the whole femur: not in the notch, too long.
TEST_P(AbsurdPlans, EntryOnTheOuterMedialCondyle) {
  const Tunnel tunnel{.bone = BoneKind::Femur,
                      .entry_mm = femur_.furthest(-axes_.lateral, 15, 35),
                      .direction = axes_.lateral};
  EXPECT_EQ(femur_.check(tunnel, "Entry").verdict, Verdict::Wrong);
  EXPECT_THAT(femur_.check(tunnel, "Entry").text, ::testing::HasSubstr("not in the notch"));
}

// Across the whole femur, wherever that is furthest.
TEST_P(AbsurdPlans, TooLong) {
  Tunnel tunnel{.bone = BoneKind::Femur, .direction = axes_.lateral};
  const Vector3d middle = geometry::bounds_of(femur_.mesh).center_mm();
  double longest_mm = 0;
  for (double up = -40; up <= 40; up += 4) {
    for (double ahead = -30; ahead <= 30; ahead += 4) {
      const auto hit = femur_.surface->first_hit(
          middle - 100 * axes_.lateral + up * axes_.proximal + ahead * axes_.anterior, axes_.lateral);
      if (!hit) continue;
      Tunnel candidate = tunnel;
      candidate.entry_mm = hit->point_mm;
      const double length_mm = length_along(candidate, *femur_.surface).value_or(0);
      if (length_mm <= longest_mm) continue;
      longest_mm = length_mm;
      tunnel = candidate;
    }
  }
  ASSERT_GT(longest_mm, 60);
  const auto check = femur_.check(tunnel, "Length");
  EXPECT_EQ(check.verdict, Verdict::Wrong) << check.text;
  EXPECT_GT(*check.value, *check.greatest);
}

// From the right entry down through the condyle, and from the other wall of the notch to the other side.
TEST_P(AbsurdPlans, ThroughTheJointSurfaceAndToTheWrongSide) {
  Tunnel down = knee_.femoral_tunnel;
  down.direction = (0.6 * axes_.lateral - 0.8 * axes_.proximal).normalized();
  const auto exit = femur_.check(down, "Exit");
  EXPECT_EQ(exit.verdict, Verdict::Wrong) << exit.text;
  EXPECT_THAT(exit.text, ::testing::HasSubstr("joint surface"));

  const Vector3d entry = knee_.femoral_tunnel.entry_mm;
  const auto opposite = femur_.surface->first_hit(entry - 1.0 * axes_.lateral, -axes_.lateral);
  ASSERT_TRUE(opposite);
  const Tunnel medial{
      .bone = BoneKind::Femur,
      .entry_mm = opposite->point_mm,
      .direction = (-0.8 * axes_.lateral + 0.3 * axes_.anterior + 0.5 * axes_.proximal).normalized()};
  EXPECT_THAT(femur_.check(medial, "Entry").text, ::testing::HasSubstr("wrong side"));
  EXPECT_THAT(femur_.check(medial, "Exit").text, ::testing::HasSubstr("wrong side"));
}

// From outside through the medial condyle: the drill comes out where it should have gone in, and the lateral
// cortex is beyond the notch.
TEST_P(AbsurdPlans, IntoTheNotchIsNotTheLateralCortex) {
  const Vector3d entry = knee_.femoral_tunnel.entry_mm;
  const auto wall = femur_.surface->first_hit(entry - 1.0 * axes_.lateral, -axes_.lateral);
  ASSERT_TRUE(wall);
  const auto outer = femur_.surface->first_hit(wall->point_mm - 200 * axes_.lateral, axes_.lateral);
  ASSERT_TRUE(outer);
  const Tunnel across{.bone = BoneKind::Femur, .entry_mm = outer->point_mm, .direction = axes_.lateral};
  const auto exit = femur_.check(across, "Exit");
  EXPECT_EQ(exit.verdict, Verdict::Wrong);
  EXPECT_THAT(exit.text, ::testing::HasSubstr("into the notch"));
}

// Laterally of the entry, and yet out of the front of the femur.
TEST_P(AbsurdPlans, TheFrontOfTheFemurIsNotTheLateralCortex) {
  Tunnel forwards = knee_.femoral_tunnel;
  forwards.direction = (0.30 * axes_.lateral + 0.85 * axes_.anterior + 0.42 * axes_.proximal).normalized();
  const auto exit = femur_.check(forwards, "Exit");
  EXPECT_EQ(exit.verdict, Verdict::Look) << exit.text;
  EXPECT_THAT(exit.text, ::testing::HasSubstr("front of the femur"));
}

// A drill that comes out of the shaft, seen from where it does: along each side, and at its end.
TEST_P(AbsurdPlans, EachSideOfTheShaftIsToldFromTheOthers) {
  const auto& extents = femur_.known.extents;
  const double height = 0.8 * (extents.highest_mm - extents.lowest_mm);
  Vector3d middle = Vector3d::Zero();
  int count = 0;
  for (const auto& v : femur_.mesh.vertices_mm) {
    if (std::abs(v.dot(axes_.proximal) - extents.lowest_mm - height) > 3) continue;
    middle += v;
    ++count;
  }
  ASSERT_GT(count, 0);
  middle /= count;
  const auto exit_along = [&](const Vector3d& direction) {
    const auto hit = femur_.surface->first_hit(middle + 200 * direction, -direction);
    EXPECT_TRUE(hit);
    TunnelGeometry tunnel;
    tunnel.entry_on_surface_mm = middle - 30 * axes_.lateral - 60 * axes_.proximal;
    tunnel.exit_mm = tunnel.exit.at_mm = hit->point_mm;
    tunnel.exit.normal = hit->normal;
    return femoral_exit(*femur_.surface, tunnel, axes_, extents);
  };
  EXPECT_EQ(exit_along(axes_.lateral), FemoralExit::LateralCortex);
  EXPECT_EQ(exit_along(axes_.anterior), FemoralExit::Front);
  EXPECT_EQ(exit_along(-axes_.anterior), FemoralExit::Back);
  EXPECT_EQ(exit_along(axes_.proximal), FemoralExit::Above);
  EXPECT_EQ(exit_along(-axes_.lateral), FemoralExit::MedialSide);
}

TEST_P(AbsurdPlans, TibialOnes) {
  const auto& axes = *tibia_.known.axes;
  Tunnel back = knee_.tibial_tunnel;
  back.direction = (-0.8 * axes.proximal - 0.6 * axes.anterior).normalized();
  EXPECT_EQ(tibia_.check(back, "Exit").verdict, Verdict::Wrong);
  Tunnel shaft = knee_.tibial_tunnel;
  shaft.direction = -axes.proximal;
  EXPECT_EQ(tibia_.check(shaft, "Length").verdict, Verdict::Look);
  Tunnel beside = knee_.tibial_tunnel;
  const auto on_medial_plateau = tibia_.surface->first_hit(
      knee_.tibial_tunnel.entry_mm - 22 * axes.lateral + 20 * axes.proximal, -axes.proximal);
  ASSERT_TRUE(on_medial_plateau);
  beside.entry_mm = on_medial_plateau->point_mm;
  EXPECT_EQ(tibia_.check(beside, "Entry").verdict, Verdict::Wrong);
}

// Where somebody points at the plateau a first tunnel goes to the anteromedial face, not down the shaft.
TEST_P(AbsurdPlans, AFirstTibialTunnelDoesNotRunDownTheShaft) {
  const auto& axes = *tibia_.known.axes;
  const Tunnel first = first_tunnel(BoneKind::Tibia, knee_.tibial_tunnel.entry_mm, axes, *tibia_.surface);
  EXPECT_GT(geometry::deg_from_rad(geometry::angle_between_rad(first.direction, -axes.proximal)), 20);
  EXPECT_EQ(tibia_.check(first, "Exit").verdict, Verdict::Fine);
  EXPECT_EQ(tibia_.check(first, "Length").verdict, Verdict::Fine);
  const Tunnel femoral = first_tunnel(BoneKind::Femur, knee_.femoral_tunnel.entry_mm, axes_, *femur_.surface);
  EXPECT_EQ(femur_.check(femoral, "Exit").verdict, Verdict::Fine);
}

// Nobody looked is no tick: what is missing is named.
TEST_P(AbsurdPlans, WhatWasNotCheckedSaysSo) {
  const BoneUnderTest bare = bone_of(knee_.femur, {}, GetParam());
  const auto checks =
      check_plan(knee_.femoral_tunnel, measure(knee_.femoral_tunnel, *bare.surface), bare.known);
  int not_checked = 0;
  for (const auto& check : checks) {
    if (check.verdict != Verdict::NotChecked) continue;
    ++not_checked;
    EXPECT_THAT(check.text, ::testing::StartsWith("not checked: "));
    EXPECT_THAT(check.text, ::testing::HasSubstr("missing"));
    EXPECT_FALSE(check.value);
  }
  EXPECT_EQ(not_checked, 4);  // two of the quadrant, the epicondyle, the footprint's outline
}

// Numbers, limits and verdicts as data say the same as the words.
TEST_P(AbsurdPlans, EveryCheckIsData) {
  for (const auto& check :
       check_plan(knee_.femoral_tunnel, measure(knee_.femoral_tunnel, *femur_.surface), femur_.known)) {
    if (!check.value || check.verdict == Verdict::Note) continue;
    const bool is_within = (!check.least || *check.value >= *check.least) &&
                           (!check.greatest || *check.value <= *check.greatest);
    EXPECT_EQ(check.verdict == Verdict::Fine, is_within) << check.name << " " << check.text;
    EXPECT_FALSE(check.unit.empty()) << check.name;
    EXPECT_FALSE(check.source.empty()) << check.name;
  }
}

// Both tunnels together: graft, flexion, roof and bends are there as numbers; without one of them they are
// not checked, but for the roof, which asks for the tibial one alone.
TEST_P(AbsurdPlans, TheKneeIsCheckedAsAWhole) {
  const auto femoral = measure(knee_.femoral_tunnel, *femur_.surface),
             tibial = measure(knee_.tibial_tunnel, *tibia_.surface);
  KneeSurroundings knee;
  put_femur(knee, femur_.mesh, femur_.known);
  knee.insertions_mm = {{BoneKind::Femur, knee_.femoral_tunnel.entry_mm},
                        {BoneKind::Tibia, knee_.tibial_tunnel.entry_mm}};
  const KneePlan plan{&knee_.femoral_tunnel, &femoral, &knee_.tibial_tunnel, &tibial};
  for (const auto kind : {BoneKind::Femur, BoneKind::Tibia}) {
    for (const auto& check : check_knee(kind, plan, knee)) {
      EXPECT_NE(check.verdict, Verdict::NotChecked) << check.name << ": " << check.text;
      EXPECT_TRUE(check.value) << check.name;
    }
    for (const auto& check : check_knee(kind, {&knee_.femoral_tunnel, &femoral, nullptr, nullptr}, knee)) {
      EXPECT_EQ(check.verdict, Verdict::NotChecked) << check.name;
      EXPECT_THAT(check.text, ::testing::HasSubstr("the tibial tunnel")) << check.name;
    }
  }
  const auto roof = check_knee(BoneKind::Tibia, plan, knee).front();
  const auto alone = check_knee(BoneKind::Tibia, {nullptr, nullptr, &knee_.tibial_tunnel, &tibial}, knee);
  EXPECT_EQ(alone.front().name, "Roof");
  EXPECT_EQ(alone.front().text, roof.text);
  EXPECT_EQ(alone.back().verdict, Verdict::NotChecked) << alone.back().name;
}

// The map about the planned entry passes somewhere near it, and fails on the rim of the notch, with a reason.
TEST_P(AbsurdPlans, TheMapTellsGoodEntriesFromBadOnes) {
  EntryMapRequest request{.entries_mm = entries_around(*femur_.surface, knee_.femoral_tunnel.entry_mm, 12, 4),
                          .like = knee_.femoral_tunnel};
  ASSERT_GT(request.entries_mm.size(), 12U);
  const auto samples = map_entries(request, *femur_.surface, femur_.known);
  ASSERT_EQ(samples.size(), request.entries_mm.size());
  int fine = 0, amiss = 0;
  for (const auto& sample : samples) {
    (sample.verdict == Verdict::Fine ? fine : amiss) += 1;
    EXPECT_EQ(sample.reason.empty(), sample.verdict == Verdict::Fine);
  }
  EXPECT_GT(fine, 0);
  EXPECT_GT(amiss, 0);
  int asked = 0;
  EXPECT_EQ(map_entries(request, *femur_.surface, femur_.known, {}, [&] { return ++asked > 3; }).size(), 3U);
}

// Through the portal the drill comes from below, from medial and from in front; straight backwards it cannot
// come. From outside in there are aims, and each leaves through the lateral cortex.
TEST_P(AbsurdPlans, APortalAllowsSomeAims) {
  KneeSurroundings knee;
  put_femur(knee, femur_.mesh, femur_.known);
  ASSERT_TRUE(knee.axis);
  const Vector3d entry = knee_.femoral_tunnel.entry_mm;
  const auto aims =
      portal_aims(entry, 4, anteromedial_portal(*knee.axis, axes_), *knee.axis, *femur_.surface);
  EXPECT_EQ(aims.size(), 7U * 9U);
  EXPECT_TRUE(std::ranges::any_of(aims, &PortalAim::is_clear));
  EXPECT_GT(off_portal_deg(-axes_.anterior, aims), 30);
  for (const auto& aim : aims) {
    EXPECT_NEAR(aim.direction.norm(), 1, 1e-12);
    EXPECT_GT(aim.direction.dot(axes_.lateral), 0) << aim.flexion_deg;
    EXPECT_GT(aim.direction.dot(axes_.proximal), 0) << aim.flexion_deg;
    if (aim.is_clear) {
      EXPECT_NEAR(off_portal_deg(aim.direction, aims), 0, 1e-5);
    }
  }
  // Each costs a measurement: rows of 21 from 75 deg down to 30 deg up.
  int asked = 0;
  const auto outside_in = outside_in_aims(knee_.femoral_tunnel, *femur_.surface, femur_.known, {},
                                          [&] { return ++asked > 15 * 21; });
  ASSERT_FALSE(outside_in.empty());
  for (const auto& direction : outside_in) {
    Tunnel tunnel = knee_.femoral_tunnel;
    tunnel.direction = direction;
    EXPECT_EQ(femur_.check(tunnel, "Exit").verdict, Verdict::Fine);
  }
}

// The portal stands off a knee as far as the knee is large.
TEST(Portal, OfALargerKneeLiesFurtherOff) {
  const auto axes = landmarks::scanner_axes(Side::Right);
  const auto portal_mm = [&](double larger) {
    const auto axis = graft::flexion_axis({{"lateral_condyle_center", larger * Vector3d(-22, 3, -4)},
                                           {"medial_condyle_center", larger * Vector3d(22, 3, -4)}},
                                          {}, axes);
    return Vector3d(anteromedial_portal(axis.value(), axes).at_mm);
  };
  EXPECT_LT((portal_mm(1.25) - 1.25 * portal_mm(1)).norm(), 1e-9);
}

}  // namespace
}  // namespace arthronaut::tunnels
