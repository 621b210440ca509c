#include "planning/plan_review/plan_review.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <regex>
#include <set>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan_review {
namespace {

using bones::BoneKind;
using Verdict = tunnels::PlanCheck::Verdict;

class PlanReview : public ::testing::Test {
 protected:
  cases::Case knee_ = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
};

bool has(const std::vector<tunnels::PlanCheck>& checks, const char* name) {
  return std::ranges::count(checks, name, &tunnels::PlanCheck::name) == 1;
}

// Of a knee that lacks nothing nothing is left unchecked, and no question is asked twice.
TEST_F(PlanReview, AsksEverythingOnceOfAWholeKnee) {
  const auto by_shape = propose_landmarks(knee_, Proposing::Planned);
  const CaseReview review(knee_, by_shape);
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    const auto checks = review.checks(kind);
    std::set<std::string> names;
    for (const auto& check : checks) {
      EXPECT_NE(check.verdict, Verdict::NotChecked) << check.name << ": " << check.text;
      EXPECT_TRUE(names.insert(check.name).second) << check.name << " twice";
    }
    EXPECT_TRUE(has(checks, "Length"));
    EXPECT_TRUE(has(checks, "Entry"));
  }
  EXPECT_TRUE(has(review.checks(BoneKind::Femur), "Graft length"));
  EXPECT_TRUE(has(review.checks(BoneKind::Femur), "Footprint opened"));
}

std::vector<double> numbers_in(const std::string& text) {
  static const std::regex number("-?[0-9]+(\\.[0-9]+)?");
  std::vector<double> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at)
    numbers.push_back(std::stod(at->str()));
  return numbers;
}

// What is read on the screen is the number that was judged, rounded: a tenth where the words have tenths.
TEST_F(PlanReview, TheWordsSayTheNumberThatIsJudged) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> turn(-0.2, 0.2), wider(-2, 3);
  std::set<std::string> seen;
  for (int trial = 0; trial < 12; ++trial) {
    cases::Case knee = knee_;
    for (auto& [key, tunnel] : knee.plan.tunnels) {
      const Eigen::Vector3d by(turn(random), turn(random), turn(random));
      tunnel.direction = (tunnel.direction + by).normalized();
      tunnel.diameter_mm = std::round(20 * (tunnel.diameter_mm + wider(random))) / 20;
    }
    const CaseReview review(knee);
    for (const auto& [key, planned] : review.tunnels())
      for (const auto& check : review.checks(key)) {
        if (!check.value) continue;
        seen.insert(check.name);
        if (check.text.starts_with("the same within 0.1 mm")) {
          EXPECT_LT(std::abs(*check.value), 0.1) << check.name;
          continue;
        }
        const auto numbers = numbers_in(check.text);
        const double within = check.unit == "deg" || check.unit == "%" ? 0.501 : 0.0501;
        EXPECT_TRUE(std::ranges::any_of(
            numbers, [&](double number) { return std::abs(number - *check.value) < within; }))
            << check.name << " of " << *check.value << ' ' << check.unit << ": " << check.text;
      }
  }
  EXPECT_GE(seen.size(), 15U);
}

// The ellipse that a cylinder cuts out of a plane, from diameter and angle alone.
TEST_F(PlanReview, TheOpeningIsTheCylindersEllipse) {
  for (const double diameter_mm : {5.5, 9.0, 12.0}) {
    for (auto& [key, tunnel] : knee_.plan.tunnels) tunnel.diameter_mm = diameter_mm;
    const CaseReview review(knee_);
    for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
      const auto checks = review.checks(kind);
      const auto opening = std::ranges::find(checks, "Opening", &tunnels::PlanCheck::name);
      ASSERT_NE(opening, checks.end());
      const auto numbers = numbers_in(opening->text);  // 14.0 x 9.0 mm, 99 mm2, at 40 deg
      ASSERT_GE(numbers.size(), 5U) << opening->text;
      const double sine = std::sin(*opening->value * std::acos(-1.0) / 180);
      EXPECT_NEAR(numbers[0], diameter_mm / sine, 0.051) << opening->text;
      EXPECT_NEAR(numbers[1], diameter_mm, 0.051) << opening->text;
      EXPECT_NEAR(numbers[2], std::acos(-1.0) / 4 * diameter_mm * diameter_mm / sine, 0.51) << opening->text;
      EXPECT_NEAR(numbers[4], *opening->value, 0.51) << opening->text;
    }
  }
}

// What is asked of both bones together: none is made where they do not lie in one frame.
std::vector<tunnels::PlanCheck> of_both_bones(const cases::Case& knee) {
  const CaseReview review(knee);
  std::vector<tunnels::PlanCheck> found;
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    for (const auto& check : review.checks(kind))
      for (const char* name : {"Graft length", "Length over flexion", "Against the insertions",
                               "Bend at the femur", "Roof", "Bend at the tibia"})
        if (check.name == name) found.push_back(check);
  return found;
}

