// The schemas of training say what is written of it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "navigation/training/score_file.h"
#include "navigation/training/trainee.h"
#include "planning/geometry/error.h"
#include "tests/resources/described.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class TrainingSchemas : public ::testing::Test {
 protected:
  static json read(const fs::path& file) {
    std::ifstream in(file);
    return json::parse(in);
  }
  // One that drilled nothing: parts without a value.
  static training::Score score() {
    training::ExerciseFacts facts;
    facts.is_done = true;
    facts.time_s = 400;
    facts.frames = 12000;
    training::Score made =
        training::score_of(*training::find_exercise("drill-tibia"), training::Level::Hard, facts);
    made.when_utc = "2026-01-31T12:00:00Z";
    return made;
  }
  test::TemporaryFolder folder_;
};

TEST_F(TrainingSchemas, DescribeScores) {
  training::write_score_file(folder_ / "score.json", score());
  const json written = read(folder_ / "score.json");
  EXPECT_EQ(test::undescribed(written, "score"), "");
  for (const char* key :
       {"/points", "/parts/0/points", "/level", "/better", "/parts/0/value", "/parts/0/caps_at", "/rule"}) {
    json broken = written;
    broken[json::json_pointer(key)] = "wild";
    EXPECT_NE(test::undescribed(broken, "score"), "") << key;
  }
}

TEST_F(TrainingSchemas, DescribeScoresOverTime) {
  const fs::path file = folder_ / "training.json";
  training::add_to_training_file(file, score());
  training::add_to_training_file(file, score());
  const json written = read(file);
  EXPECT_EQ(test::undescribed(written, "training"), "");
  for (const char* key : {"exercise", "level", "when_utc", "trainee", "knee", "seed", "session", "is_done",
                          "points", "parts", "better"}) {
    json broken = written;
    broken.at("scores").at(1).erase(key);
    EXPECT_NE(test::undescribed(broken, "training"), "") << key;
    std::ofstream(file) << broken;
    EXPECT_THROW((void)training::read_training_file(file), InvalidInput) << key;
  }
}

TEST_F(TrainingSchemas, DescribeHands) {
  const fs::path file = folder_ / "hand.json";
  std::vector<simulator::HandTruth> frames(3);
  frames[0].input.move = {1, 0, 0};
  frames[0].input.held = simulator::Held::Board;
  frames[0].input.press = simulator::Press::DropPicture;
  frames[2].frame = 2;
  frames[2].input.press = simulator::Press::ControlPoint;
  training::write_hand_file(file, frames);
  const json written = read(file);
  EXPECT_EQ(test::undescribed(written, "hand"), "");
  EXPECT_EQ(written.at("frames"), 3);
  for (const char* key : {"frame", "held", "moves_scope", "move", "tilt", "turn_lens", "drill", "press"}) {
    json broken = written;
    broken.at("pushes").at(0).erase(key);
    EXPECT_NE(test::undescribed(broken, "hand"), "") << key;
    std::ofstream(file) << broken;
    EXPECT_THROW((void)training::read_hand_file(file), InvalidInput) << key;
  }
}

}  // namespace
}  // namespace arthronaut
