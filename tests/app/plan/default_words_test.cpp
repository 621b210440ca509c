#include "app/plan/default_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arthronaut::plan {
namespace {

using bones::BoneKind;
using testing::HasSubstr;
using testing::Not;

MadeTunnel made(const tunnels::TunnelKey& key, const std::string& place) {
  MadeTunnel one{.key = key};
  one.made.outcome = default_plan::DefaultTunnel::Outcome::Planned;
  one.made.place = place;
  return one;
}

// Each tunnel says where its entry is; what its own checks call wrong is not left to be found in a list.
TEST(DefaultWords, SayWhereEachTunnelIsAndWhatIsWrongThere) {
  using Verdict = tunnels::PlanCheck::Verdict;
  std::vector<MadeTunnel> both{made({BoneKind::Femur, norms::Bundle::Anteromedial}, "at the norm's place"),
                               made({BoneKind::Femur, norms::Bundle::Posterolateral}, "1.1 mm off it")};
  both[0].checks = {{.verdict = Verdict::Look, .name = "Length", .text = "28.0 mm"},
                    {.verdict = Verdict::Wrong, .name = "Wall", .text = "0.4 mm: may break out"}};
  both[0].made.failed = both[0].checks;
  EXPECT_EQ(
      default_in_words(both, false),
      "Default femur AM: at the norm's place. Wrong there: Wall: 0.4 mm: may break out. No aim from there "
      "passes it: Length: 28.0 mm.\n"
      "Default femur PL: 1.1 mm off it.");
}

TEST(DefaultWords, NameTheKeyThatEntersWhereItPasses) {
  std::vector<MadeTunnel> one{made(BoneKind::Tibia, "at the norm's place; 1.3 mm from it one passes")};
  EXPECT_THAT(default_in_words(one, false), Not(HasSubstr("Shift+N")));
  one[0].made.other_entry = default_plan::OtherEntry{};
  EXPECT_THAT(default_in_words(one, false), HasSubstr("one passes. Shift+N enters there instead."));
}

// Moved there it keeps the aim: nobody tried others from there.
TEST(DefaultWords, SayWhatIsToBeLookedAtWhereItWasMovedTo) {
  std::vector<MadeTunnel> one{made(BoneKind::Tibia, "1.4 mm off the norm's place")};
  one[0].made.off_norm_mm = 1.4;
  one[0].made.failed = {{.verdict = tunnels::PlanCheck::Verdict::Look, .name = "Wall", .text = "0.5 mm"}};
  EXPECT_EQ(default_in_words(one, false),
            "Default tibia: 1.4 mm off the norm's place. To be looked at: Wall: 0.5 mm.");
}

TEST(DefaultWords, SayWhatTheyRestOnAndHowToHaveThePlanBack) {
  std::vector<MadeTunnel> one{made(BoneKind::Tibia, "at the norm's place")};
  EXPECT_THAT(default_in_words(one, false), Not(HasSubstr("Ctrl+Z")));
  EXPECT_THAT(default_in_words(one, true), HasSubstr("Ctrl+Z brings back the plan that was there."));
  EXPECT_THAT(default_in_words(one, true), Not(HasSubstr("landmarks")));
  one[0].made.doubts = {"nobody has confirmed them"};
  EXPECT_THAT(default_in_words(one, false), HasSubstr("look at them (L)"));
}

TEST(DefaultWords, SayWhyThereIsNone) {
  MadeTunnel none{.key = BoneKind::Femur};
  none.made.message = "no bone is there";
  none.made.doubts = {"nobody has confirmed them"};
  EXPECT_EQ(default_in_words({none}, false), "No default for the femur: no bone is there.");
  none.made.message = "no joint's end is seen; is it cut off?";
  EXPECT_EQ(default_in_words({none}, false),
            "No default for the femur: no joint's end is seen; is it cut off?");
}

// A message may be a question: "...is it cut off through the joint's end?" is ended by its own mark.
TEST(DefaultWords, ASentenceEndsOnce) {
  EXPECT_EQ(ended("the condyles are not marked"), "the condyles are not marked.");
  EXPECT_EQ(ended("is it cut off through the joint's end?"), "is it cut off through the joint's end?");
  EXPECT_EQ(ended("It is."), "It is.");
}

}  // namespace
}  // namespace arthronaut::plan
