// A frame costs the same after an hour of drawing. Counted in allocations, in a program of its own, since it
// replaces operator new: a copy of what was drawn shows as bytes and blocks, whatever the machine's speed.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/counted_allocations.h"
#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

// An hour at 60 Hz on the same patch of bone, the screen's snapshot taken after each frame, as the window
// does. A minute at the end allocates no more than one at the beginning, and the snapshot that the screen
// gets is of bounded size. Growing buffers double now and then: that is a handful of blocks.
TEST(FrameCost, AnHourOfDrawingIsFlat) {
  constexpr int kMinute = 3600, kMinutes = 60;
  Operation operation(test::phantom_setup());
  operation.start_source(test::scripted_source());
  operation.apply(ConfirmTimeOut{});  // no stroke is taken before
  pipeline::FrameResult frame;
  frame.camera_from_world.is_valid = frame.tip_is_valid = true;
  std::vector<long> allocations;
  for (int minute = 0; minute < kMinutes; ++minute) {
    test::start_counting_allocations();
    for (int i = 0; i < kMinute; ++i) {
      const double at = static_cast<double>(++frame.frame_index) / 60;
      frame.timestamp_ns = static_cast<std::int64_t>(at * 1e9);
      frame.tip_in_world_mm = {8 * std::sin(at), 8 * std::cos(1.3 * at), std::sin(0.2 * at)};
      operation.process_recorded(frame);
      const OperationStatePtr state = operation.state();
      ASSERT_LE(state->registration->drawn->size(), StrokeBook::kMostTraced);
      (void)operation.take_requests();
      (void)operation.take_journal();
    }
    allocations.push_back(test::stop_counting_allocations());
  }
  EXPECT_EQ(operation.points().size(), static_cast<std::size_t>(kMinute * kMinutes));
  EXPECT_GT(allocations.front(), 0);
  // The first minutes also find new cells of the trace: later ones must do less.
  EXPECT_LE(allocations.back(), allocations.front());
  EXPECT_LE(allocations.back(), allocations[kMinutes / 2] + kMinute / 100);
}

}  // namespace
}  // namespace arthronaut::operation
