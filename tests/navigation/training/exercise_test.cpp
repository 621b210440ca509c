#include "navigation/training/exercise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "planning/geometry/error.h"

namespace arthronaut::training {
namespace {

// A score is out of 100, whatever the exercise, and every mark can be both earned and lost.
TEST(Exercises, MarksAddUpToAHundred) {
  for (const Exercise& exercise : exercises()) {
    double sum = 0;
    std::set<Measure> seen;
    for (const Mark& mark : exercise.marks) {
      sum += mark.points;
      EXPECT_GT(mark.points, 0);
      EXPECT_LT(mark.good, mark.limit) << exercise.id;
      EXPECT_TRUE(seen.insert(mark.measure).second) << exercise.id << ": twice " << to_text(mark.measure);
      EXPECT_FALSE(to_text(mark.measure).empty());
    }
    EXPECT_DOUBLE_EQ(sum, 100) << exercise.id;
  }
}

TEST(Exercises, AreFoundByTheirNames) {
  std::set<std::string_view> ids;
  for (const Exercise& exercise : exercises()) {
    EXPECT_TRUE(ids.insert(exercise.id).second) << exercise.id;
    ASSERT_NE(find_exercise(exercise.id), nullptr);
    EXPECT_EQ(find_exercise(exercise.id)->title, exercise.title);
    EXPECT_FALSE(exercise.steps.empty());
  }
  EXPECT_EQ(find_exercise("juggle"), nullptr);
}

// Nothing goes wrong where it is easy; harder is never less.
TEST(Exercises, GetHarderByLevel) {
  for (const Exercise& exercise : exercises()) {
    EXPECT_TRUE(faults_of(exercise, Level::Easy).empty());
    const auto total = [&](Level level) {
      double sum = 0;
      for (const simulator::Fault& fault : faults_of(exercise, level))
        sum += fault.kind == simulator::FaultKind::BumpedMarker ? 10 : fault.duration_s * fault.strength;
      return sum;
    };
    EXPECT_GT(total(Level::Medium), 0) << exercise.id;
    EXPECT_GT(total(Level::Hard), total(Level::Medium)) << exercise.id;
  }
  EXPECT_NE(words_of_faults(*find_exercise("drill-femur"), Level::Hard).find("bumped marker"),
            std::string::npos);
  EXPECT_EQ(words_of_faults(*find_exercise("aim"), Level::Easy), "nothing goes wrong");
}

TEST(Exercises, LevelsAreReadAsTheyAreWritten) {
  for (const Level level : {Level::Easy, Level::Medium, Level::Hard})
    EXPECT_EQ(level_from_text(to_text(level)), level);
  EXPECT_THROW((void)level_from_text("impossible"), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::training
