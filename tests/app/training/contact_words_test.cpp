#include "app/training/contact_words.h"

#include <gtest/gtest.h>

namespace arthronaut::training_mode {
namespace {

// A stroke in the air is a fault of the hand's: where no hand has moved the probe yet there is none.
TEST(ContactWords, BlameNobodyBeforeAHandHasMoved) {
  simulator::HandState hand;
  hand.held = simulator::Held::Probe;
  hand.off_bone_mm = 36.6;
  EXPECT_EQ(contact_words(hand, true, false).text, "37 mm off the bone");
  EXPECT_EQ(contact_words(hand, true, false).severity, widgets::Severity::Quiet);
  const ContactWords drawn = contact_words(hand, true, true);
  EXPECT_TRUE(drawn.is_air_drawn);
  EXPECT_EQ(drawn.text, "DRAWING IN THE AIR, 37 mm off the bone");
  EXPECT_EQ(drawn.severity, widgets::Severity::Bad);
  EXPECT_FALSE(contact_words(hand, false, true).is_air_drawn);
  hand.held = simulator::Held::Guide;
  EXPECT_FALSE(contact_words(hand, true, true).is_air_drawn) << "a guide draws nothing";
  hand.touches_bone = true;
  EXPECT_EQ(contact_words(hand, true, true).text, "On the bone");
}

}  // namespace
}  // namespace arthronaut::training_mode
