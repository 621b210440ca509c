#include "app/case/plan_model.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "planning/geometry/error.h"
#include "planning/phantom/phantom_case.h"
#include "planning/plan_review/proposed_landmarks.h"

namespace arthronaut::open_case {
namespace {

using bones::BoneKind;

cases::Case phantom() {
  return phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test");
}

// It is made beside whoever asks.
bool has_proposal_in_time(const PlanModel& model, BoneKind kind) {
  for (int tenths = 0; tenths < 600 && !model.proposal(kind); ++tenths)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  return model.proposal(kind).has_value();
}

// What the panel shows follows the plan at once, and the revision counts the changes.
TEST(PlanModel, MeasuresAnewWithEveryChange) {
  PlanModel model(phantom());
  const std::uint64_t first = model.revision();
  const double length = model.measured(BoneKind::Femur).length_mm;
  ASSERT_TRUE(model.measured(BoneKind::Femur).enters_bone);
  EXPECT_FALSE(model.checks(BoneKind::Femur).empty());
  tunnels::Tunnel tunnel = *model.tunnel(BoneKind::Femur);
  tunnel.direction = (tunnel.direction + Eigen::Vector3d(0, 0, 0.4)).normalized();
  model.set_tunnel(BoneKind::Femur, tunnel);
  EXPECT_GT(model.revision(), first);
  EXPECT_GT(std::abs(model.measured(BoneKind::Femur).length_mm - length), 0.1);
  model.set_tunnel(BoneKind::Femur, std::nullopt);
  EXPECT_FALSE(model.tunnel(BoneKind::Femur));
  EXPECT_TRUE(model.checks(BoneKind::Femur).empty());
}

// Screen, command line and report say the same of one plan.
TEST(PlanModel, SaysWhatTheReviewOfTheCaseSays) {
  const PlanModel model(phantom());
  cases::Case knee = model.knee();
  const auto by_shape = plan_review::propose_landmarks(knee, plan_review::Proposing::Planned);
  const plan_review::CaseReview review(knee, by_shape);
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    EXPECT_TRUE(has_proposal_in_time(model, kind));
    const auto here = model.checks(kind), there = review.checks(kind);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      EXPECT_EQ(here[i].text, there[i].text);
      EXPECT_EQ(here[i].verdict, there[i].verdict) << here[i].name;
    }
  }
}

// The defaults of a bone's two bundles are made at once: where a hand has put one of them moves neither.
TEST(PlanModel, ADefaultKeepsNoClearOfWhatItsOwnPairTakesThePlaceOf) {
  PlanModel model(phantom());
  const tunnels::TunnelKey am{BoneKind::Femur, norms::Bundle::Anteromedial},
      pl{BoneKind::Femur, norms::Bundle::Posterolateral};
  const tunnels::Tunnel fresh = model.default_tunnel(am).tunnel;
  tunnels::Tunnel in_the_way = model.default_tunnel(pl).tunnel;
  in_the_way.entry_mm = fresh.entry_mm;
  model.set_tunnel(pl, in_the_way);
  EXPECT_EQ(model.default_tunnel(am).tunnel.entry_mm, fresh.entry_mm);
}

// A case that was saved before somebody confirmed its landmarks: opened again it knows what the shape
// proposes, so that "As proposed" and the default plan need not look for it while a key is held.
TEST(PlanModel, KnowsWhatTheShapeProposesUntilTheGridIsConfirmed) {
  cases::Case knee = phantom();
  EXPECT_FALSE(PlanModel(knee).proposal(BoneKind::Femur)) << "a person placed them";
  for (const auto& [name, position] : knee.landmarks.at(BoneKind::Femur))
    knee.landmark_states[BoneKind::Femur][name] = landmarks::LandmarkState::Proposed;
  const PlanModel model(knee);
  ASSERT_TRUE(model.proposal(BoneKind::Femur));
  EXPECT_TRUE(model.proposal(BoneKind::Femur)->landmarks.contains("blumensaat_anterior"));
  EXPECT_EQ(model.landmarks(BoneKind::Femur), knee.landmarks.at(BoneKind::Femur)) << "those of the case stay";
  EXPECT_FALSE(model.proposal(BoneKind::Tibia));
}

// A case without a bone is refused with its name.
// The window closed while it was opened.
TEST(PlanModel, IsNotMadeByHalves) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(PlanModel(phantom(), stop.get_token()), InvalidInput);
}

// Where the images end within a bone is known, whatever becomes of its landmarks.
TEST(PlanModel, Hazard46WhereTheImagesEndOutlastsOtherLandmarks) {
  PlanModel model(phantom());
  const auto length = [&] { return model.checks(BoneKind::Femur).front(); };
  ASSERT_EQ(length().name, "Length");
  EXPECT_EQ(length().verdict, tunnels::PlanCheck::Verdict::Fine);
  const Eigen::Vector3d out = model.tunnel(BoneKind::Femur)->direction;
  model.set_unseen(BoneKind::Femur, {.image_cuts = {{.at_mm = model.measured(BoneKind::Femur).exit_mm - out,
                                                     .out = out,
                                                     .area_mm2 = 500}}});
  EXPECT_EQ(length().verdict, tunnels::PlanCheck::Verdict::NotChecked);
  model.set_landmarks(BoneKind::Femur, model.landmarks(BoneKind::Femur),
                      model.landmark_states(BoneKind::Femur));
  EXPECT_EQ(length().verdict, tunnels::PlanCheck::Verdict::NotChecked);
}

TEST(PlanModel, RefusesACaseWithoutBones) {
  cases::Case empty;
  empty.name = "nothing";
  EXPECT_THROW(PlanModel{empty}, InvalidInput);
}

// Hazard 21: a plan of another mesh is wrong until its entry is put on the bone that is there; turning or
// widening it is not enough, and undo makes it wrong again.
TEST(PlanModel, Hazard21PlanOfAnotherMeshIsWrongUntilItsEntryIsPlacedAnew) {
  using Outcome = cases::PlanFit::Outcome;
  cases::Case knee = phantom();
  knee.plan.mesh_sha256[BoneKind::Femur] = std::string(64, '0');
  PlanModel model(knee);
  EXPECT_EQ(model.plan_fit(BoneKind::Femur).outcome, Outcome::OtherMesh);
  EXPECT_EQ(model.checks(BoneKind::Femur).front().verdict, tunnels::PlanCheck::Verdict::Wrong);
  EXPECT_EQ(model.plan_fit(BoneKind::Tibia).outcome, Outcome::Fits) << "one that names none is of this mesh";
  const cases::Plan before = model.knee().plan;
  tunnels::Tunnel tunnel = *model.tunnel(BoneKind::Femur);
  tunnel.diameter_mm += 0.5;
  model.set_tunnel(BoneKind::Femur, tunnel);
  EXPECT_FALSE(model.plan_fit(BoneKind::Femur).is_valid());
  tunnel.entry_mm.x() += 0.5;
  model.set_tunnel(BoneKind::Femur, tunnel);
  EXPECT_EQ(model.plan_fit(BoneKind::Femur).outcome, Outcome::Fits);
  model.set_plan(before);
  EXPECT_FALSE(model.plan_fit(BoneKind::Femur).is_valid());
}

}  // namespace
}  // namespace arthronaut::open_case
