// What a killed program leaves behind.
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <random>

#include "navigation/recording/resumable.h"
#include "planning/cases/case.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

using Clock = std::chrono::steady_clock;

const experiments::Trial& trial() {
  static const experiments::Trial trial = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  return trial;
}

// Made once, before the children are: its surface takes longer than anything that is timed here.
const operation::OperationSetup& setup() {
  static const operation::OperationSetup setup = test::phantom_setup();
  return setup;
}

// What the hand does as its number i: each number gives another command.
operation::Command command(int i) {
  static const registration::Provenance of = operation::provenance_of(setup(), test::plain_source(1).setup);
  operation::GiveRegistration give = test::true_registration(trial(), of);
  give.registration.marker_from_bone.translation_mm.x() += 0.01 * i;
  operation::PlannedTunnel plan = test::phantom_plan();
  plan.length_mm += i;
  switch (i % 5) {
    case 0:
      return operation::ReadDepthStop{1.0 * i};
    case 1:
      return give;
    case 2:
      return operation::OfferPlan{plan};
    case 3:
      return operation::TakePlanOver{};
    default:
      if (i % 35 == 34) return operation::MarkerPlacedAnew{};
      return operation::ReadDepthStop{0.5 + i};
  }
}

// In a child: an operation at 60 frames a second that gives a command every third frame, and writes to the
// pipe, after each, how many there were.
[[noreturn]] void operate(const std::filesystem::path& case_folder, int pipe) {
  OperationRun run(setup(), test::at_once(setup()),
                   [&] { return cases::create_session_folder(case_folder); });
  run.start(test::plain_source(100'000, false, sources::SourceKind::Recording, 60));
  for (std::int32_t i = 0;; ++i) {
    (void)run.step();
    if (i % 3 != 0) continue;
    run.apply(command(i / 3));
    const std::int32_t count = i / 3 + 1;
    if (::write(pipe, &count, sizeof count) != static_cast<ssize_t>(sizeof count)) ::_exit(1);
  }
}

// How many commands had been given a second before the child was killed, and in all.
struct Killed {
  std::int32_t a_second_before = 0, at_the_end = 0;
};

class Child {
 public:
  Child(const std::filesystem::path& case_folder, double after_s) : after_s_(after_s) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) operate(case_folder, ends[1]);
    ::close(ends[1]);
    pipe_ = ends[0];
  }
  ~Child() {
    if (process_ > 0) kill();
    ::close(pipe_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] int pipe() const { return pipe_; }
  [[nodiscard]] bool is_alive() const { return process_ > 0; }
  // A command was given. The clock starts with the first: getting ready takes as long as it takes.
  void read_one() {
    std::int32_t count = 0;
    if (::read(pipe_, &count, sizeof count) != static_cast<ssize_t>(sizeof count))
      return kill();  // it has ended, which the test sees by its few commands
    given_.push_back(Clock::now());
  }
  [[nodiscard]] bool is_due() const {
    return !given_.empty() &&
           std::chrono::duration<double>(Clock::now() - given_.front()).count() >= after_s_;
  }
  void kill() {
    ::kill(process_, SIGKILL);
    end_ = Clock::now();
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
    // What it said and nobody had read yet was given too.
    std::int32_t count = 0;
    while (::read(pipe_, &count, sizeof count) == static_cast<ssize_t>(sizeof count)) given_.push_back(end_);
  }
  [[nodiscard]] Killed killed() const {
    Killed killed;
    killed.at_the_end = static_cast<std::int32_t>(given_.size());
    for (const Clock::time_point time : given_)
      killed.a_second_before += std::chrono::duration<double>(end_ - time).count() > 1 ? 1 : 0;
    return killed;
  }

 private:
  double after_s_;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::vector<Clock::time_point> given_;
  Clock::time_point end_;
};

void run_and_kill_all(std::vector<std::unique_ptr<Child>>& children) {
  const auto is_any_alive = [&] {
    return std::any_of(children.begin(), children.end(), [](const auto& child) { return child->is_alive(); });
  };
  while (is_any_alive()) {
    std::vector<pollfd> waiting;
    for (const auto& child : children) waiting.push_back({child->is_alive() ? child->pipe() : -1, POLLIN, 0});
    (void)::poll(waiting.data(), waiting.size(), 10);
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (waiting[i].revents != 0) children[i]->read_one();
      if (children[i]->is_alive() && children[i]->is_due()) children[i]->kill();
    }
  }
}

