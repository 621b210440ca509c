#include "planning/tunnels/knee_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string_view>

#include "planning/geometry/rigid_transform.h"

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

// A graft between two tunnels, their openings so far apart in the joint.
class OneGraft : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<PlanCheck> checks(BoneKind bone,
                                              norms::Bundle graft = norms::Bundle::Whole) const {
    TunnelGeometry in_femur{.enters_bone = true}, in_tibia{.enters_bone = true};
    in_tibia.entry_on_surface_mm = {0, 0, -apart_mm_};
    return check_knee(bone, {&femoral_, &in_femur, &tibial_, &in_tibia, graft}, {});
  }
  static std::optional<PlanCheck> named(const std::vector<PlanCheck>& checks, std::string_view name) {
    for (const PlanCheck& check : checks)
      if (check.name == name) return check;
    return std::nullopt;
  }

  double apart_mm_ = 30;
  Tunnel femoral_{.bone = BoneKind::Femur, .diameter_mm = 9},
      tibial_{.bone = BoneKind::Tibia, .diameter_mm = 9};
};

// What no study's ligament is as short or as long as, is said; of a bundle nobody has published a limit.
TEST_F(OneGraft, IsHeldAgainstTheLigamentsOfStudies) {
  EXPECT_EQ(named(checks(BoneKind::Femur), "Graft length")->verdict, Verdict::Fine);
  apart_mm_ = 17.9;
  const auto is_short = named(checks(BoneKind::Femur), "Graft length");
  EXPECT_EQ(is_short->verdict, Verdict::Look);
  EXPECT_EQ(is_short->text, "17.9 mm in the joint, 17.9 mm in all: shorter in the joint than 26 mm");
  EXPECT_EQ(named(checks(BoneKind::Femur, norms::Bundle::Posterolateral), "Graft length")->verdict,
            Verdict::Note);
  apart_mm_ = 45;
  EXPECT_EQ(named(checks(BoneKind::Femur), "Graft length")->verdict, Verdict::Look);
}

// Both tunnels are within the norm of a diameter, and one graft goes through both.
TEST_F(OneGraft, IsOfOneDiameter) {
  EXPECT_FALSE(named(checks(BoneKind::Femur), "Graft diameter"));
  tibial_.diameter_mm = 9.5;
  EXPECT_EQ(named(checks(BoneKind::Tibia), "Graft diameter")->verdict, Verdict::Note);
  tibial_.diameter_mm = 10;
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) {
    const auto check = named(checks(bone), "Graft diameter");
    ASSERT_TRUE(check);
    EXPECT_EQ(check->verdict, Verdict::Look);
    EXPECT_EQ(check->text, "femur 9.0 mm, tibia 10.0 mm, 1.0 mm apart: one graft is seldom of two widths");
  }
}

// A knee whose tibia was imaged turned backwards by so much. The tunnel's mouth lies 30 mm below the roof's
// anterior end and so far behind it.
class RoofAsImaged : public ::testing::Test {
 protected:
  [[nodiscard]] PlanCheck roof(double flexed_deg, double behind_mm) const {
    KneeSurroundings knee;
    knee.femur_landmarks = {{"blumensaat_anterior", {0, -10, 0}}, {"blumensaat_posterior", {0, 10, 12}}};
    knee.femur_axes = landmarks::AnatomicalAxes{.origin = landmarks::AnatomicalAxes::Origin::FromLandmarks};
    const double flexed = flexed_deg * geometry::kPi / 180;
    knee.tibia_axes = landmarks::AnatomicalAxes{.origin = landmarks::AnatomicalAxes::Origin::FromLandmarks,
                                                .anterior = {0, -std::cos(flexed), -std::sin(flexed)},
                                                .proximal = {0, -std::sin(flexed), std::cos(flexed)}};
    if (std::isnan(flexed_deg)) knee.tibia_axes.reset();
    const Tunnel tibial{.bone = BoneKind::Tibia, .direction = {0, 0, -1}, .diameter_mm = 9};
    TunnelGeometry in_tibia{.enters_bone = true};
    in_tibia.entry_on_surface_mm = {0, -10 + behind_mm, -30};
    return check_knee(BoneKind::Tibia, {.tibial = &tibial, .tibial_measured = &in_tibia}, knee).front();
  }
};

// In a knee that was imaged flexed the number says nothing of extension: no tick. One that is pressed on
// already is pressed on the more as it is extended.
TEST_F(RoofAsImaged, IsJudgedInExtensionAlone) {
  EXPECT_EQ(roof(4, 40).verdict, Verdict::Fine);
  EXPECT_THAT(roof(4, 40).text, HasSubstr(" in extension"));
  EXPECT_THAT(roof(4, 40).source, HasSubstr("within 10 deg of it"));
  const PlanCheck flexed = roof(21, 40);
  EXPECT_EQ(flexed.verdict, Verdict::Note);
  EXPECT_TRUE(flexed.text.ends_with(
      " between roof and graft, as imaged: flexed by about 21 deg, so it is not judged"))
      << flexed.text;
  EXPECT_EQ(roof(21, 0).verdict, Verdict::Look);
  EXPECT_THAT(roof(21, 0).text, HasSubstr("presses on it already"));
  const PlanCheck unknown = roof(std::nan(""), 40);
  EXPECT_EQ(unknown.verdict, Verdict::Fine);
  EXPECT_THAT(unknown.source, HasSubstr("how far it was flexed is not known"));
}

}  // namespace
}  // namespace arthronaut::tunnels
