#include "app/navigate/hindrance.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/app/navigate/shown_operation.h"

namespace arthronaut::navigate {
namespace {

using markers::MarkerState;
using operation::NextAction;
using theatre::SourceTrouble;

// An operation in which everything is seen; what a test takes away is missing.
struct Seen : Shown {
  SourceTrouble trouble = SourceTrouble::None;

  Seen() {
    for (tools::Tool& tool : source.pipeline.tools.tools) {
      if (tool.name == source.pipeline.probe_name) tool.tip_mm = Eigen::Vector3d(0, -20, 0);
      if (tool.name == source.pipeline.guide_name) tool.axis = tools::ToolAxis{{0, -20, 0}, {0, -1, 0}};
    }
    for (const tools::WorldMarker& marker : source.pipeline.tools.world_markers) see(marker.marker_id);
    for (const tools::Tool& tool : source.pipeline.tools.tools) see(tool.marker_id);
  }
  void see(int id, MarkerState state = MarkerState::Tracked) {
    for (markers::BodyObservation& body : operation.frame.bodies)
      if (body.id == id) body.state = state;
    if (state != MarkerState::Tracked) return;
    operation.frame.bodies.emplace_back();
    operation.frame.bodies.back().id = id;
    operation.frame.bodies.back().state = state;
  }
  [[nodiscard]] int world() const {
    return source.pipeline.tools.find_world_marker(source.pipeline.bone)->marker_id;
  }
  [[nodiscard]] int probe() const {
    return source.pipeline.tools.find_tool(source.pipeline.probe_name)->marker_id;
  }
  [[nodiscard]] int guide() const {
    return source.pipeline.tools.find_tool(source.pipeline.guide_name)->marker_id;
  }
  [[nodiscard]] std::string missing(NextAction action) {
    operation.next_action = action;
    return hindrance_of(*whole().operation, trouble);
  }
};

constexpr NextAction kTouching[]{NextAction::GoOnDrawing,       NextAction::ConfirmByTouch,
                                 NextAction::VerifyByTouch,     NextAction::SetControlPoint,
                                 NextAction::CheckControlPoint, NextAction::CheckWorldMarker};
constexpr NextAction kGuiding[]{NextAction::CheckGuide, NextAction::BringGuide, NextAction::FollowBullseye};

TEST(Hindrance, IsNoneWhileEverythingIsSeen) {
  for (int action = 0; action <= static_cast<int>(NextAction::Finish); ++action)
    EXPECT_EQ(Seen().missing(static_cast<NextAction>(action)), "") << action;
}

TEST(Hindrance, OfATouchIsTheMarkerOrTheProbe) {
  for (const NextAction action : kTouching) {
    Seen seen;
    seen.see(seen.probe(), MarkerState::OutOfView);
    EXPECT_EQ(seen.missing(action), "probe is out of view");
    seen.see(seen.probe(), MarkerState::Glare);
    EXPECT_EQ(seen.missing(action), "glare on the probe");
    seen.see(seen.world(), MarkerState::Covered);
    EXPECT_EQ(seen.missing(action), "bone marker is covered") << "it is needed first";
    seen.operation.frame.intrinsics_are_known = false;
    seen.operation.frame.lens.mark = lens::MarkState::Dark;
    EXPECT_EQ(seen.missing(action), "lens mark not found");
  }
}

TEST(Hindrance, OfATouchIsATipThatIsNotCalibrated) {
  for (const NextAction action : kTouching) {
    Seen seen;
    for (tools::Tool& tool : seen.source.pipeline.tools.tools) tool.tip_mm.reset();
    EXPECT_EQ(seen.missing(action), "probe's tip not calibrated: step 4");
    seen.trouble = SourceTrouble::Late;
    EXPECT_EQ(seen.missing(action), "probe's tip not calibrated: step 4") << "no picture brings it";
  }
}

TEST(Hindrance, OfGuidingIsTheGuide) {
  for (const NextAction action : kGuiding) {
    Seen seen;
    seen.see(seen.probe(), MarkerState::NotSeen);
    EXPECT_EQ(seen.missing(action), "") << "the probe is not needed";
    seen.see(seen.guide(), MarkerState::NotSeen);
    EXPECT_EQ(seen.missing(action), "guide not seen");
    for (tools::Tool& tool : seen.source.pipeline.tools.tools) tool.axis.reset();
    EXPECT_EQ(seen.missing(action), "guide's axis not calibrated: step 4");
  }
}

// Every state of a marker but a good one has words of its own, short enough for one line of the column.
TEST(Hindrance, HasWordsForWhateverKeepsAMarkerFromBeingTracked) {
  std::set<std::string> all;
  for (int state = 1; state <= static_cast<int>(MarkerState::Disagreeing); ++state) {
    Seen seen;
    seen.see(seen.world(), static_cast<MarkerState>(state));
    const std::string words = seen.missing(NextAction::ShowWorldMarker);
    EXPECT_FALSE(words.empty()) << state;
    EXPECT_LE(words.size(), 36U) << words;
    all.insert(words);
  }
  EXPECT_EQ(all.size(), 11U);
}

TEST(Hindrance, IsThePictureBeforeAnythingInIt) {
  Seen late;
  late.trouble = SourceTrouble::Late;
  late.see(late.probe(), MarkerState::NotSeen);
  EXPECT_EQ(late.missing(NextAction::GoOnDrawing), "the pictures are late");
  // Of pictures that come slowly strokes are drawn all the same.
  late.trouble = SourceTrouble::Slow;
  EXPECT_EQ(late.missing(NextAction::GoOnDrawing), "probe not seen");
  EXPECT_EQ(late.missing(NextAction::FollowBullseye), "the pictures come too slowly");
  // That nothing will guide by them is said before the guide is taken.
  Seen slow;
  slow.trouble = SourceTrouble::Slow;
  for (const NextAction action : kTouching)
    EXPECT_EQ(slow.missing(action), "pictures come too slowly to guide by");
  Seen torn;
  torn.operation.frame.is_torn = true;
  torn.operation.frame.intrinsics_are_known = false;
  EXPECT_EQ(torn.missing(NextAction::GoOnDrawing), "the picture is torn");
  Seen repeating;
  repeating.operation.frame.is_repeating = true;
  EXPECT_EQ(repeating.missing(NextAction::FollowBullseye), "the picture does not change");
  EXPECT_EQ(repeating.missing(NextAction::RegisterStrokes), "") << "it needs none";
}

// What has to be done elsewhere is said of the step of now; of one that was gone back to, all that it waits
// for.
TEST(Hindrance, OfAStepIsWhatItWaitsFor) {
  EXPECT_EQ(hindrance_of(RailStep{operation::Step::Calibrate, StepState::Now, Missing::Camera}, false),
            "no calibrated camera");
  EXPECT_EQ(hindrance_of(RailStep{operation::Step::Digitise, StepState::Now, Missing::Strokes}, false), "");
  EXPECT_EQ(hindrance_of(RailStep{operation::Step::Verify, StepState::Closed, Missing::Registration}, true),
            "no registration stands");
}

// One picture in which a marker is blurred is no news; what lasts is said, and taken back at once.
TEST(SteadyWords, AreSaidOnceTheyHaveLasted) {
  SteadyWords words;
  EXPECT_EQ(words.follow("probe not seen", 1.0), "");
  EXPECT_EQ(words.follow("", 1.1), "");
  EXPECT_EQ(words.follow("probe not seen", 1.2), "");
  EXPECT_EQ(words.follow("probe not seen", 1.6), "probe not seen");
  EXPECT_EQ(words.follow("probe is covered", 1.7), "probe not seen");
  EXPECT_EQ(words.follow("probe is covered", 2.1), "probe is covered");
  EXPECT_EQ(words.follow("", 2.2), "");
}

// What was refused minutes ago stands no more over the operation; said again it stands again.
TEST(PassingWords, AreReadOnceTheyHaveStoodThere) {
  PassingWords words;
  EXPECT_FALSE(words.are_read("", 0));
  EXPECT_FALSE(words.are_read("", 100)) << "there is nothing to read";
  EXPECT_FALSE(words.are_read("Stop the source first", 101));
  EXPECT_FALSE(words.are_read("Stop the source first", 120));
  EXPECT_FALSE(words.are_read("There is no video", 121)) << "another one";
  EXPECT_TRUE(words.are_read("There is no video", 141));
  EXPECT_FALSE(words.are_read("", 142));
  EXPECT_FALSE(words.are_read("There is no video", 143)) << "again";
}

}  // namespace
}  // namespace arthronaut::navigate