// How many commands the record holds: the first of them, in order and to the last bit.
std::int32_t commands_of(const recording::RecordedSession& session) {
  std::int32_t kept = 0;
  for (const recording::SessionEvent& event : session.events()) {
    if (event.kind != recording::kCommandEvent) continue;
    EXPECT_EQ(event.text, operation::to_text(command(kept)));
    ++kept;
  }
  return kept;
}

// What an operation that was given these commands and no more has come to.
operation::OperationStatePtr state_after(std::int32_t count) {
  OperationRun run(setup(), test::at_once(setup()), {});
  run.start(test::plain_source(1));
  for (std::int32_t i = 0; i < count; ++i) run.apply(command(i));
  return run.state();
}

// Killed at 40 seeded moments of a running operation: the record opens, says that it was cut off, and holds
// every command but those of the last second; what "Resume" offers is the state that those commands lead to.
TEST(KilledRecord, HoldsEveryCommandButThoseOfTheLastSecond) {
  constexpr int kAtOnce = 8, kRounds = 5;
  (void)command(0);  // what it rests on is made, before the children are
  std::mt19937 random(11);
  int with_registration = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::unique_ptr<test::TemporaryFolder>> folders;
    std::vector<std::unique_ptr<Child>> children;
    for (int i = 0; i < kAtOnce; ++i) {
      folders.push_back(std::make_unique<test::TemporaryFolder>());
      children.push_back(
          std::make_unique<Child>(folders.back()->path(), std::uniform_real_distribution(1.2, 4.0)(random)));
    }
    run_and_kill_all(children);
    for (int i = 0; i < kAtOnce; ++i) {
      SCOPED_TRACE("round " + std::to_string(round) + ", child " + std::to_string(i));
      const auto at = static_cast<std::size_t>(i);
      const Killed killed = children[at]->killed();
      ASSERT_GT(killed.at_the_end, 3);
      const recording::RecordedSession session(cases::session_folders(folders[at]->path()).back());
      EXPECT_FALSE(session.was_finished());
      EXPECT_FALSE(session.frames().empty());
      const std::int32_t kept = commands_of(session);
      EXPECT_GE(kept, killed.a_second_before);
      EXPECT_LE(kept, killed.at_the_end + 1) << "the last one may have been given while the signal came";

      const auto left =
          recording::find_resumable(folders[at]->path(), bones::BoneKind::Femur, "the phantom's", {}).left;
      const operation::OperationStatePtr expected = state_after(kept);
      // On a busy machine all that one was given may lie in its last second, and nothing had come of it yet.
      ASSERT_EQ(left.has_value(), expected->depth_stop_mm.has_value() ||
                                      expected->registration->in_force.registration != nullptr)
          << kept << " commands kept";
      if (!left) continue;
      EXPECT_FALSE(left->was_finished);
      EXPECT_EQ(left->operation.session, session.header().id);
      EXPECT_EQ(left->operation.plan, expected->plan);
      EXPECT_EQ(left->operation.depth_stop_mm, expected->depth_stop_mm);
      const operation::RegistrationPtr& in_force = expected->registration->in_force.registration;
      ASSERT_EQ(left->operation.registration.has_value(), in_force != nullptr) << left->refusal;
      if (in_force == nullptr) continue;
      ++with_registration;
      EXPECT_EQ(left->operation.registration->marker_from_bone.translation_mm,
                in_force->marker_from_bone.translation_mm);
    }
  }
  EXPECT_GT(with_registration, 20);
}

}  // namespace
}  // namespace arthronaut::theatre
