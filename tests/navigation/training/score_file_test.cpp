#include "navigation/training/score_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::training {
namespace {

namespace fs = std::filesystem;

Score made(const char* exercise, Level level, double offset_mm, double time_s = 100) {
  ExerciseFacts facts;
  facts.is_done = true;
  facts.time_s = time_s;
  facts.frames = 3000;
  facts.entry_offset_mm = offset_mm;
  facts.angle_deg = 1;
  facts.alarms = facts.alarms_ignored = 1;
  Score score = score_of(*find_exercise(exercise), level, facts);
  score.seed = 7;
  score.when_utc = "2026-01-31T12:00:00Z";
  score.knee = "built-in knee 7";
  score.trainee = "by hand";
  return score;
}

// What was written is read back in every part, what it never came to too.
TEST(TrainingFile, KeepsEveryPart) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "new" / "training.json";
  EXPECT_TRUE(read_training_file(file).empty());
  const Score aim = made("aim", Level::Hard, 1.7), drill = made("drill-femur", Level::Easy, 0.5);
  add_to_training_file(file, aim);
  add_to_training_file(file, drill);
  const std::vector<Score> read = read_training_file(file);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].exercise, "aim");
  EXPECT_EQ(read[0].level, Level::Hard);
  EXPECT_EQ(read[0].seed, 7u);
  EXPECT_EQ(read[0].when_utc, aim.when_utc);
  EXPECT_EQ(read[0].better, aim.better);
  ASSERT_EQ(read[1].parts.size(), drill.parts.size());
  for (std::size_t i = 0; i < drill.parts.size(); ++i) {
    EXPECT_EQ(read[1].parts[i].measure, drill.parts[i].measure);
    EXPECT_EQ(read[1].parts[i].value, drill.parts[i].value);
    EXPECT_EQ(read[1].parts[i].points, drill.parts[i].points);
    EXPECT_EQ(read[1].parts[i].caps_at, drill.parts[i].caps_at);
    EXPECT_EQ(read[1].parts[i].reason, drill.parts[i].reason);
  }
}

// A list of before the rule was named is read: by the first rule, which the best of now is not compared with.
TEST(TrainingFile, OldScoresAreReadAndToldApart) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "training.json";
  add_to_training_file(file, made("drill-femur", Level::Easy, 0.5));
  auto document = nlohmann::json::parse(files::read_text(file));
  auto& old = document.at("scores").at(0);
  old.erase("rule");
  for (auto& part : old.at("parts")) part.erase("caps_at");
  old["points"] = 100;
  files::write_atomically(file, document.dump());
  std::vector<Score> scores = read_training_file(file);
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_TRUE(is_by_earlier_rule(scores[0]));
  EXPECT_EQ(best_of(scores, "drill-femur", Level::Easy), scores.data()) << "there is no other";
  add_to_training_file(file, made("drill-femur", Level::Easy, 3));
  scores = read_training_file(file);
  ASSERT_EQ(scores.size(), 2u);
  EXPECT_EQ(scores[0].points, 100);
  EXPECT_FALSE(is_by_earlier_rule(scores[1]));
  EXPECT_EQ(best_of(scores, "drill-femur", Level::Easy), &scores[1]);
  std::swap(scores[0], scores[1]);
  EXPECT_EQ(best_of(scores, "drill-femur", Level::Easy), scores.data());
}

// A broken file is refused with its name and place, and adding to it leaves it as it is.
TEST(TrainingFile, RefusesWhatIsBroken) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "training.json";
  const std::string broken =
      R"({"format": "arthronaut.training", "version": 1, "scores": [{"exercise": "aim", "level": "wild"}]})";
  files::write_atomically(file, broken);
  try {
    (void)read_training_file(file);
    FAIL() << "was read";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("training.json"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("level"), std::string::npos) << error.what();
  }
  EXPECT_THROW(add_to_training_file(file, made("aim", Level::Easy, 1)), InvalidInput);
  EXPECT_EQ(files::read_text(file), broken);
}

TEST(TrainingFile, ScoreAloneNamesItsFormat) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "score.json";
  write_score_file(file, made("aim", Level::Medium, 1));
  const files::JsonObject read = files::read_json(file, "arthronaut.score", 1);
  EXPECT_EQ(read.text("exercise"), "aim");
  EXPECT_EQ(read.objects("parts").size(), find_exercise("aim")->marks.size());
}

// Who adds at the same moment waits: none is lost.
TEST(TrainingFile, ManyAddAtOnce) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "data" / "training.json";
  constexpr int kWriters = 4, kEach = 10;
  std::vector<std::thread> writers;
  for (int i = 0; i < kWriters; ++i)
    writers.emplace_back([&] {
      for (int k = 0; k < kEach; ++k) add_to_training_file(file, made("aim", Level::Easy, 1));
    });
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(read_training_file(file).size(), std::size_t{kWriters * kEach});
}

// The best is of the same exercise and level, was done by hand, and of equals took less time.
TEST(TrainingFile, FindsTheBest) {
  Score unfinished = made("aim", Level::Easy, 0.1);
  unfinished.is_done = false;
  const std::vector<Score> scores{made("aim", Level::Easy, 3), made("aim", Level::Easy, 1.5, 110),
                                  made("aim", Level::Easy, 1.5, 25), made("aim", Level::Hard, 0.2),
                                  unfinished};
  const Score* best = best_of(scores, "aim", Level::Easy);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best, &scores[2]);
  EXPECT_EQ(best_of(scores, "aim", Level::Medium), nullptr);
  std::vector<Score> played{made("aim", Level::Easy, 3), made("aim", Level::Easy, 0.1)};
  played[1].trainee = "simulated trainee, careful";  // of `arthronaut train --keep`
  EXPECT_EQ(best_of(played, "aim", Level::Easy), played.data());
  std::vector<Score> equals{made("aim", Level::Easy, 1, 29), made("aim", Level::Easy, 1, 20)};
  ASSERT_EQ(equals[0].points, equals[1].points);
  EXPECT_EQ(best_of(equals, "aim", Level::Easy), &equals[1]);
}

}  // namespace
}  // namespace arthronaut::training
