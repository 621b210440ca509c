#include "navigation/training/exercise_run.h"

#include <gtest/gtest.h>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/training/trainee.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::training {
namespace {

const ExerciseSetup& aiming() {
  static const ExerciseSetup setup = standard_setup(*find_exercise("aim"), Level::Easy, 1);
  return setup;
}
const ExerciseOutcome& careful_aim() {
  static const ExerciseOutcome outcome = run_exercise(aiming(), make_trainee(Goal::Aim, careful(1)));
  return outcome;
}

// The facts are the trainee's own: it set the guide 0.4 mm beside and 0.8 degrees aslant. Within a quarter of
// a millimetre and of a degree, which is where it takes itself for being there.
TEST(ExerciseRun, MeasuresWhatTheHandDid) {
  const ExerciseFacts& facts = careful_aim().facts;
  EXPECT_TRUE(facts.is_done);
  ASSERT_TRUE(facts.entry_offset_mm && facts.angle_deg);
  EXPECT_NEAR(*facts.entry_offset_mm, 0.4, 0.25);
  EXPECT_NEAR(*facts.angle_deg, 0.8, 0.45);
  EXPECT_EQ(facts.bad_data_mm, 0);
  ASSERT_TRUE(facts.off_bone_mm);
  EXPECT_LT(*facts.off_bone_mm, 0.5);
  EXPECT_LT(facts.unseen_s, 0.1 * facts.time_s);
  EXPECT_FALSE(facts.depth_error_mm.has_value());
}

// Hazard 40: whoever reads the case's sessions knows the record for an exercise's.
TEST(ExerciseRun, Hazard40TheRecordSaysThatItIsAnExercise) {
  const test::TemporaryFolder folder;
  std::vector<simulator::HandTruth> frames = careful_aim().frames;
  frames.resize(3);
  write_hand_file(folder / "hand.json", frames);
  theatre::RecordOptions record;
  record.folder = folder / "session";
  std::filesystem::create_directory(record.folder);
  (void)run_exercise(aiming(), read_hand_file(folder / "hand.json"), record);
  EXPECT_TRUE(recording::is_exercise(record.folder));
}

// Whoever takes the probe sees its marker and the bone's, before he has moved anything.
TEST(ExerciseRun, TheProbesExercisesBeginWithBothMarkersInView) {
  const std::vector<std::pair<const char*, std::uint64_t>> exercises = {
      {"pivot", 1}, {"pivot", 2}, {"register", 3}, {"drill-tibia", 2}};
  for (const auto& [name, seed] : exercises) {
    int frames = 0;
    const simulator::Hand still = [&frames](const simulator::HandScene&, const simulator::HandState&) {
      return frames++ < 5 ? std::optional<simulator::HandInput>(simulator::HandInput()) : std::nullopt;
    };
    const ExerciseSetup setup = standard_setup(*find_exercise(name), Level::Easy, seed);
    EXPECT_EQ(run_exercise(setup, still).facts.unseen_s, 0) << name << ", seed " << seed;
  }
}

// Where the probe is pulled away the light follows neither it nor whatever lies behind: the bone's marker,
// which nobody has moved, is found as before.
TEST(ExerciseRun, TheBonesMarkerIsSeenWhereverTheToolIs) {
  int frames = 0;
  simulator::HandInput away;
  away.move = {1, 0, 0};
  const simulator::Hand pulls = [&](const simulator::HandScene&, const simulator::HandState&) {
    return frames++ < 75 ? std::optional(away) : std::nullopt;
  };
  const ExerciseSetup setup = standard_setup(*find_exercise("register"), Level::Easy, 1);
  const theatre::TheatreSource source =
      exercise_source(setup, pulls, std::make_shared<ExerciseWatch>(setup), false);
  pipeline::NavigationPipeline tracking(source.setup.pipeline);
  pipeline::FrameResult result;
  const auto opened = source.open();
  for (camera::FramePtr frame = opened->next(); frame != nullptr; frame = opened->next()) {
    tracking.process(*frame, result);
    EXPECT_TRUE(result.world_is_seen()) << frames;
  }
}

// Who hurries is worth less, in the parts that were done badly.
TEST(ExerciseRun, HasteCosts) {
  const ExerciseOutcome hurried = run_exercise(aiming(), make_trainee(Goal::Aim, hasty(1)));
  EXPECT_LT(hurried.score.points, careful_aim().score.points - 10);
  EXPECT_NEAR(*hurried.facts.entry_offset_mm, 2.5, 0.5);
  EXPECT_NEAR(*hurried.facts.angle_deg, 4, 0.5);
  ASSERT_FALSE(hurried.score.better.empty());
}

// A hand that was kept does the same again, to the last digit of the score.
TEST(ExerciseRun, KeptHandDoesTheSame) {
  const test::TemporaryFolder folder;
  const auto file = folder / "hand.json";
  write_hand_file(file, careful_aim().frames);
  const ExerciseOutcome again = run_exercise(aiming(), read_hand_file(file));
  EXPECT_EQ(again.facts.frames, careful_aim().facts.frames);
  EXPECT_EQ(again.facts.entry_offset_mm, careful_aim().facts.entry_offset_mm);
  EXPECT_EQ(again.facts.angle_deg, careful_aim().facts.angle_deg);
  EXPECT_EQ(again.facts.unseen_s, careful_aim().facts.unseen_s);
  EXPECT_EQ(again.score.points, careful_aim().score.points);
  EXPECT_TRUE(again.score.is_done);
}

// A hand that is cut off is not done, and is worth nothing.
TEST(ExerciseRun, HalfARunIsNotDone) {
  const test::TemporaryFolder folder;
  std::vector<simulator::HandTruth> frames = careful_aim().frames;
  frames.resize(20);
  write_hand_file(folder / "hand.json", frames);
  const ExerciseOutcome half = run_exercise(aiming(), read_hand_file(folder / "hand.json"));
  EXPECT_FALSE(half.score.is_done);
  EXPECT_EQ(half.score.points, 0);
  EXPECT_EQ(half.facts.frames, 20);
}

TEST(HandFile, RefusesWhatIsBroken) {
  const test::TemporaryFolder folder;
  const auto file = folder / "hand.json";
  const auto refusal_of = [&](const std::string& pushes) -> std::string {
    files::write_atomically(
        file, R"({"format": "arthronaut.hand", "version": 1, "frames": 5, "pushes": [)" + pushes + "]}");
    try {
      (void)read_hand_file(file);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  const auto push = [](const std::string& frame, const std::string& held, const std::string& press) {
    return R"({"frame": )" + frame + R"(, "held": ")" + held +
           R"(", "moves_scope": false, "move": [0, 0, 0], "tilt": [0, 0, 0], "turn_lens": 0, "drill": 0, "press": ")" +
           press + "\"}";
  };
  EXPECT_EQ(refusal_of(push("0", "probe", "none")), "");
  EXPECT_NE(refusal_of(push("-1", "probe", "none")).find("frame"), std::string::npos);
  EXPECT_NE(refusal_of(push("0", "spoon", "none")).find("held"), std::string::npos);
  EXPECT_NE(refusal_of(push("0", "probe", "dance")).find("press"), std::string::npos);
  EXPECT_NE(refusal_of(push("3", "probe", "none") + "," + push("3", "guide", "none")).find("pushes[1]"),
            std::string::npos);
  EXPECT_THROW((void)read_hand_file(folder / "none.json"), IoError);
}

}  // namespace
}  // namespace arthronaut::training
