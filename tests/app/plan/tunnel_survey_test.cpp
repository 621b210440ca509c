#include "app/plan/tunnel_survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;
using Verdict = tunnels::PlanCheck::Verdict;

class TunnelSurveyed : public ::testing::Test {
 protected:
  // Until it is there; a minute is a hundred times what it takes.
  [[nodiscard]] std::shared_ptr<const Survey> waited_for(TunnelSurvey& survey, BoneKind bone) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < until) {
      if (auto found = survey.of(model_, bone)) return found;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return nullptr;
  }

  open_case::PlanModel model_{phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test")};
};

// What the map says of the place where the tunnel begins is what the list of checks says of the tunnel.
TEST_F(TunnelSurveyed, TheMapSaysOfTheEntryWhatTheChecksSay) {
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) {
    const auto request = survey_request(model_, bone);
    ASSERT_TRUE(request);
    const Survey found = survey(*request);
    ASSERT_GT(found.entries.size(), 50U);
    const auto& at_entry = *std::ranges::min_element(found.entries, {}, [&](const auto& sample) {
      return (sample.entry_mm - request->tunnel.entry_mm).norm();
    });
    ASSERT_LT((at_entry.entry_mm - request->tunnel.entry_mm).norm(), 0.2);
    Verdict worst = Verdict::Fine;
    for (const tunnels::PlanCheck& check : model_.checks(bone)) {
      if (check.verdict == Verdict::Wrong) worst = Verdict::Wrong;
      if (check.verdict == Verdict::Look && worst == Verdict::Fine) worst = Verdict::Look;
    }
    EXPECT_EQ(at_entry.verdict, worst) << at_entry.reason;
    EXPECT_EQ(found.portal.empty(), bone == BoneKind::Tibia);
  }
}

// What nobody can check no dot says: the legend does not call it passed.
TEST(EntryMapWords, NameWhatIsNotChecked) {
  Survey found;
  found.entries = {{.verdict = Verdict::Fine}, {.verdict = Verdict::Fine}, {.verdict = Verdict::Wrong}};
  const tunnels::PlanCheck fine{.verdict = Verdict::Fine, .name = "Length", .text = ""},
      unmade{.verdict = Verdict::NotChecked, .name = "High to low", .text = ""};
  EXPECT_EQ(map_in_words(found, {fine}),
            "Entries of a tunnel of this direction: dot, every check passed (2); ring, to be looked at (0); "
            "cross, wrong (1)");
  EXPECT_EQ(
      map_in_words(found, {fine, unmade}),
      "Entries of a tunnel of this direction: dot, every check that can be made passed (2); ring, to be "
      "looked at (0); cross, wrong (1). Not checked at any: High to low");
}

// An edit ends what was shown, at once; the next survey is of the edited tunnel.
TEST_F(TunnelSurveyed, IsTrueOfOnePlanAlone) {
  TunnelSurvey survey({});
  const auto before = waited_for(survey, BoneKind::Femur);
  ASSERT_NE(before, nullptr);
  tunnels::Tunnel wider = *model_.tunnel(BoneKind::Femur);
  wider.diameter_mm += 4;
  model_.set_tunnel(BoneKind::Femur, wider);
  EXPECT_EQ(survey.of(model_, BoneKind::Femur), nullptr);
  const auto after = waited_for(survey, BoneKind::Femur);
  ASSERT_NE(after, nullptr);
  EXPECT_EQ(after->revision, model_.revision());
  const auto passes = [](const Survey& s) {
    return std::ranges::count(s.entries, Verdict::Fine, &tunnels::EntrySample::verdict);
  };
  EXPECT_LT(passes(*after), passes(*before));
}

// Its lines go from the entry to where the drill comes from.
TEST_F(TunnelSurveyed, DrawsOnlyWaysThatAreClear) {
  const auto request = survey_request(model_, BoneKind::Femur);
  ASSERT_TRUE(request);
  const Survey found = survey(*request);
  scene::SceneContent content;
  add_aims(content, found, request->tunnel, 35);
  const auto clear = std::ranges::count(found.portal, true, &tunnels::PortalAim::is_clear);
  ASSERT_GT(clear, 0);
  EXPECT_EQ(content.lines.size(), static_cast<std::size_t>(clear) + found.outside_in.size());
  EXPECT_TRUE(content.rods.empty());
}

// The map stands while the ways to drill are still looked for, and how far all of it is never goes back.
TEST_F(TunnelSurveyed, ShowsTheMapBeforeTheAims) {
  const auto request = survey_request(model_, BoneKind::Femur);
  ASSERT_TRUE(request);
  std::optional<Survey> map;
  double done = 0, done_at_map = 0;
  const Survey found = survey(
      *request, {},
      [&](double now) {
        EXPECT_GE(now, done);
        EXPECT_LE(now, 1);
        done = now;
      },
      [&](const Survey& made) {
        map = made;
        done_at_map = done;
      });
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->has_aims);
  EXPECT_TRUE(map->outside_in.empty());
  EXPECT_EQ(map->entries.size(), found.entries.size());
  EXPECT_TRUE(found.has_aims);
  EXPECT_GT(done_at_map, 0.1);
  EXPECT_LT(done_at_map, 0.7);
  EXPECT_GT(done, 0.7);
}

TEST_F(TunnelSurveyed, NothingIsAskedWithoutATunnel) {
  model_.set_tunnel(BoneKind::Femur, std::nullopt);
  EXPECT_FALSE(survey_request(model_, BoneKind::Femur));
  TunnelSurvey survey({});
  EXPECT_EQ(survey.of(model_, BoneKind::Femur), nullptr);
}

}  // namespace
}  // namespace arthronaut::plan
