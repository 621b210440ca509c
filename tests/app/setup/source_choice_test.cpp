#include "app/setup/source_choice.h"

#include <gtest/gtest.h>

namespace arthronaut::setup {
namespace {

FeedSource source_of(const std::string& name, bool is_simulated = false) {
  FeedSource source;
  source.name = name;
  source.path = name;
  source.is_simulated = is_simulated;
  return source;
}

const FeedSource kSimulator = source_of("simulator", true), kVideo = source_of("knee.mkv"),
                 kCamera = source_of("HD camera");

std::string chosen(const SourceChoice& choice) {
  return choice.chosen() == nullptr ? "none" : choice.chosen()->name;
}

TEST(SourceChoice, TakesTheFirstAndGoesRound) {
  SourceChoice choice;
  choice.offer({kSimulator, kVideo});
  EXPECT_EQ(chosen(choice), "simulator");
  EXPECT_EQ(choice.text(), "simulator  (1 of 2)");
  choice.choose_next();
  EXPECT_EQ(chosen(choice), "knee.mkv");
  choice.choose_next();
  EXPECT_EQ(chosen(choice), "simulator");
}

// What was chosen stays chosen wherever it stands in the list.
TEST(SourceChoice, FollowsASourceThroughTheList) {
  SourceChoice choice;
  choice.offer({kSimulator, kVideo});
  choice.choose_next();
  choice.offer({kCamera, kSimulator, kVideo});
  EXPECT_EQ(chosen(choice), "knee.mkv");
}

// A path that leads nowhere is an error that stays, whatever is offered meanwhile, until another source is
// chosen: the simulator, first in the list, does not take its place.
TEST(SourceChoice, Hazard26AMistypedSourceIsAnErrorNotTheSimulator) {
  SourceChoice choice;
  choice.offer({kSimulator, kVideo});
  EXPECT_FALSE(choice.choose_path("nee.mkv"));
  EXPECT_EQ(choice.chosen(), nullptr);
  EXPECT_EQ(choice.problem(), "No source there: nee.mkv");
  choice.offer({kSimulator, kVideo, kCamera});
  EXPECT_EQ(choice.chosen(), nullptr);
  EXPECT_EQ(choice.text(), "No source there: nee.mkv");
  EXPECT_TRUE(choice.choose_path("knee.mkv"));
  EXPECT_EQ(chosen(choice), "knee.mkv");
  EXPECT_EQ(choice.problem(), "");
}

// A camera that was pulled out, and the simulator once the case has a real scope: gone is gone.
TEST(SourceChoice, Hazard26WhatIsGoneIsNotReplacedByAnother) {
  SourceChoice choice;
  choice.offer({kSimulator, kCamera});
  choice.choose_next();
  choice.offer({kSimulator});
  EXPECT_EQ(choice.chosen(), nullptr);
  EXPECT_EQ(choice.problem(), "No longer there: HD camera");
  choice.offer({kSimulator, kCamera});  // plugged in again: nothing starts by itself
  EXPECT_EQ(choice.chosen(), nullptr);

  SourceChoice simulated;
  simulated.offer({kSimulator, kVideo});
  simulated.offer({kVideo});
  EXPECT_EQ(simulated.chosen(), nullptr);
}

TEST(SourceChoice, SaysThatThereIsNone) {
  SourceChoice choice;
  choice.offer({});
  EXPECT_EQ(choice.chosen(), nullptr);
  EXPECT_NE(choice.problem().find("connect a camera"), std::string::npos);
  choice.choose_next();
  EXPECT_EQ(choice.chosen(), nullptr);
  choice.offer({kCamera});
  choice.choose_next();
  EXPECT_EQ(chosen(choice), "HD camera");
}

}  // namespace
}  // namespace arthronaut::setup
