#include "navigation/operation/command.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "planning/geometry/error.h"

namespace arthronaut::operation {
namespace {

GiveRegistration given() {
  GiveRegistration give;
  give.registration.has_pose = give.registration.reliable = true;
  give.registration.reasons.clear();
  give.registration.assumptions = {"the cartilage lies 2.1 mm thick"};
  give.registration.marker_from_bone = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(3, 2, 1).normalized())), {1.0 / 3, -2, 3e-7}};
  give.registration.covariance = geometry::Matrix6d::Identity() / 7;
  give.registration.predicted_tre_mm = 1.0 / 3;
  give.of = {"ab12", bones::BoneKind::Tibia, 1, 2, "camera", "tools", 1.3345, sources::SourceKind::Recording};
  give.is_resumed = true;
  return give;
}

PlannedTunnel plan() {
  PlannedTunnel plan;
  plan.tunnel.bone = bones::BoneKind::Tibia;
  plan.tunnel.entry_mm = {1.0 / 3, -1e-300, 1e17 + 2};
  plan.tunnel.direction = Eigen::Vector3d(1, 2, 3).normalized();
  plan.tunnel.diameter_mm = 0.1 + 0.2;
  plan.length_mm = 29.999999999999996;
  return plan;
}

ResumeOperation resume() {
  ResumeOperation resume;
  resume.session = "0007-20260131-120000";
  resume.of = given().of;
  resume.of.placement = 0;
  resume.plan = plan();
  resume.depth_stop_mm = 2.0 / 3;
  resume.registration = given().registration;
  resume.registration_of = given().of;
  resume.drawn = {{3, std::nullopt, {1.0 / 3, -2, 5e-9}}, {4, std::nullopt, {0.1, 0.2, 0.3}}};
  resume.stroke_count = 2;
  resume.touches_mm = {{1.0 / 7, 2, 3}, {4, 5, 6}};
  resume.control_point_mm = Eigen::Vector3d(7, 8, 1.0 / 9);
  return resume;
}

const std::vector<Command>& all_commands() {
  static const std::vector<Command> commands{Draw{true},
                                             Draw{false},
                                             TakeTouch{},
                                             TouchControlPoint{},
                                             ForgetTouches{},
                                             TakeBackStroke{},
                                             ExcludeStroke{12, true},
                                             ExcludeStroke{0, false},
                                             ClearStrokes{},
                                             RegisterStrokes{},
                                             ChooseRegistration{3},
                                             OfferPlan{plan()},
                                             OfferPlan{},
                                             TakePlanOver{},
                                             TakePlanOver{false},
                                             SkipVerification{},
                                             MarkerPlacedAnew{},
                                             ReadDepthStop{1.0 / 3},
                                             TunnelDrilled{},
                                             TunnelDrilled{29.25},
                                             TakeBackDrilled{},
                                             MarkerOut{},
                                             MarkerOut{14.5},
                                             given(),
                                             ConfirmTimeOut{true},
                                             ConfirmTimeOut{true, "no picture"},
                                             CheckGuide{},
                                             TrustGuide{},
                                             ConfirmTimeOut{false},
                                             resume(),
                                             ResumeOperation{}};
  return commands;
}

// Every command there is comes back the same; its text says all of it, so equal texts are equal commands.
TEST(Command, EveryOneComesBackFromItsText) {
  std::set<std::size_t> kinds;
  std::set<std::string> texts;
  for (const Command& command : all_commands()) {
    kinds.insert(command.index());
    const std::string text = to_text(command);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_TRUE(texts.insert(text).second) << text;
    const Command back = command_from_text(text, "journal");
    EXPECT_EQ(back.index(), command.index()) << text;
    EXPECT_EQ(to_text(back), text);
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<Command>);
}

