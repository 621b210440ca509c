// The tracker on hard clips on which it once went wrong; the benchmark hard_tracking tells how often it does.
#include <gtest/gtest.h>

#include <algorithm>

#include "navigation/markers/marker_tracker.h"
#include "tests/benchmarks/hard_clips/hard_clip.h"
#include "tests/real_data/pose_error.h"

namespace arthronaut::hard_clips {
namespace {

// A square about a marker under a highlight, of three times its size, was read as the one beside it: what is
// saturated says nothing, and the few cells that were left agreed. The one beside it, in plain view, was said
// to be seen twice and withheld.
TEST(HardClips, HighlightsOnOneMarkerMakeNoSecondOneOfAnother) {
  constexpr int kFrames = 2;
  const ClipRecipe recipe = recipe_of(Hardness::Glare, 82, kFrames);
  HardClip clip(recipe);
  std::vector<markers::DeclaredMarker> declared;
  for (const int id : {0, 2, 3, 4}) declared.push_back({id, recipe.marker_size_mm});
  const auto tracker = markers::make_tracker(declared);
  int frames = 0;
  for (camera::GrayView picture = clip.next(); picture.data; picture = clip.next(), ++frames) {
    for (const auto& seen : tracker->track(picture, clip.camera(), clip.timestamp_ns()))
      EXPECT_NE(seen.state, markers::MarkerState::Duplicate) << "marker " << seen.id << ", frame " << frames;
  }
  EXPECT_EQ(frames, kFrames);
}

// Highlights hide what tells marker 3, which is shown, from marker 11, cell by cell. It was tracked as that
// one in all frames of the clip.
TEST(HardClips, Hazard48AMarkerThatIsNotDeclaredIsNotTakenForOneThatIs) {
  const ClipRecipe recipe = recipe_of(Hardness::Glare, 6, 4);
  HardClip clip(recipe);
  std::vector<markers::DeclaredMarker> declared;
  for (const int id : {8, 9, 10, 11}) declared.push_back({id, recipe.marker_size_mm});
  const auto tracker = markers::make_tracker(declared);
  for (camera::GrayView picture = clip.next(); picture.data; picture = clip.next()) {
    for (const auto& seen : tracker->track(picture, clip.camera(), clip.timestamp_ns()))
      EXPECT_FALSE(seen.is_tracked()) << "marker " << seen.id;
  }
}

// A marker that is first looked at while it turns back, smeared over half a cell, was tracked 20 degrees off
// and said to be known to 2: the code fits another tilt when it is moved as well. Its edges, each by itself,
// are of neither, and do not meet in its corners.
TEST(HardClips, ATiltThatTheEdgesContradictDoesNotStandThroughASmearOfHalfACell) {
  constexpr int kFirst = 14, kFrames = 18;
  const ClipRecipe recipe = recipe_of(Hardness::Smear, 158, kFrames);
  HardClip clip(recipe);
  std::vector<markers::DeclaredMarker> declared;
  for (const int id : {0, 2, 3, 4}) declared.push_back({id, recipe.marker_size_mm});
  const auto tracker = markers::make_tracker(declared);
  int frame = 0, tracked = 0;
  for (camera::GrayView picture = clip.next(); picture.data; picture = clip.next(), ++frame) {
    if (frame < kFirst) continue;
    for (const auto& seen : tracker->track(picture, clip.camera(), clip.timestamp_ns())) {
      if (!seen.is_tracked()) continue;
      const auto truth = std::find_if(clip.truth().begin(), clip.truth().end(),
                                      [&](const MarkerTruth& marker) { return marker.id == seen.id; });
      ASSERT_NE(truth, clip.truth().end());
      const auto error = real_data::pose_error(seen.camera_from_marker, truth->camera_from_marker);
      EXPECT_FALSE(error.is_wrong()) << "marker " << seen.id << ", frame " << frame << ": "
                                     << error.rotation_deg << " deg, " << error.translation_mm << " mm";
      ++tracked;
    }
  }
  EXPECT_EQ(frame, kFrames);
  EXPECT_GT(tracked, 2);
}

}  // namespace
}  // namespace arthronaut::hard_clips