cases::Case with_moved_tibia(cases::Case knee, const geometry::RigidTransform& moved) {
  for (auto& point : knee.bones.at(BoneKind::Tibia).mesh.vertices_mm) point = moved * point;
  for (auto& [name, point] : knee.landmarks[BoneKind::Tibia]) point = moved * point;
  tunnels::Tunnel& tunnel = knee.plan.tunnels.at(BoneKind::Tibia);
  tunnel.entry_mm = moved * tunnel.entry_mm;
  tunnel.direction = moved.rotation * tunnel.direction;
  return knee;
}

void expect_apart(const cases::Case& knee) {
  const auto checks = of_both_bones(knee);
  EXPECT_EQ(checks.size(), 6U);
  for (const auto& check : checks) {
    EXPECT_EQ(check.verdict, Verdict::NotChecked) << check.name << ": " << check.text;
    EXPECT_FALSE(check.value) << check.name;
    EXPECT_NE(check.text.find("do not lie in one frame"), std::string::npos) << check.text;
    EXPECT_FALSE(check.source.empty());
  }
}

// Hazard 51: two meshes of different origins, or a bone of another scan.
TEST_F(PlanReview, Hazard51OfBonesThatLieApartNothingIsAskedTogether) {
  for (const Eigen::Vector3d& off_mm :
       {Eigen::Vector3d(200, 60, -300), Eigen::Vector3d(0, 100, 0), Eigen::Vector3d(0, 0, 40),
        Eigen::Vector3d(0, 0, -40), Eigen::Vector3d(30, 30, 20), Eigen::Vector3d(-30, 0, 0)}) {
    SCOPED_TRACE(off_mm.transpose());
    cases::Case apart = with_moved_tibia(knee_, {Eigen::Quaterniond::Identity(), off_mm});
    expect_apart(apart);
    apart.landmarks.erase(BoneKind::Tibia);  // the shape tells it, too
    expect_apart(apart);
  }
  // In the other axes (RAS) it stands the other way round, however near.
  const Eigen::Quaterniond about_z(Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitZ()));
  expect_apart(with_moved_tibia(knee_, {about_z, Eigen::Vector3d::Zero()}));
}

// Two frames of reference say nothing of each other, however near the numbers are.
TEST_F(PlanReview, Hazard51OfBonesOfTwoFramesNothingIsAskedTogether) {
  knee_.is_of_two_frames = true;
  expect_apart(knee_);
}

// However a knee was bent in the scanner, and however large it is, its bones lie in one frame.
TEST_F(PlanReview, BonesOfABentKneeLieInOneFrame) {
  for (const std::uint64_t seed : {1, 4, 7}) {
    const auto side = seed == 4 ? bones::Side::Left : bones::Side::Right;
    const cases::Case knee = phantom::case_of(
        phantom::make_phantom_knee({.side = side, .seed = seed, .edge_length_mm = 4}), "test");
    const CaseReview review(knee);
    tunnels::KneeSurroundings surroundings;
    tunnels::put_femur(surroundings, knee.bones.at(BoneKind::Femur).mesh,
                       review.bone(BoneKind::Femur).surroundings);
    const auto axis = surroundings.axis;
    ASSERT_TRUE(axis);
    for (const double flexion_deg : {-10, 0, 30, 60, 90}) {
      const auto turn = graft::femur_from_tibia(*axis, geometry::rad_from_deg(flexion_deg));
      const Eigen::Quaterniond rotated(
          Eigen::AngleAxisd(geometry::rad_from_deg(flexion_deg / 4), Eigen::Vector3d::UnitZ()));
      cases::Case bent = with_moved_tibia(with_moved_tibia(knee, {rotated, Eigen::Vector3d::Zero()}), turn);
      for (const bool has_landmarks : {true, false}) {
        if (!has_landmarks && flexion_deg > 60) continue;  // by its shape alone it is taken to stand upright
        if (!has_landmarks) bent.landmarks.erase(BoneKind::Tibia);
        for (const auto& check : of_both_bones(bent))
          EXPECT_EQ(check.text.find("one frame"), std::string::npos)
              << seed << ", " << flexion_deg << " deg: " << check.source;
      }
    }
  }
}

// What a bone's shape alone does not tell is said to be unchecked; it is no tick.
TEST_F(PlanReview, WithoutLandmarksSaysWhatItCouldNotCheck) {
  knee_.landmarks.clear();
  const auto checks = CaseReview(knee_).checks(BoneKind::Femur);
  EXPECT_GT(std::ranges::count(checks, Verdict::NotChecked, &tunnels::PlanCheck::verdict), 0);
}

