// `arthronaut train`: exercises as a script sees them. The exercises themselves are tested in
// tests/navigation/training; what runs here is a hand of a few frames, since each takes its time to draw.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "planning/files/atomic_file.h"
#include "tests/app/command_line/program.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

class TrainCommand : public ::testing::Test {
 protected:
  [[nodiscard]] test::ProgramResult train(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "train");
    return test::run_program(arguments, {.data_home = folder_ / "home"});
  }
  // Holds the guide still for some frames; says at the last that it is done.
  [[nodiscard]] fs::path hand(int frames, bool is_done) const {
    const auto push = [](int frame, const char* press) -> json {
      return {{"frame", frame},    {"held", "guide"}, {"moves_scope", false}, {"move", {0, 0, 0}},
              {"tilt", {0, 0, 0}}, {"turn_lens", 0},  {"drill", 0},           {"press", press}};
    };
    json pushes = {push(0, "none")};
    if (is_done) pushes.push_back(push(frames - 1, "finish"));
    const fs::path file = folder_ / "hand.json";
    files::write_atomically(
        file,
        json{{"format", "arthronaut.hand"}, {"version", 1}, {"frames", frames}, {"pushes", pushes}}.dump());
    return file;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(TrainCommand, ListsExercisesAndScores) {
  const auto list = train({"--list"});
  EXPECT_EQ(list.exit_code, 0) << list.errors;
  for (const char* id :
       {"calibrate: ", "pivot: ", "register: ", "aim: ", "drill-femur: ", "drill-tibia: ", "bumped marker"})
    EXPECT_THAT(list.output, HasSubstr(id));
  const auto none = train({"--scores"});
  EXPECT_EQ(none.exit_code, 0) << none.errors;
  EXPECT_THAT(none.output, HasSubstr("No score is kept"));
}

TEST_F(TrainCommand, RefusesWhatIsNotThere) {
  EXPECT_EQ(train({}).exit_code, 2);
  EXPECT_EQ(train({"--exercise", "aim", "--level", "mad"}).exit_code, 2);
  const auto unknown = train({"--exercise", "juggle"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("--exercise: there is no exercise \"juggle\""));
  EXPECT_EQ(train({"--scores", "--exercise", "juggle"}).exit_code, 2);
  const auto hand = train({"--exercise", "aim", "--hand", folder_ / "none.json"});
  EXPECT_EQ(hand.exit_code, 3);
  EXPECT_THAT(hand.errors, HasSubstr("none.json"));
  EXPECT_EQ(train({"--exercise", "aim", "--case", folder_ / "none.arthro"}).exit_code, 3);
  const auto session = train({"--exercise", "calibrate", "--case", folder_ / "none.arthro"});
  EXPECT_EQ(session.exit_code, 3);
  EXPECT_THAT(session.errors, HasSubstr("leaves no session"));
}

// An exercise on a case becomes a session of it; the score is a file and stands in the user's list.
TEST_F(TrainCommand, ScoresAndRecords) {
  const fs::path knee = folder_ / "Knee.arthro", score = folder_ / "score.json";
  ASSERT_EQ(test::run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto run =
      train({"--exercise", "aim", "--hand", hand(6, true), "--case", knee, "-o", score, "--keep"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("of 100"));
  EXPECT_THAT(run.output, HasSubstr("To do better:"));
  const json written = json::parse(files::read_text(score));
  EXPECT_EQ(written.at("exercise"), "aim");
  EXPECT_TRUE(written.at("is_done"));
  EXPECT_EQ(written.at("trainee"), "hand of hand.json");
  // The guide stands where it began, 11 degrees aslant.
  EXPECT_NEAR(written.at("parts").at(1).at("value"), 11, 0.1);
  EXPECT_TRUE(fs::exists(knee / "sessions" / written.at("session") / "session.json"));
  EXPECT_THAT(train({"--scores"}).output, HasSubstr("hand of hand.json"));
}

// A list that nobody can add to is told before the work, and leaves nothing of it.
TEST_F(TrainCommand, AListThatCannotBeReadIsToldFirst) {
  const fs::path knee = folder_ / "Knee.arthro", score = folder_ / "score.json", kept = folder_ / "kept.json";
  ASSERT_EQ(test::run_program({"phantom", "-o", knee}).exit_code, 0);
  fs::create_directories(folder_ / "home/arthronaut");
  files::write_atomically(folder_ / "home/arthronaut/training.json", "{");
  const auto run = train({"--exercise", "aim", "--hand", hand(3, true), "--case", knee, "-o", score,
                          "--keep-hand", kept, "--keep"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.errors, HasSubstr("training.json"));
  EXPECT_FALSE(fs::exists(score));
  EXPECT_FALSE(fs::exists(kept));
  EXPECT_FALSE(fs::exists(knee / "sessions"));
}

// The calibration of a camera needs no case; done at once it has found none, and says why.
TEST_F(TrainCommand, Calibrates) {
  const fs::path score = folder_ / "score.json";
  const auto run = train({"--exercise", "calibrate", "--hand", hand(3, true), "-o", score});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("No camera that may be used was found"));
  const json written = json::parse(files::read_text(score));
  EXPECT_EQ(written.at("knee"), "checkerboard");
  EXPECT_EQ(written.at("session"), "");
  EXPECT_EQ(written.at("parts").at(0).at("value"), nullptr);
}

// Hazard 40: a case with a session that is no simulation, or with the camera of a real scope, is somebody's.
TEST_F(TrainCommand, Hazard40RefusesACaseThatIsSomebodys) {
  const fs::path knee = folder_ / "Knee.arthro";
  ASSERT_EQ(test::run_program({"phantom", "-o", knee}).exit_code, 0);
  const std::vector<std::string> aim{"--exercise", "aim", "--hand", hand(3, true), "--case", knee};
  files::write_atomically(knee / "camera.json", "{}");
  const auto camera = train(aim);
  EXPECT_EQ(camera.exit_code, 3);
  EXPECT_THAT(camera.errors, HasSubstr("camera.json"));
  fs::remove(knee / "camera.json");
  ASSERT_EQ(train(aim).exit_code, 0);
  for (const auto& entry : fs::directory_iterator(knee / "sessions")) {
    const fs::path file = entry.path() / "session.json";
    json header = json::parse(files::read_text(file));
    header["source_kind"] = "live";
    files::write_atomically(file, header.dump());
  }
  const auto live = train(aim);
  EXPECT_EQ(live.exit_code, 3);
  EXPECT_THAT(live.errors, HasSubstr("is no simulation"));
}

// A hand that ends before it says that it is done: the score is written, counts nothing, and exit code 4
// says so.
TEST_F(TrainCommand, HalfAnExerciseIsUnreliable) {
  const fs::path score = folder_ / "score.json";
  const auto run = train({"--exercise", "aim", "--hand", hand(3, false), "-o", score});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.errors, HasSubstr("not brought to its end"));
  EXPECT_EQ(json::parse(files::read_text(score)).at("points"), 0);
}

// Half a session in the case would pass for an exercise that was done.
TEST_F(TrainCommand, StoppedByHandLeavesNoSession) {
  const fs::path knee = folder_ / "Knee.arthro";
  ASSERT_EQ(test::run_program({"phantom", "-o", knee}).exit_code, 0);
  const auto sessions = [&] {
    return fs::exists(knee / "sessions") ? std::distance(fs::directory_iterator(knee / "sessions"), {}) : 0;
  };
  const auto stopped =
      test::run_program({"train", "--exercise", "aim", "--hand", hand(3000, false), "--case", knee},
                        {.data_home = folder_ / "home", .interrupts_when = [&] { return sessions() > 0; }});
  EXPECT_EQ(stopped.exit_code, 128 + SIGINT) << stopped.errors;
  EXPECT_EQ(sessions(), 0);
}

}  // namespace
}  // namespace arthronaut
