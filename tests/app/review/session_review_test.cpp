#include "app/review/session_review.h"

#include <gtest/gtest.h>

#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

// Stretches cover exactly what held, and gaps of up to `bridge` frames are closed.
TEST(SessionReview, StretchesBridgeShortGaps) {
  const std::vector<bool> holds{true, true, false, true, false, false, false, true};
  const auto stretches = stretches_of(holds, 1);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].first, 0U);
  EXPECT_EQ(stretches[0].last, 3U);
  EXPECT_EQ(stretches[1].first, 7U);
  EXPECT_EQ(stretches[1].last, 7U);
  EXPECT_TRUE(stretches_of({false, false}, 3).empty());
  EXPECT_TRUE(stretches_of({}, 3).empty());
}

// A session is looked at with the plan that guided in it, the last one, whatever the case plans by now.
TEST(SessionReview, HoldsThePlanThatGuided) {
  const test::TemporaryFolder folder;
  {
    recording::SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    tunnels::Tunnel plan;
    for (const double x_mm : {1.0, 2.0}) {
      plan.entry_mm = {x_mm, 0, 0};
      recorder.set_plan(plan, 30 + x_mm);
      recorder.append(test::frame_result(static_cast<int>(x_mm)));
    }
    recorder.finish();
  }
  const SessionReview review = read_review(folder.path());
  ASSERT_TRUE(review.plan.plan);
  EXPECT_EQ(review.plan.plan->entry_mm.x(), 2.0);
  EXPECT_EQ(review.plan.planned_length_mm, 32.0);
  EXPECT_TRUE(review.achieved.empty());
}

// What a session was made of is told with the word that it is a recording: a simulated one is nobody's knee.
TEST(SessionReview, Hazard2SaysWhatTheRecordingIsOf) {
  recording::SessionHeader header = test::session_header();
  EXPECT_EQ(origin_in_words(header), "RECORDING") << "older records do not say it";
  header.source_kind = "live";
  EXPECT_EQ(origin_in_words(header), "RECORDING of a live camera");
  header.source_kind = "recording";
  EXPECT_EQ(origin_in_words(header), "RECORDING of a video");
  header.source_kind = "simulation";
  EXPECT_EQ(origin_in_words(header), "RECORDING of a simulation");
}

}  // namespace
}  // namespace arthronaut::review
