// The medium as the pictures show it, on clips that were traced in saline: stated rightly and wrongly.
#include <gtest/gtest.h>

#include <algorithm>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/pipeline/medium_check.h"
#include "navigation/pipeline/track_video.h"
#include "tests/real_data/real_data.h"

namespace arthronaut::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 60;  // a second

struct Outcome {
  MediumVerdict verdict;
  int frames = 0, decided_at = -1;  // the first frame with the last verdict
  // Frames in which two markers stand, and guidance waits for the medium; and does not, though it is not yet
  // told to be the wrong one.
  int held = 0, not_held = 0;
};

Outcome check(const fs::path& clip, double stated_index) {
  const camera::Calibration calibration = camera::read_camera_file(clip / "camera.json").calibration;
  const auto declared = markers::declared_markers(tools::read_tools_file(clip / "tools.json"));
  ViewTrackerOptions options;
  options.calibration = calibration;
  options.refractive_index = stated_index;
  ViewTracker tracker(options, markers::make_tracker(declared));
  MediumCheck medium(declared, stated_index, calibration.refractive_index);
  SecondLook second(declared, medium.other_index(), calibration.refractive_index);
  const auto source = sources::open_video(clip / "clip.mkv");
  Outcome outcome;
  PictureObservation view;
  while (const camera::FramePtr frame = outcome.frames < kFrames ? source->next() : nullptr) {
    tracker.observe(*frame, view);
    medium.look(view);
    if (medium.wants_second_look()) medium.look_again(view, second.look(*frame, view.camera));
    if (medium.verdict().fit != outcome.verdict.fit) outcome.decided_at = outcome.frames;
    outcome.verdict = medium.verdict();
    const auto standing = std::ranges::count_if(view.markers, [](const auto& m) { return m.is_tracked(); });
    if (standing > 1 && outcome.verdict.fit != MediumFit::Contradicts)
      ++(outcome.verdict.is_held ? outcome.held : outcome.not_held);
    ++outcome.frames;
  }
  std::printf("%s as %s: %s at frame %d of %d, %ld votes for, %ld against, guidance held in %d, not in %d\n",
              clip.filename().c_str(), camera::medium_to_text(stated_index).c_str(),
              outcome.verdict.fit == MediumFit::Fits          ? "fits"
              : outcome.verdict.fit == MediumFit::Contradicts ? "contradicts"
                                                              : "unknown",
              outcome.decided_at, outcome.frames, outcome.verdict.votes_for, outcome.verdict.votes_against,
              outcome.held, outcome.not_held);
  return outcome;
}

// Saline is confirmed within a quarter of a second, without one vote against it; air is contradicted within
// half a second.
TEST(MediumOnClips, Hazard27AirIsContradictedAndSalineIsNot) {
  for (const char* name : {"arthroscopy/ruler_wet", "arthroscopy/probe_wet", "arthroscopy/guide_wet"}) {
    ARTHRONAUT_REQUIRE_DATA(clip, name);
    const Outcome right = check(clip, camera::kSalineIndex);
    EXPECT_EQ(right.verdict.fit, MediumFit::Fits) << name;
    EXPECT_EQ(right.verdict.votes_against, 0) << name;
    EXPECT_LE(right.decided_at, 15) << name;
    EXPECT_EQ(right.held, 0) << name;
    const Outcome wrong = check(clip, camera::kAirIndex);
    EXPECT_EQ(wrong.verdict.fit, MediumFit::Contradicts) << name;
    EXPECT_LE(wrong.decided_at, 30) << name;
    EXPECT_EQ(wrong.not_held, 0) << name;
    EXPECT_EQ(wrong.verdict.other_index, camera::kSalineIndex);
  }
}

// Glare, cover and bubbles in the right medium are not taken for another one.
TEST(MediumOnClips, Hazard27AHardClipIsNotContradicted) {
  ARTHRONAUT_REQUIRE_DATA(clip, "arthroscopy/hard");
  const Outcome right = check(clip, camera::kSalineIndex);
  EXPECT_NE(right.verdict.fit, MediumFit::Contradicts);
  EXPECT_EQ(right.verdict.votes_against, 0);
}

// `arthronaut track` in the wrong medium: no pose, and the reason names both media.
TEST(MediumOnClips, Hazard27NoPoseStandsInTheWrongMedium) {
  ARTHRONAUT_REQUIRE_DATA(clip, "arthroscopy/guide_wet");
  ViewTrackerOptions options;
  options.calibration = camera::read_camera_file(clip / "camera.json").calibration;
  const tools::ToolSet tools = tools::read_tools_file(clip / "tools.json");
  for (const double stated : {camera::kAirIndex, camera::kSalineIndex}) {
    options.refractive_index = stated;
    const auto source = sources::open_video(clip / "clip.mkv");
    const TrackedVideo tracked = track_video(*source, options, tools);
    if (stated == camera::kSalineIndex) {
      EXPECT_TRUE(tracked.reasons.empty());
      EXPECT_FALSE(tracked.rows.empty());
      continue;
    }
    EXPECT_TRUE(tracked.rows.empty());
    ASSERT_EQ(tracked.reasons.size(), 1U);
    EXPECT_NE(tracked.reasons.front().find("as in saline, not as in air"), std::string::npos);
  }
}

}  // namespace
}  // namespace arthronaut::pipeline
