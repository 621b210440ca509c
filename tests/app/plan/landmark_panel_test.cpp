#include "app/plan/landmark_panel.h"

#include <gtest/gtest.h>

namespace arthronaut::plan {
namespace {

// When all that are there are confirmed, that is what is read; one that nobody can mark is no work left.
TEST(LandmarkPanel, CountsWhatCanBeConfirmed) {
  using State = LandmarkRow::State;
  std::vector<LandmarkRow> rows(4);
  EXPECT_EQ(confirmed_in_words(rows), "0 of 0 confirmed, 4 not there");
  rows[0].state = rows[1].state = State::Confirmed;
  rows[2].state = State::Proposed;
  EXPECT_EQ(confirmed_in_words(rows), "2 of 3 confirmed, 1 not there");
  rows[2].state = rows[3].state = State::Confirmed;
  EXPECT_EQ(confirmed_in_words(rows), "4 of 4 confirmed");
}

// Those that a click on the surface would put in the wrong place; every other one lies on it.
TEST(LandmarkPanel, TellsWhatLiesWithinTheBone) {
  for (const char* name :
       {"lateral_condyle_center", "medial_condyle_center", "shaft_distal", "shaft_proximal"})
    EXPECT_TRUE(lies_within_bone(name)) << name;
  for (const char* name : {"lateral_condyle_posterior", "notch_apex", "tuberosity", "native_footprint"})
    EXPECT_FALSE(lies_within_bone(name)) << name;
}

}  // namespace
}  // namespace arthronaut::plan
