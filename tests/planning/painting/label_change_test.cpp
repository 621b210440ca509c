#include "planning/painting/label_change.h"

#include <gtest/gtest.h>

#include <random>

namespace arthronaut::painting {
namespace {

TEST(LabelChange, LeadsBothWaysBetweenAnyTwoLabelMaps) {
  std::mt19937 random(1);
  Labels before(5000), after;
  for (auto& label : before) label = static_cast<std::uint8_t>(random() % 4);
  after = before;
  for (int i = 0; i < 800; ++i) after[random() % after.size()] = static_cast<std::uint8_t>(random() % 4);
  after.front() = 3;
  before.back() = 1;
  after.back() = 2;
  const LabelChange change = change_between(before, after);
  Labels there = before;
  change.redo(there);
  EXPECT_EQ(there, after);
  change.undo(there);
  EXPECT_EQ(there, before);
  EXPECT_TRUE(change_between(before, before).is_empty());
}

// A block of 1000 voxels is one run, whatever the size of the map.
TEST(LabelChange, IsSmallForWhatLiesTogether) {
  Labels before(100000, kNothing), after = before;
  std::fill_n(after.begin() + 500, 1000, kFemur);
  const LabelChange change = change_between(before, after);
  ASSERT_EQ(change.runs().size(), 1U);
  EXPECT_EQ(change.runs()[0].first, 500U);
  EXPECT_EQ(change.runs()[0].count, 1000U);
}

// The same voxel twice: back in the other order.
TEST(LabelChange, GoesBackInTheOrderOfWhatHappened) {
  LabelChange change;
  Labels labels{0, 0, 0};
  const auto put = [&](std::size_t v, std::uint8_t label) {
    change.note(v, labels[v], label);
    labels[v] = label;
  };
  put(1, kFemur);
  put(2, kFemur);
  put(1, kTibia);
  change.undo(labels);
  EXPECT_EQ(labels, Labels({0, 0, 0}));
  change.redo(labels);
  EXPECT_EQ(labels, Labels({0, kTibia, kFemur}));
}

}  // namespace
}  // namespace arthronaut::painting
