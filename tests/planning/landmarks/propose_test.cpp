#include "planning/landmarks/propose.h"

#include <gtest/gtest.h>
#include <time.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "planning/geometry/rigid_transform.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::landmarks {
namespace {

using bones::BoneKind;
using bones::Side;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::TriangleMesh;

TriangleMesh turned(TriangleMesh mesh, const Matrix3d& turn, const Vector3d& shift) {
  for (auto& v : mesh.vertices_mm) v = turn * v + shift;
  if (turn.determinant() < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

const phantom::PhantomKnee& knee() {
  static const auto made = phantom::make_phantom_knee({.side = Side::Right, .edge_length_mm = 1.5});
  return made;
}

const TriangleMesh& mesh_of(BoneKind bone) {
  return bone == BoneKind::Femur ? knee().femur.mesh : knee().tibia.mesh;
}

const Proposal& straight(BoneKind bone) {
  static const Proposal femur = propose(knee().femur.mesh, BoneKind::Femur),
                        tibia = propose(knee().tibia.mesh, BoneKind::Tibia);
  return bone == BoneKind::Femur ? femur : tibia;
}

class EitherBone : public ::testing::TestWithParam<BoneKind> {};

// However the bone lies, the same points of it are proposed. 0.5 mm is what the plan is asked to keep to.
TEST_P(EitherBone, GivesTheSamePointsHoweverItLies) {
  const Proposal& as_it_was = straight(GetParam());
  ASSERT_TRUE(as_it_was.is_usable()) << as_it_was.reason;
  const Matrix3d turn = Eigen::AngleAxisd(2.1, Vector3d(1, -0.4, 0.7).normalized()).toRotationMatrix();
  const Vector3d shift(120, -300, 40);
  const Proposal proposal = propose(turned(mesh_of(GetParam()), turn, shift), GetParam());
  ASSERT_TRUE(proposal.is_usable()) << proposal.reason;
  EXPECT_EQ(proposal.side_by_shape, Side::Right);
  for (const auto& [name, at] : as_it_was.landmarks) {
    ASSERT_TRUE(proposal.landmarks.contains(name)) << name;
    EXPECT_LT((proposal.landmarks.at(name) - (turn * at + shift)).norm(), 0.5) << name;
  }
  EXPECT_LT((proposal.axes.proximal - turn * as_it_was.axes.proximal).norm(), 0.01);
  EXPECT_LT((proposal.axes.lateral - turn * as_it_was.axes.lateral).norm(), 0.01);
}

// The mirror image of a right bone is a left one, and is told so without a word.
TEST_P(EitherBone, TellsTheSideOfAMirrorImage) {
  Matrix3d mirror = Matrix3d::Identity();
  mirror(0, 0) = -1;
  const Proposal proposal = propose(turned(mesh_of(GetParam()), mirror, Vector3d::Zero()), GetParam());
  ASSERT_TRUE(proposal.is_usable()) << proposal.reason;
  EXPECT_EQ(proposal.side_by_shape, Side::Left);
  EXPECT_TRUE(proposal.doubts.empty());
  // As however else it lies: what the plan is asked to keep to.
  for (const char* name : {"blumensaat_anterior", "blumensaat_posterior", "notch_apex", "plateau_anterior",
                           "plateau_posterior", "medial_eminence", "lateral_eminence"}) {
    const auto at = straight(GetParam()).landmarks.find(name);
    if (at == straight(GetParam()).landmarks.end()) continue;
    EXPECT_LT((proposal.landmarks.at(name) - mirror * at->second).norm(), 0.5) << name;
  }
}

TEST_P(EitherBone, DoubtsASideThatTheShapeContradicts) {
  const Proposal proposal = propose(mesh_of(GetParam()), GetParam(), {.side = Side::Left});
  ASSERT_TRUE(proposal.is_usable());
  ASSERT_EQ(proposal.doubts.size(), 1u);
  EXPECT_NE(proposal.doubts[0].find("the case says left"), std::string::npos);
  // The case is followed: medial and lateral are named by it.
  EXPECT_LT(proposal.axes.lateral.dot(straight(GetParam()).axes.lateral), -0.9);
}

// A ball, a cylinder, an empty mesh are no bones; nothing is proposed and the reason is said.
TEST_P(EitherBone, RefusesWhatIsNoBone) {
  for (const auto& mesh : {test::box({30, 20, 45}), TriangleMesh()}) {
    const Proposal proposal = propose(mesh, GetParam());
    EXPECT_EQ(proposal.outcome, Proposal::Outcome::NotThisBone);
    EXPECT_FALSE(proposal.reason.empty());
    EXPECT_TRUE(proposal.landmarks.empty());
  }
}

// A window that closes does not wait for it. In processor time, whatever else runs; what is left is the index
// of the surface.
TEST_P(EitherBone, StopsWhenItIsAskedTo) {
  const auto spent_s = [] {
    timespec spent{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
  };
  const TriangleMesh mesh = mesh_of(GetParam());
  const double begun_s = spent_s();
  ASSERT_TRUE(propose(mesh, GetParam()).is_usable());
  const double whole_s = spent_s() - begun_s;
  std::stop_source stop;
  stop.request_stop();
  const Proposal proposal = propose(mesh, GetParam(), {.side = {}, .stop = stop.get_token()});
  EXPECT_LT(spent_s() - begun_s - whole_s, whole_s / 3);
  EXPECT_EQ(proposal.outcome, Proposal::Outcome::Stopped);
  EXPECT_TRUE(proposal.landmarks.empty());
}

INSTANTIATE_TEST_SUITE_P(Both, EitherBone, ::testing::Values(BoneKind::Femur, BoneKind::Tibia),
                         [](const auto& test) { return std::string(bones::to_text(test.param)); });

// The phantom knows where its landmarks are. 3 mm is what points picked by hand are worth; Blumensaat's line
// 4 degrees.
TEST(Propose, FindsThePhantomsOwnLandmarks) {
  for (const std::uint64_t seed : {1u, 4u}) {
    const auto made = phantom::make_phantom_knee({.side = Side::Left, .seed = seed, .edge_length_mm = 1.5});
    const Proposal femur = propose(made.femur.mesh, BoneKind::Femur);
    ASSERT_TRUE(femur.is_usable()) << femur.reason;
    EXPECT_EQ(femur.side_by_shape, Side::Left);
    const auto& truth = made.femur_landmarks;
    const auto line = [](const Landmarks& marks) {
      return Vector3d((marks.at("blumensaat_anterior") - marks.at("blumensaat_posterior")).normalized());
    };
    EXPECT_GT(line(femur.landmarks).dot(line(truth)), std::cos(geometry::rad_from_deg(4)));
    // How far back a condyle reaches: within half a millimetre, of triangles with edges of 1.5 mm. How high
    // on its round outline that is nobody can tell; and medial-lateral a back of 20 mm radius reaches as far
    // to that half millimetre over 4.5 mm.
    constexpr double kReach_mm = 0.5, kBack_mm = 20;
    for (const char* name : {"medial_condyle_posterior", "lateral_condyle_posterior"}) {
      const Vector3d off = femur.landmarks.at(name) - truth.at(name);
      EXPECT_LT(std::abs(off.dot(femur.axes.anterior)), kReach_mm) << name << " of seed " << seed;
      EXPECT_LT(std::abs(off.dot(femur.axes.lateral)), std::sqrt(2 * kBack_mm * kReach_mm))
          << name << " of seed " << seed;
    }
    // The roof is a straight vault: across it the true apex lies on the line, to what the vault is flat by in
    // the middle.
    const Vector3d off = truth.at("notch_apex") - femur.landmarks.at("blumensaat_anterior");
    EXPECT_LT((off - off.dot(line(femur.landmarks)) * line(femur.landmarks)).norm(), 1.5) << "seed " << seed;
    const Proposal tibia = propose(made.tibia.mesh, BoneKind::Tibia);
    ASSERT_TRUE(tibia.is_usable()) << tibia.reason;
    EXPECT_EQ(tibia.side_by_shape, Side::Left);
    // The truth is the middle of a ridge 8 mm long that the plateau's slope tilts: its top lies elsewhere.
    for (const char* name : {"medial_eminence", "lateral_eminence"})
      EXPECT_LT((tibia.landmarks.at(name) - made.tibia_landmarks.at(name)).norm(), 3.0)
          << name << " of seed " << seed;
  }
}

// What somebody has confirmed stays; what was proposed before, or is not there, is proposed anew, and what is
// proposed no more goes.
TEST(TakeProposal, LeavesConfirmedLandmarksAlone) {
  Proposal proposal;
  proposal.outcome = Proposal::Outcome::Proposed;
  proposal.landmarks = {{"a", {1, 0, 0}}, {"b", {2, 0, 0}}, {"c", {3, 0, 0}}};
  Landmarks landmarks = {{"a", {9, 9, 9}}, {"b", {8, 8, 8}}, {"d", {7, 7, 7}}};
  LandmarkStates states = {{"b", LandmarkState::Proposed}, {"d", LandmarkState::Proposed}};
  take_proposal({}, landmarks, states);
  EXPECT_EQ(landmarks.size(), 3U);
  take_proposal(proposal, landmarks, states);
  EXPECT_EQ(landmarks.at("a"), Vector3d(9, 9, 9));
  EXPECT_EQ(landmarks.at("b"), Vector3d(2, 0, 0));
  EXPECT_EQ(state_of(states, "a"), LandmarkState::Confirmed);
  EXPECT_EQ(state_of(states, "c"), LandmarkState::Proposed);
  EXPECT_FALSE(landmarks.contains("d"));
  EXPECT_FALSE(states.contains("d"));
}

}  // namespace
}  // namespace arthronaut::landmarks