TEST_F(PlanReview, ATunnelBesideTheBoneIsOneWrongCheck) {
  knee_.plan.tunnels.at(BoneKind::Femur).entry_mm += Eigen::Vector3d(0, -300, 0);
  const auto checks = CaseReview(knee_).checks(BoneKind::Femur);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks.front().verdict, Verdict::Wrong);
}

TEST_F(PlanReview, OfABoneThatTheCaseLacksThereIsNothing) {
  knee_.bones.erase(BoneKind::Tibia);
  const CaseReview review(knee_);
  EXPECT_FALSE(review.has_bone(BoneKind::Tibia));
  EXPECT_FALSE(review.tunnels().contains(BoneKind::Tibia));
  EXPECT_TRUE(review.checks(BoneKind::Tibia).empty());
  EXPECT_FALSE(review.checks(BoneKind::Femur).empty());
}

using norms::Bundle;

const tunnels::PlanCheck& named(const std::vector<tunnels::PlanCheck>& checks, const char* name) {
  return *std::ranges::find(checks, name, &tunnels::PlanCheck::name);
}

// Two tunnels of one direction, so far apart beside each other that 3 mm are between them: each says so.
TEST_F(PlanReview, TwoTunnelsOfABoneSayWhatIsBetweenThem) {
  tunnels::Tunnel am = knee_.plan.tunnels.at(BoneKind::Femur), pl = am;
  am.bundle = Bundle::Anteromedial;
  pl.bundle = Bundle::Posterolateral;
  am.diameter_mm = 7;
  pl.diameter_mm = 6;
  pl.entry_mm += 9.5 * am.direction.unitOrthogonal();
  knee_.plan.put(am, "");
  knee_.plan.put(pl, "");
  const CaseReview review(knee_);
  for (const tunnels::TunnelKey& key : {am.key(), pl.key()}) {
    const auto checks = review.checks(key);
    ASSERT_TRUE(has(checks, "Between the tunnels")) << tunnels::name_of(key);
    const auto& between = named(checks, "Between the tunnels");
    EXPECT_EQ(between.verdict, Verdict::Fine);
    ASSERT_TRUE(between.value && between.least);
    EXPECT_NEAR(*between.value, 3.0, 0.01);
    EXPECT_FALSE(between.source.empty());
    // Both go to the one tunnel of the tibia.
    EXPECT_NE(named(checks, "Graft length").verdict, Verdict::NotChecked);
  }
  EXPECT_TRUE(review.checks(BoneKind::Femur).empty()) << "the bone alone is none of the two";
  // Which of two the tibia's single one goes to nobody has said.
  const auto tibial = review.checks(BoneKind::Tibia);
  EXPECT_EQ(named(tibial, "Bend at the tibia").verdict, Verdict::NotChecked);
  EXPECT_NE(named(tibial, "Roof").verdict, Verdict::NotChecked) << "it asks for the tibial tunnel alone";
  knee_.plan.tunnels.at(pl.key()).entry_mm = am.entry_mm + 4 * am.direction.unitOrthogonal();
  EXPECT_EQ(named(CaseReview(knee_).checks(am.key()), "Between the tunnels").verdict, Verdict::Wrong);
}

// A graft's ends are of one bundle.
TEST_F(PlanReview, AGraftGoesFromBundleToBundle) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    tunnels::Tunnel tunnel = knee_.plan.tunnels.at(kind);
    for (const Bundle bundle : {Bundle::Anteromedial, Bundle::Posterolateral}) {
      tunnel.bundle = bundle;
      tunnel.entry_mm.z() += bundle == Bundle::Posterolateral ? 1 : 0;
      knee_.plan.put(tunnel, "");
    }
  }
  const CaseReview review(knee_);
  for (const Bundle bundle : {Bundle::Anteromedial, Bundle::Posterolateral}) {
    const auto* end = other_end({BoneKind::Femur, bundle}, review.tunnels());
    ASSERT_NE(end, nullptr);
    EXPECT_EQ(end->tunnel.key(), tunnels::TunnelKey(BoneKind::Tibia, bundle));
  }
  EXPECT_EQ(other_end(BoneKind::Femur, review.tunnels()), nullptr);
  // A single tunnel beside them has no graft, and the two that are there are not called missing.
  for (const Bundle bundle : {Bundle::Anteromedial, Bundle::Posterolateral})
    knee_.plan.remove({BoneKind::Tibia, bundle});
  const cases::Case single = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "single");
  knee_.plan.put(single.plan.tunnels.at(BoneKind::Tibia), "");
  EXPECT_EQ(named(CaseReview(knee_).checks(BoneKind::Tibia), "Bend at the tibia").text,
            "not checked: the femoral tunnel, as one of two bundles is planned there, is missing");
}

}  // namespace
}  // namespace arthronaut::plan_review
