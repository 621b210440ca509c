#include "app/navigate/finish_words.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

using bones::BoneKind;

FinishedBone bone_of(BoneKind bone, bool is_drilled, bool marker_is_out,
                     const std::optional<operation::AchievedTunnel>& measured = {}) {
  return {bone, {{bone, is_drilled, measured, false}}, marker_is_out};
}

// Femur first, then tibia, each drilled and its marker out: only then nothing is left to do.
TEST(FinishWords, LeadThroughBothBones) {
  std::vector<FinishedBone> bones{bone_of(BoneKind::Femur, true, false),
                                  bone_of(BoneKind::Tibia, false, false)};
  EXPECT_EQ(finish_action(bones, BoneKind::Femur, true), FinishAction::TakeMarkerOut);
  EXPECT_FALSE(finish_list(bones).is_done);
  bones[0].marker_is_out = true;
  EXPECT_EQ(finish_action(bones, BoneKind::Femur, true), FinishAction::OtherBone);
  bones[1].tunnels.front().is_drilled = true;
  EXPECT_EQ(finish_action(bones, BoneKind::Tibia, true), FinishAction::TakeMarkerOut);
  EXPECT_FALSE(finish_list(bones).is_done) << "a marker is in a bone";
  bones[1].marker_is_out = true;
  EXPECT_EQ(finish_action(bones, BoneKind::Tibia, true), FinishAction::EndSource);
  EXPECT_EQ(finish_action(bones, BoneKind::Tibia, false), FinishAction::Nothing);
  EXPECT_TRUE(finish_list(bones).is_done);
}

// A case with one planned bone ends with that one; one without any is never done.
TEST(FinishWords, EndWithTheBonesThatArePlanned) {
  EXPECT_EQ(finish_action({bone_of(BoneKind::Tibia, true, true)}, BoneKind::Tibia, false),
            FinishAction::Nothing);
  EXPECT_TRUE(finish_list({bone_of(BoneKind::Tibia, true, true)}).is_done);
  EXPECT_FALSE(finish_list({}).is_done);
}

// Of a bone that was not begun nobody knows where its marker is.
TEST(FinishWords, SayOfNoMarkerThatItIsInABoneThatWasNotBegun) {
  FinishedBone tibia = bone_of(BoneKind::Tibia, false, false);
  const auto text = [&] { return finish_list({tibia}).lines.back().text; };
  EXPECT_EQ(text(), "not said to be out");
  tibia.has_begun = true;
  EXPECT_EQ(text(), "is still in the bone");
  tibia.marker_is_out = true;
  EXPECT_EQ(text(), "out");
}

// What was measured of a tunnel and what was only said of it are told apart.
TEST(FinishWords, SayWhetherATunnelWasMeasured) {
  operation::AchievedTunnel tunnel;
  const auto text = [](const FinishedBone& bone) { return finish_list({bone}).lines.front().text; };
  EXPECT_EQ(text(bone_of(BoneKind::Femur, true, false)), "drilled, by the surgeon's word");
  EXPECT_EQ(text(bone_of(BoneKind::Femur, true, false, tunnel)), "drilled and recorded; depth not read");
  tunnel.depth_mm = 24.5;
  EXPECT_EQ(text(bone_of(BoneKind::Femur, true, false, tunnel)), "drilled, 24.5 mm deep");
  EXPECT_EQ(text(bone_of(BoneKind::Femur, false, false)), "not drilled yet");
  EXPECT_EQ(finish_list({bone_of(BoneKind::Femur, true, false)}).lines.back().severity,
            widgets::Severity::Caution);
}

// Of two in one bone each is told of by itself: what was measured of one says nothing of the other.
TEST(FinishWords, TellOfEachOfTwoTunnels) {
  operation::AchievedTunnel measured;
  measured.depth_mm = 24.5;
  FinishedBone femur{BoneKind::Femur,
                     {{{BoneKind::Femur, norms::Bundle::Anteromedial}, true, measured, true},
                      {{BoneKind::Femur, norms::Bundle::Posterolateral}, true, {}, false}},
                     true};
  const FinishList list = finish_list({femur});
  ASSERT_EQ(list.lines.size(), 4U);  // and one for the registration, one for the marker
  EXPECT_EQ(list.lines[0].name, "Femur AM tunnel");
  EXPECT_EQ(list.lines[0].text, "drilled, 24.5 mm deep");
  EXPECT_EQ(list.lines[1].name, "Femur PL tunnel");
  EXPECT_EQ(list.lines[1].text, "drilled, by the surgeon's word");
  EXPECT_TRUE(list.is_done);
  femur.tunnels.back().is_drilled = false;
  EXPECT_FALSE(finish_list({femur}).is_done);
  EXPECT_FALSE(femur.is_drilled());
}

// What guided without a touch that verified it is no green end: the list says so, and so does the last word.
TEST(FinishWords, SayThatNothingWasVerified) {
  FinishedBone femur = bone_of(BoneKind::Femur, true, true, operation::AchievedTunnel());
  const auto line = [&] {
    for (const CardLine& one : finish_list({femur}).lines)
      if (one.name == "Femur registration") return one;
    return CardLine();
  };
  const auto last_word = [&] { return words_of(FinishAction::Nothing, {femur}, BoneKind::Femur); };
  EXPECT_EQ(line().text, "NOT verified by touches");
  EXPECT_EQ(line().severity, widgets::Severity::Caution);
  EXPECT_EQ(last_word(), "done, not verified: the report is in Review (F3)");
  femur.tunnels.front().was_verified = true;
  EXPECT_EQ(line().text, "verified by touches");
  EXPECT_EQ(line().severity, widgets::Severity::Good);
  EXPECT_EQ(last_word(), "done: the report is in Review (F3)");
  femur.tunnels.front() = {BoneKind::Femur, true, {}, false};  // by word alone
  EXPECT_EQ(line().text, "NOT verified by touches");
  EXPECT_EQ(last_word(), "done, not verified: the report is in Review (F3)");
  femur.tunnels.front().is_drilled = false;
  EXPECT_EQ(line().name, "") << "nothing was drilled by any registration";
}

}  // namespace
}  // namespace arthronaut::navigate
