#include "navigation/theatre/operation_log.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "planning/log/log.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

long count_of(const std::string& text, const std::string& words) {
  long count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

// Of two tunnels in a bone the log says which one guides; a bone's single tunnel goes without a name.
TEST(OperationLog, Hazard38NamesTheTunnelOfABundle) {
  operation::JournalEntry entry;
  entry.kind = operation::JournalKind::Plan;
  entry.plan = test::phantom_plan();
  EXPECT_EQ(line_of(entry), "plan in force: 9.0 mm wide, 30.0 mm long");
  entry.plan->tunnel.bundle = norms::Bundle::Anteromedial;
  EXPECT_EQ(line_of(entry), "plan in force: femur AM: 9.0 mm wide, 30.0 mm long");
}

// The log tells each registration that takes effect, what makes it void and what confirms it, sources, the
// plan and what was skipped: once each, however many frames come.
TEST(OperationLog, TellsChangesAndNoFrames) {
  const test::TemporaryFolder folder;
  log::open(folder / "run.log", log::Level::Info);
  {
    const operation::OperationSetup setup = test::phantom_setup();
    OperationRun run(setup, test::at_once(setup), {});
    const TheatreSource source = test::plain_source(200);
    run.start(source);
    const auto trial = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
    operation::GiveRegistration give =
        test::true_registration(trial, operation::provenance_of(setup, source.setup));
    for (int i = 0; i < 150; ++i) {
      ASSERT_TRUE(run.step().picture);
      if (i == 40) run.apply(give);
      if (i == 60) run.apply(operation::SkipVerification{});
      if (i == 80) {
        give.is_resumed = true;
        run.apply(give);
      }
      if (i == 100) run.apply(operation::MarkerPlacedAnew{});
    }
    run.end_source();
  }
  log::close();
  std::stringstream text;
  text << std::ifstream(folder / "run.log").rdbuf();
  const std::string lines = text.str();
  EXPECT_EQ(count_of(lines, "source started"), 1) << lines;
  EXPECT_EQ(count_of(lines, "source ended after frame 149"), 1);
  EXPECT_EQ(count_of(lines, "info"), count_of(lines, "\n") - count_of(lines, "warning"));
  EXPECT_EQ(count_of(lines, "registration in force after frame 40: reliable, +- 0.30 mm"), 1) << lines;
  EXPECT_EQ(count_of(lines, "verification skipped after frame 60: asked for"), 1);
  EXPECT_EQ(count_of(lines, "registration void after frame 80: the world marker may have been placed anew"),
            1);
  EXPECT_EQ(count_of(lines, "registration in force after frame 100: none"), 1) << lines;
  EXPECT_LT(count_of(lines, "\n"), 20) << "no line a frame";
}

}  // namespace
}  // namespace arthronaut::theatre
