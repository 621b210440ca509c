#include "planning/painting/painting.h"

#include <gtest/gtest.h>

#include <random>

#include "planning/geometry/error.h"
#include "tests/planning/painting/shapes.h"

namespace arthronaut::painting {
namespace {

using Eigen::Vector3d;

class PaintingTest : public ::testing::Test {
 protected:
  static BrushMove move(const Vector3d& from, const Vector3d& to) {
    return {from, to, Vector3d::UnitZ(), {3, false}};
  }
  Painting painting_{std::make_shared<const images::Volume>(test::empty_volume({40, 40, 20}, {1, 1, 1}))};
};

// Moves of one drag are one step; a move that changes nothing none.
TEST_F(PaintingTest, ADragIsOneStep) {
  EXPECT_FALSE(painting_.holds(Layer::Strokes));
  painting_.paint(Layer::Strokes, move({10, 10, 5}, {10, 10, 5}), kFemur, "Paint the femur", false);
  const Labels first = painting_.labels(Layer::Strokes);
  painting_.paint(Layer::Strokes, move({10, 10, 5}, {20, 10, 5}), kFemur, "Paint the femur", true);
  painting_.paint(Layer::Strokes, move({20, 10, 5}, {20, 10, 5}), kFemur, "Paint the femur", true);
  EXPECT_EQ(painting_.step_count(), 1U);
  painting_.paint(Layer::Strokes, move({20, 20, 5}, {20, 20, 5}), kTibia, "Paint the tibia", false);
  EXPECT_EQ(painting_.step_count(), 2U);
  EXPECT_TRUE(painting_.holds(Layer::Strokes, kTibia));
  EXPECT_FALSE(painting_.holds(Layer::Bones));
  painting_.undo();
  EXPECT_FALSE(painting_.holds(Layer::Strokes, kTibia));
  painting_.undo();
  EXPECT_FALSE(painting_.holds(Layer::Strokes));
  EXPECT_FALSE(painting_.can_undo());
  painting_.redo();
  EXPECT_GT(
      std::count(painting_.labels(Layer::Strokes).begin(), painting_.labels(Layer::Strokes).end(), kFemur),
      std::count(first.begin(), first.end(), kFemur));
  EXPECT_EQ(painting_.step_name(0), "Paint the femur");
}

// A move with the same place anew after another step does not join the step before that.
TEST_F(PaintingTest, WhatWasUndoneGoesWithTheNextStep) {
  painting_.paint(Layer::Bones, move({10, 10, 5}, {10, 10, 5}), kFemur, "one", false);
  painting_.undo();
  painting_.paint(Layer::Bones, move({30, 30, 5}, {30, 30, 5}), kFemur, "two", true);
  ASSERT_EQ(painting_.step_count(), 1U);
  EXPECT_EQ(painting_.step_name(0), "two");
  EXPECT_FALSE(painting_.can_redo());
}

// Any row of edits, to any place and back.
TEST_F(PaintingTest, EveryStepIsFoundAgain) {
  std::mt19937 random(3);
  const auto anywhere = [&] {
    return Vector3d(static_cast<double>(random() % 40), static_cast<double>(random() % 40),
                    static_cast<double>(random() % 20));
  };
  std::vector<std::pair<Labels, Labels>> states;
  const auto note = [&] {
    states.emplace_back(painting_.labels(Layer::Strokes), painting_.labels(Layer::Bones));
  };
  note();
  for (int i = 0; i < 30; ++i) {
    const std::size_t before = painting_.step_count();
    const Layer layer = random() % 2 ? Layer::Strokes : Layer::Bones;
    const auto label = static_cast<std::uint8_t>(random() % 3);
    if (random() % 5 == 0) {
      Labels labels = painting_.labels(layer);
      test::add_ball(labels, painting_.volume(), anywhere(), 6, label);
      painting_.put(layer, labels, "put");
    } else {
      painting_.paint(layer, move(anywhere(), anywhere()), label, "paint", false);
    }
    if (painting_.step_count() > before) note();
  }
  ASSERT_GT(states.size(), 20U);
  for (int i = 0; i < 60; ++i) {
    const std::size_t to = random() % states.size();
    painting_.go_to(to);
    ASSERT_EQ(painting_.position(), to);
    ASSERT_EQ(painting_.labels(Layer::Strokes), states[to].first);
    ASSERT_EQ(painting_.labels(Layer::Bones), states[to].second);
    const bool holds_femur = std::count(states[to].second.begin(), states[to].second.end(), kFemur) > 0;
    ASSERT_EQ(painting_.holds(Layer::Bones, kFemur), holds_femur);
  }
}

TEST_F(PaintingTest, LabelsOfAnotherSizeAreRefused) {
  EXPECT_THROW(painting_.put(Layer::Bones, Labels(7), "wrong"), InvalidInput);
  EXPECT_THROW(painting_.restore(Labels(7), Labels(7)), InvalidInput);
  EXPECT_EQ(painting_.step_count(), 0U);
}

}  // namespace
}  // namespace arthronaut::painting
