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
      frame.camera = camera::CameraModel(options_.calibration, 0, options_.refractive_index);
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

// One that could not be taken is not waited for, and asked for again as after any other: not in every
// picture.
TEST_F(MediumWatchTest, AfterALookThatFailedAnotherOneIsAskedFor) {
  show(2);
  const auto first = medium_.take_request();
  ASSERT_TRUE(first);
  MediumLook failed = look_of(*first);
  failed.in_other_medium.clear();
  failed.failure = "no memory";
  failed.view.timestamp_ns = index_ * 1'000'000'000 / 60;  // it was asked for just now
  ASSERT_TRUE(medium_.awaits(failed));
  medium_.take(failed);
  EXPECT_EQ(medium_.verdict().fit, pipeline::MediumFit::Unknown);
  show(0.3);
  EXPECT_FALSE(medium_.take_request());
  show(0.4);
  EXPECT_TRUE(medium_.take_request());
}

// What is thrown while a picture is seen again ends nobody's thread: it is what came of that look.
TEST_F(MediumWatchTest, ALookThatThrowsIsAFailureAndTheNextOneBeginsAnew) {
  show(2);
  const auto request = medium_.take_request();
  ASSERT_TRUE(request);
  MediumLookWork work;
  camera::Frame small = test::plain_frame(request->view.frame_index, 90);
  small.width = 80;
  small.bgr.resize(static_cast<std::size_t>(3 * small.width * small.height));
  const MediumLookPtr failed = work.look(*request, small);
  EXPECT_FALSE(failed->failure.empty());
  EXPECT_TRUE(failed->in_other_medium.empty());
  EXPECT_TRUE(medium_.awaits(*failed));
  const MediumLookPtr seen = work.look(*request, test::plain_frame(request->view.frame_index, 90));
  EXPECT_EQ(seen->failure, "");
  EXPECT_EQ(seen->in_other_medium.size(), request->declared.size());
}

TEST_F(MediumWatchTest, KnowsNothingBeforeTheFirstSource) {
  const MediumWatch none;
  EXPECT_EQ(none.verdict().fit, pipeline::MediumFit::Unknown);
  EXPECT_FALSE(none.contradicts());
}

// It waits for the look at markers that say nothing; a record that guided needs no picture to say so.
TEST_F(MediumWatchTest, Hazard27HoldsUntilSomethingSpeaks) {
  show(2);
  EXPECT_TRUE(medium_.holds());
  const auto request = medium_.take_request();
  ASSERT_TRUE(request);
  MediumLook failed = look_of(*request);
  failed.in_other_medium.clear();
  medium_.take(failed);
  EXPECT_FALSE(medium_.holds()) << "nobody waits for what cannot be seen";
  medium_.on_source(options_);
  EXPECT_TRUE(medium_.holds());
  medium_.confirmed_by_record();
  EXPECT_FALSE(medium_.holds());
  medium_.on_source(options_);
  EXPECT_TRUE(medium_.holds());
}

}  // namespace
}  // namespace arthronaut::operation
