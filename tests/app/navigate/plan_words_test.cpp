#include "app/navigate/plan_words.h"

#include <gtest/gtest.h>

#include <set>

#include "planning/phantom/phantom_case.h"
#include "planning/plan_review/plan_review.h"

namespace arthronaut::navigate {
namespace {

TEST(PlanWords, SayWhatTheNumbersMean) {
  EXPECT_EQ(in_plain_words("Deep to shallow: 73.3 %: shallower than 33.5 %"), "entry shallower than usual");
  EXPECT_EQ(in_plain_words("Wall: 0.4 mm at 0.0 mm of depth: may break out, less than 1 mm"),
            "may break out of the bone");
  EXPECT_EQ(in_plain_words("Grid: landmarks proposed from the bone's shape, confirmed by nobody"),
            "landmarks not confirmed");
  EXPECT_EQ(in_plain_words("Exit: into the notch"), "exit: into the notch");
}

// What nobody has put into plain words is not left out, least of all a doubt about side and bone.
TEST(PlanWords, LeaveWhatTheyDoNotKnow) {
  for (const char* reason : {"Side: the bones look like a left knee", "Bone: the images end within it",
                             "what spoke against it cannot be read", "Something new: 3 mm: too far"})
    EXPECT_EQ(in_plain_words(reason), reason);
  const auto plain = in_plain_words(plan_review::TunnelVerdict{.wrong = {"Side: of the other knee"},
                                                               .look = {"Wall: 1.5 mm", "Bone: rough"}});
  EXPECT_EQ(plain.wrong, std::vector<std::string>{"Side: of the other knee"});
  EXPECT_EQ(plain.look, (std::vector<std::string>{"thin wall", "Bone: rough"}));
}

// Whatever fails of tunnels that are moved, turned and widened: no number, no name of a check, and short.
TEST(PlanWords, KnowEveryCheckThatFails) {
  const cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee");
  std::set<std::string> said;
  for (const double wide : {0.7, 1.0, 1.7})
    for (int turn = 0; turn < 6; ++turn) {
      cases::Case moved = knee;
      for (auto& [key, tunnel] : moved.plan.tunnels) {
        const Eigen::Vector3d by = 4.0 * turn * Eigen::Vector3d::Unit(turn % 3);
        tunnel.entry_mm += turn % 2 == 0 ? by : Eigen::Vector3d(-by);
        tunnel.direction =
            (tunnel.direction + 0.25 * turn * Eigen::Vector3d::Unit((turn + 1) % 3)).normalized();
        tunnel.diameter_mm *= wide;
      }
      const plan_review::CaseReview review(moved);
      for (const auto& [key, measured] : review.tunnels())
        for (const tunnels::PlanCheck& check : review.checks(key)) {
          if (!tunnels::is_failed(check)) continue;
          const std::string reason = check.name + ": " + check.text, plain = in_plain_words(reason);
          EXPECT_NE(plain, reason);
          EXPECT_LT(plain.size(), 80U) << plain;
          EXPECT_EQ(plain.find_first_of("0123456789%"), std::string::npos) << plain;
          said.insert(check.name);
        }
    }
  EXPECT_GE(said.size(), 10U);
}

}  // namespace
}  // namespace arthronaut::navigate
