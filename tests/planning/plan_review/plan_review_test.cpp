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
  const CaseReview review(knee_);
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
}

}  // namespace
}  // namespace arthronaut::plan_review