TEST(Command, NumbersComeBackToTheLastBit) {
  const auto offer = std::get<OfferPlan>(command_from_text(to_text(OfferPlan{plan()}), "journal"));
  EXPECT_EQ(offer.plan->tunnel.bone, plan().tunnel.bone);
  EXPECT_EQ(offer.plan->tunnel.entry_mm, plan().tunnel.entry_mm);
  EXPECT_EQ(offer.plan->tunnel.direction, plan().tunnel.direction);
  EXPECT_EQ(offer.plan->tunnel.diameter_mm, plan().tunnel.diameter_mm);
  EXPECT_EQ(offer.plan->length_mm, plan().length_mm);
  const auto stop = std::get<ReadDepthStop>(command_from_text(to_text(ReadDepthStop{1.0 / 3}), "journal"));
  EXPECT_EQ(stop.depth_mm, 1.0 / 3);
  const GiveRegistration expected = given();
  const auto give = std::get<GiveRegistration>(command_from_text(to_text(expected), "journal"));
  EXPECT_TRUE(give.is_resumed);
  EXPECT_EQ(give.registration.marker_from_bone.translation_mm,
            expected.registration.marker_from_bone.translation_mm);
  EXPECT_EQ(give.registration.marker_from_bone.rotation.coeffs(),
            expected.registration.marker_from_bone.rotation.coeffs());
  EXPECT_EQ(give.registration.covariance, expected.registration.covariance);
  EXPECT_EQ(give.registration.predicted_tre_mm, expected.registration.predicted_tre_mm);
  EXPECT_EQ(give.of.placement, 2);
  const auto back = std::get<ResumeOperation>(command_from_text(to_text(resume()), "journal"));
  ASSERT_EQ(back.drawn.size(), 2U);
  EXPECT_EQ(back.drawn[0].curve, 3);
  EXPECT_EQ(back.drawn[0].position_mm, resume().drawn[0].position_mm);
  EXPECT_EQ(back.touches_mm, resume().touches_mm);
  EXPECT_EQ(*back.control_point_mm, *resume().control_point_mm);
  EXPECT_EQ(back.plan, resume().plan);
  EXPECT_EQ(back.depth_stop_mm, resume().depth_stop_mm);
  EXPECT_EQ(back.registration->marker_from_bone.translation_mm,
            expected.registration.marker_from_bone.translation_mm);
  EXPECT_EQ(back.registration_of.placement, 2);
  EXPECT_FALSE(registration::mismatch_of(back.of, resume().of));
  EXPECT_FALSE(registration::mismatch_of(give.of, expected.of));
}

// What a plan does to the registration is said in the journal: an older one, which says nothing of it, is run
// again as it ran.
TEST(Command, APlanOfAnOlderJournalMovesNoTarget) {
  for (const Command& command : {Command(OfferPlan{plan()}), Command(resume())}) {
    std::string text = to_text(command);
    const std::string word = ",\"moves_target\":true";
    ASSERT_NE(text.find(word), std::string::npos) << text;
    const auto moves = [](const Command& read) {
      const auto* offer = std::get_if<OfferPlan>(&read);
      return offer != nullptr ? offer->moves_target : std::get<ResumeOperation>(read).moves_target;
    };
    EXPECT_TRUE(moves(command_from_text(text, "journal")));
    text.erase(text.find(word), word.size());
    EXPECT_FALSE(moves(command_from_text(text, "journal")));
    EXPECT_EQ(to_text(command_from_text(text, "journal")), text);
  }
}

// Whatever a journal holds, it is read as a command or refused as InvalidInput that names it: text that was
// cut off, and text with bytes changed.
TEST(Command, BrokenTextIsRefusedAndNothingElse) {
  std::mt19937 random(5);
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  long refused = 0;
  const auto read = [&](const std::string& text) {
    try {
      (void)to_text(command_from_text(text, "journal 7"));
    } catch (const InvalidInput& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("journal 7"), std::string::npos) << error.what();
    }
  };
  for (const Command& command : all_commands()) {
    const std::string text = to_text(command);
    for (std::size_t length = 0; length < text.size(); length += 1 + text.size() / 60)
      read(text.substr(0, length));
    for (int i = 0; i < 60; ++i) {
      std::string changed = text;
      for (std::size_t n = 1 + below(3); n > 0; --n)
        changed[below(changed.size())] = static_cast<char>(below(256));
      read(changed);
    }
  }
  EXPECT_GT(refused, 800);
  for (const char* bad :
       {"", "null", "[]", "{}", R"({"format":"arthronaut.command","version":1})",
        R"({"format":"arthronaut.command","version":1,"command":"explode"})",
        R"({"format":"arthronaut.command","version":1,"command":"draw","on":"yes"})",
        R"({"format":"arthronaut.command","version":1,"command":"resume operation","session":"x"})",
        R"({"format":"arthronaut.command","version":1,"command":"choose registration","entry":-1})"})
    EXPECT_THROW((void)command_from_text(bad, "journal"), InvalidInput) << bad;
}

}  // namespace
}  // namespace arthronaut::operation
