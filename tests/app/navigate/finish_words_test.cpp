#include "app/navigate/finish_words.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

using bones::BoneKind;

// Femur first, then tibia, each drilled and its marker out: only then nothing is left to do.
TEST(FinishWords, LeadThroughBothBones) {
  std::vector<FinishedBone> bones{{BoneKind::Femur, true, false, {}}, {BoneKind::Tibia, false, false, {}}};
  EXPECT_EQ(finish_action(bones, BoneKind::Femur, true), FinishAction::TakeMarkerOut);
  EXPECT_FALSE(finish_list(bones).is_done);
  bones[0].marker_is_out = true;
  EXPECT_EQ(finish_action(bones, BoneKind::Femur, true), FinishAction::OtherBone);
  bones[1].is_drilled = true;
  EXPECT_EQ(finish_action(bones, BoneKind::Tibia, true), FinishAction::TakeMarkerOut);
  EXPECT_FALSE(finish_list(bones).is_done) << "a marker is in a bone";
  bones[1].marker_is_out = true;
  EXPECT_EQ(finish_action(bones, BoneKind::Tibia, true), FinishAction::EndSource);
  EXPECT_EQ(finish_action(bones, BoneKind::Tibia, false), FinishAction::Nothing);
  EXPECT_TRUE(finish_list(bones).is_done);
}

// A case with one planned bone ends with that one; one without any is never done.
TEST(FinishWords, EndWithTheBonesThatArePlanned) {
  EXPECT_EQ(finish_action({{BoneKind::Tibia, true, true, {}}}, BoneKind::Tibia, false),
            FinishAction::Nothing);
  EXPECT_TRUE(finish_list({{BoneKind::Tibia, true, true, {}}}).is_done);
  EXPECT_FALSE(finish_list({}).is_done);
}

// What was measured of a tunnel and what was only said of it are told apart.
TEST(FinishWords, SayWhetherATunnelWasMeasured) {
  operation::AchievedTunnel tunnel;
  const auto text = [](const FinishedBone& bone) { return finish_list({bone}).lines.front().text; };
  EXPECT_EQ(text({BoneKind::Femur, true, false, {}}), "drilled, by the surgeon's word");
  EXPECT_EQ(text({BoneKind::Femur, true, false, tunnel}), "drilled and recorded; depth not read");
  tunnel.depth_mm = 24.5;
  EXPECT_EQ(text({BoneKind::Femur, true, false, tunnel}), "drilled, 24.5 mm deep");
  EXPECT_EQ(text({BoneKind::Femur, false, false, {}}), "not drilled yet");
  EXPECT_EQ(finish_list({{BoneKind::Femur, true, false, {}}}).lines.back().severity,
            widgets::Severity::Caution);
}

}  // namespace
}  // namespace arthronaut::navigate
