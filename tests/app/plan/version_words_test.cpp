#include "app/plan/version_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/files/format.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;
using testing::ElementsAre;
using testing::HasSubstr;

class VersionWords : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> against(const cases::Plan& plan) const {
    return against_the_plan(model_, measured_in(model_, {1, "2026-01-31T12:00:00Z", plan}));
  }
  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
};

// A drill that is 2 mm wider leaves 1 mm less of bone beside it on every side, and as long a tunnel.
TEST_F(VersionWords, SayHowLongAndHowThinTheOtherOneIs) {
  cases::Plan wider = model_.knee().plan;
  wider.tunnels.at(BoneKind::Femur).diameter_mm += 2;
  const tunnels::TunnelGeometry& now = model_.measured(BoneKind::Femur);
  EXPECT_THAT(against(wider),
              ElementsAre(files::format("femur: 2.0 mm wider; %.1f mm long (now %.1f), "
                                        "wall %.1f mm (now %.1f)",
                                        now.length_mm, now.length_mm, now.wall_mm - 1, now.wall_mm),
                          "tibia: the same"));
}

// Degrees as the rest of the panel writes them.
TEST_F(VersionWords, SayAnAngleWithItsSign) {
  cases::Plan turned = model_.knee().plan;
  Eigen::Vector3d& direction = turned.tunnels.at(BoneKind::Femur).direction;
  direction = Eigen::AngleAxisd(0.05, direction.unitOrthogonal()) * direction;  // 2.9 degrees
  EXPECT_THAT(against(turned)[0], testing::StartsWith("femur: turned by 2.9\u00B0; "));
}

// What is in one of the two alone, and what is beside the bone, has no numbers to compare.
TEST_F(VersionWords, NameNoNumbersThatThereAreNot) {
  cases::Plan other = model_.knee().plan;
  other.remove(BoneKind::Tibia);
  other.tunnels.at(BoneKind::Femur).entry_mm += Eigen::Vector3d(0, -300, 0);
  EXPECT_THAT(against(other), ElementsAre(HasSubstr("; it misses the bone"), "tibia: not planned there"));
  model_.set_tunnel(BoneKind::Tibia, std::nullopt);
  EXPECT_THAT(against(phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test").plan),
              ElementsAre("femur: the same",
                          testing::MatchesRegex("tibia: planned there alone; .* mm long, wall .* mm")));
}

// Kept before the bone was painted anew: no number of another surface stands for it.
TEST_F(VersionWords, MeasureNothingOnASurfaceThatItWasNotPlannedOn) {
  cases::Plan other = model_.knee().plan;
  other.tunnels.at(BoneKind::Femur).diameter_mm += 2;
  other.mesh_sha256.at(BoneKind::Femur) = std::string(64, 'a');
  EXPECT_THAT(against(other)[0], testing::EndsWith(": 2.0 mm wider; planned on another surface of the bone"));
}

}  // namespace
}  // namespace arthronaut::plan
