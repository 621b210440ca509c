// What a killed program leaves behind.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "navigation/recording/session.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

// In a child: an operation at 60 frames a second that gives a command every third frame, and writes to the
// pipe, after each, how many there were. The number stands for the depth that was read.
[[noreturn]] void operate(const std::filesystem::path& session, int pipe) {
  const operation::OperationSetup setup = test::phantom_setup();
  OperationRun run(setup, test::at_once(setup), [&] { return session; });
  run.start(test::plain_source(100'000, false, sources::SourceKind::Recording, 60));
  for (std::int32_t i = 0;; ++i) {
    (void)run.step();
    if (i % 3 != 0) continue;
    run.apply(operation::ReadDepthStop{i / 3 * 1.0});
    const std::int32_t count = i / 3 + 1;
    if (::write(pipe, &count, sizeof count) != static_cast<ssize_t>(sizeof count)) ::_exit(1);
  }
}

// How many commands had been given a second before the child was killed, and in all.
struct Killed {
  std::int32_t a_second_before = 0, at_the_end = 0;
};
Killed run_and_kill(const std::filesystem::path& session, double after_s) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) operate(session, ends[1]);
  ::close(ends[1]);
  using Clock = std::chrono::steady_clock;
  std::vector<Clock::time_point> given;
  std::int32_t count = 0;
  // The clock starts with the first command: getting ready takes as long as it takes.
  while (::read(ends[0], &count, sizeof count) == static_cast<ssize_t>(sizeof count)) {
    given.push_back(Clock::now());
    if (std::chrono::duration<double>(given.back() - given.front()).count() >= after_s) break;
  }
  ::kill(child, SIGKILL);
  const Clock::time_point end = Clock::now();
  int status = 0;
  ::waitpid(child, &status, 0);
  ::close(ends[0]);
  Killed killed;
  killed.at_the_end = static_cast<std::int32_t>(given.size());
  for (const Clock::time_point time : given)
    killed.a_second_before += std::chrono::duration<double>(end - time).count() > 1 ? 1 : 0;
  return killed;
}

// Killed at seeded moments: the record opens, says that it was cut off, and holds every command but those of
// the last second, in order and to the last bit.
TEST(KilledRecord, HoldsEveryCommandButThoseOfTheLastSecond) {
  (void)registration::phantom_bone();  // made once, before the children are
  std::mt19937 random(11);
  for (int i = 0; i < 6; ++i) {
    const test::TemporaryFolder folder;
    const std::filesystem::path session = folder / "session";
    std::filesystem::create_directory(session);
    const Killed killed = run_and_kill(session, std::uniform_real_distribution(1.2, 3.0)(random));
    ASSERT_GT(killed.at_the_end, 3);
    const recording::RecordedSession recorded(session);
    EXPECT_FALSE(recorded.was_finished());
    std::int32_t kept = 0;
    for (const recording::SessionEvent& event : recorded.events()) {
      if (event.kind != recording::kCommandEvent) continue;
      const auto command = operation::command_from_text(event.text, "session");
      const auto* stop = std::get_if<operation::ReadDepthStop>(&command);
      ASSERT_NE(stop, nullptr);
      EXPECT_EQ(stop->depth_mm, kept++);
    }
    EXPECT_GE(kept, killed.a_second_before);
    EXPECT_LE(kept, killed.at_the_end + 1) << "the last one may have been given while the signal came";
    EXPECT_FALSE(recorded.frames().empty());
  }
}

}  // namespace
}  // namespace arthronaut::theatre
