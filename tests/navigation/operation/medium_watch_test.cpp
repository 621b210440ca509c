// Second looks at the medium: one at a time, of one source.
#include "navigation/operation/medium_watch.h"

#include <gtest/gtest.h>

#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut::operation {
namespace {

// Frames whose marker speaks for no medium, until a look is asked for.
class MediumWatchTest : public ::testing::Test {
 protected:
  void SetUp() override { medium_.on_source(options_); }
  // So many seconds of them.
  void show(double seconds) {
    for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
      pipeline::FrameResult frame;
      frame.frame_index = index_++;
      frame.timestamp_ns = frame.frame_index * 1'000'000'000 / 60;
      frame.intrinsics_are_known = true;
      for (const auto& declared : markers::declared_markers(options_.tools))
        frame.markers.push_back(test::lost(declared.id, markers::MarkerState::Covered));
      medium_.look(frame, options_);
    }
  }
  static MediumLook look_of(const MediumLookRequest& request) {
    MediumLook look;
    look.source_number = request.source_number;
    look.view = request.view;
    look.in_other_medium = request.view.markers;
    return look;
  }
  pipeline::PipelineOptions options_ = test::scripted_options();
  MediumWatch medium_;
  std::int64_t index_ = 0;
};

TEST_F(MediumWatchTest, AsksForOneLookAtATime) {
  show(2);
  const auto first = medium_.take_request();
  ASSERT_TRUE(first);
  show(3);
  EXPECT_FALSE(medium_.take_request()) << "the first one is still awaited";
  ASSERT_TRUE(medium_.awaits(look_of(*first)));
  medium_.take(look_of(*first));
  EXPECT_FALSE(medium_.awaits(look_of(*first))) << "once";
  show(3);
  EXPECT_TRUE(medium_.take_request());
}

// A look that comes late is of another source, or of one that has ended.
TEST_F(MediumWatchTest, WithItsSourceALookIsAwaitedNoMore) {
  show(2);
  const auto first = medium_.take_request();
  ASSERT_TRUE(first);
  medium_.on_source(options_);
  EXPECT_FALSE(medium_.awaits(look_of(*first)));
  show(2);
  const auto second = medium_.take_request();
  ASSERT_TRUE(second);
  EXPECT_NE(second->source_number, first->source_number);
  EXPECT_FALSE(medium_.awaits(look_of(*first)));
  medium_.on_source_end();
  EXPECT_FALSE(medium_.awaits(look_of(*second)));
  EXPECT_FALSE(medium_.take_request());
}

TEST_F(MediumWatchTest, KnowsNothingBeforeTheFirstSource) {
  const MediumWatch none;
  EXPECT_EQ(none.verdict().fit, pipeline::MediumFit::Unknown);
  EXPECT_FALSE(none.contradicts());
}

}  // namespace
}  // namespace arthronaut::operation
