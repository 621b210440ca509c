#include "planning/tunnels/knee_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace arthronaut::tunnels {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using Verdict = PlanCheck::Verdict;

// A hinge along x through the origin. The tibia's end of every graft hangs 30 mm below it; the femur's lies
// on the hinge, or in front of it or behind by so much that the string's length follows from the triangle.
class LengthOverFlexion : public ::testing::Test {
 protected:
  void set_insertions(double femoral_y_mm) {
    knee_.insertions_mm = {{BoneKind::Femur, {0, femoral_y_mm, 0}}, {BoneKind::Tibia, tibial_mm_}};
  }
  [[nodiscard]] PlanCheck check(const char* name, double femoral_y_mm) const {
    const Tunnel femoral{.bone = BoneKind::Femur}, tibial{.bone = BoneKind::Tibia};
    TunnelGeometry in_femur{.enters_bone = true}, in_tibia{.enters_bone = true};
    in_femur.entry_on_surface_mm = {0, femoral_y_mm, 0};
    in_tibia.entry_on_surface_mm = tibial_mm_;
    for (const PlanCheck& check :
         check_knee(BoneKind::Femur, {&femoral, &in_femur, &tibial, &in_tibia}, knee_))
      if (check.name == name) return check;
    ADD_FAILURE() << name;
    return {};
  }
  // Its length at 90 deg less that in extension.
  static double longer_mm(double femoral_y_mm) {
    const double squares = femoral_y_mm * femoral_y_mm + 30 * 30;
    return std::sqrt(squares - 60 * femoral_y_mm) - std::sqrt(squares);
  }

  Vector3d tibial_mm_{0, 0, -30};
  KneeSurroundings knee_{.axis = graft::FlexionAxis{}};
};

// What this knee's own ligament does not keep in the model is no reproach to a plan; the number, the custom
// and what the ligament does are all said.
TEST_F(LengthOverFlexion, IsNoReproachWhereTheInsertionsDoTheSame) {
  set_insertions(4);
  const PlanCheck check = this->check("Length over flexion", 5);
  EXPECT_EQ(check.verdict, Verdict::Note);
  EXPECT_NEAR(*check.value, -longer_mm(5), 1e-9);
  EXPECT_EQ(*check.greatest, 3);
  EXPECT_THAT(
      check.text,
      HasSubstr("more than the customary 3 mm; between the insertions' middles in the same hinge 4.3 mm"));
  EXPECT_EQ(this->check("Length over flexion", 1).verdict, Verdict::Fine);
}

TEST_F(LengthOverFlexion, IsJudgedByTheCustomWhereTheInsertionsKeepItOrAreUnknown) {
  EXPECT_EQ(check("Length over flexion", 5).verdict, Verdict::Look);
  EXPECT_EQ(check("Against the insertions", 5).verdict, Verdict::NotChecked);
  knee_.insertions_mm = {{BoneKind::Femur, {0, 1, 0}}};
  EXPECT_THAT(check("Against the insertions", 5).text, HasSubstr("not checked: the grid of the tibia"));
  set_insertions(1);
  const PlanCheck check = this->check("Length over flexion", 5);
  EXPECT_EQ(check.verdict, Verdict::Look);
  EXPECT_THAT(check.text, HasSubstr("; between the insertions' middles in the same hinge 1.0 mm"));
}

// A plan on the hinge keeps its length, which is not what the ligament does there: set in extension, it is
// tight in flexion. One further from the hinge than the ligament is slack.
TEST_F(LengthOverFlexion, IsHeldAgainstTheInsertionsInBothDirections) {
  set_insertions(4);
  const PlanCheck same = check("Against the insertions", 4);
  EXPECT_EQ(same.verdict, Verdict::Fine);
  EXPECT_NEAR(*same.value, 0, 1e-9);
  EXPECT_EQ(same.text, "the same within 0.1 mm");
  const PlanCheck tight = check("Against the insertions", 0);
  EXPECT_EQ(tight.verdict, Verdict::Look);
  EXPECT_NEAR(*tight.value, -longer_mm(4), 1e-9);
  EXPECT_EQ(tight.text, "up to 4.3 mm tighter, at 90.0 deg: more than 3 mm");
  const PlanCheck slack = check("Against the insertions", 6);
  EXPECT_EQ(slack.verdict, Verdict::Fine);
  EXPECT_NEAR(*slack.value, longer_mm(4) - longer_mm(6), 1e-9);
  EXPECT_THAT(slack.text, HasSubstr("slacker, at 90.0 deg"));
}

}  // namespace
}  // namespace arthronaut::tunnels
