#include "navigation/recording/counting_registration.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace arthronaut::recording {
namespace {

SessionEvent event(std::string_view kind, const std::string& text = "") {
  return {0, std::string(kind), text};
}

CountingRegistration after(std::initializer_list<SessionEvent> events) {
  CountingRegistration registration;
  for (const SessionEvent& one : events) registration.follow(one);
  return registration;
}

const SessionEvent kFirst = event(kRegistrationEvent, "registration_1.json"),
                   kVerified = event(kVerifiedEvent),
                   kMarkerOut = event(kRegistrationEvent, "registration_2.json"),
                   kAm = event(kDrilledEvent, "achieved_am.json"),
                   kPl = event(kDrilledEvent, "achieved_pl.json"),
                   kNotAm = event(kDrilledTakenBackEvent, "achieved_am.json"),
                   kNotPl = event(kDrilledTakenBackEvent, "achieved_pl.json");

// Of two tunnels the word is taken back for one: the other one is drilled all the same, and what it was
// drilled by counts once the marker is out.
TEST(CountingRegistrationTest, TheWordThatIsTakenBackIsOfItsOwnTunnel) {
  for (const auto& registration : {after({kFirst, kVerified, kAm, kPl, kNotPl, kMarkerOut}),
                                   after({kFirst, kVerified, kAm, kPl, kNotAm, kMarkerOut})}) {
    EXPECT_TRUE(registration.is_of_before());
    EXPECT_EQ(registration.counts().file, "registration_1.json");
    EXPECT_TRUE(registration.counts().was_verified);
  }
  const auto none = after({kFirst, kVerified, kAm, kPl, kNotPl, kNotAm, kMarkerOut});
  EXPECT_FALSE(none.is_of_before());
  EXPECT_EQ(none.counts().file, "registration_2.json");
}

// Said again after it was taken back, a tunnel counts by what stood then.
TEST(CountingRegistrationTest, ATunnelThatIsDrilledAfterAllCountsByWhatStoodThen) {
  const auto registration = after({kFirst, kAm, kNotAm, kMarkerOut, kAm});
  EXPECT_FALSE(registration.is_of_before());
  EXPECT_EQ(registration.counts().file, "registration_2.json");
}

// That the marker is out is the end of what guided, and no verdict on it: also where the tunnel is drilled by
// word alone, or nothing was said of it.
TEST(CountingRegistrationTest, TheMarkerThatIsSaidToBeOutTakesNothingAway) {
  const SessionEvent says_out = event(kMarkerOutEvent);
  const SessionEvent by_word = event(kDrilledByWordEvent, "femur: nothing was seen");
  for (const auto& registration : {after({kFirst, kVerified, says_out, kMarkerOut}),
                                   after({kFirst, kVerified, by_word, says_out, kMarkerOut})}) {
    EXPECT_TRUE(registration.is_of_before());
    EXPECT_EQ(registration.counts().file, "registration_1.json");
    EXPECT_TRUE(registration.counts().was_verified);
  }
  // What is found after it counts; so does that a marker was placed anew, which nobody said was out.
  const SessionEvent found = event(kRegistrationEvent, "registration_3.json");
  EXPECT_EQ(after({kFirst, says_out, kMarkerOut, found}).counts().file, "registration_3.json");
  EXPECT_EQ(after({kFirst, says_out, event(kOutcomeEvent, "7"), found}).counts().file, "registration_3.json");
  EXPECT_EQ(after({kFirst, kMarkerOut}).counts().file, "registration_2.json");
}

}  // namespace
}  // namespace arthronaut::recording
