#include "planning/plan_review/plan_review.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  EXPECT_EQ(review.tunnel(BoneKind::Tibia).tunnel, nullptr);
  EXPECT_TRUE(review.checks(BoneKind::Tibia).empty());
  EXPECT_FALSE(review.checks(BoneKind::Femur).empty());
}

}  // namespace
}  // namespace arthronaut::plan_review
