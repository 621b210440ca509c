// A process that is killed while it saves: whatever the moment, what it saved last is there.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "planning/cases/case.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using bones::BoneKind;

Plan plan_numbered(int number) {
  return {
      .tunnels = {{BoneKind::Femur, {.entry_mm = {static_cast<double>(number), 0, 0}, .diameter_mm = 9}}}};
}
int number_of(const Plan& plan) { return static_cast<int>(plan.tunnels.at(BoneKind::Femur).entry_mm.x()); }

Case case_numbered(int number) {
  Case knee;
  knee.name = std::to_string(number);
  knee.plan = plan_numbered(number);
  auto mesh = test::ellipsoid({40, 30, 50}, 3);
  mesh.vertices_mm[0].x() = number;
  knee.bones[BoneKind::Femur] = {.kind = BoneKind::Femur, .mesh = std::move(mesh), .source = "made"};
  return knee;
}

// Runs `save(n)` for n = first, first + 1, ... in a child, kills it after the delay, and returns the last n
// whose save had returned (first - 1: none).
template <typename Save>
int killed_while_saving(int first, std::chrono::microseconds delay, const Save& save) {
  int pipe_ends[2];
  if (::pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    for (int n = first;; ++n) {
      save(n);
      if (::write(pipe_ends[1], &n, sizeof n) != sizeof n) ::_exit(1);
    }
  }
  ::close(pipe_ends[1]);
  std::this_thread::sleep_for(delay);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
  int saved = first - 1, n = 0;
  while (::read(pipe_ends[0], &n, sizeof n) == sizeof n) saved = n;
  ::close(pipe_ends[0]);
  return saved;
}

// The plan is saved after every step of planning. At most the save under way when the process died may count
// as well.
TEST(CaseAfterKill, HoldsTheLastSavedPlan) {
  const test::TemporaryFolder temporary;
  const auto folder = temporary / "Knee.arthro";
  save_case(folder, case_numbered(0));
  std::mt19937 random(20260101);
  std::uniform_int_distribution<int> delay_us(0, 40000);
  int saved = 0;
  for (int i = 0; i < 40; ++i) {
    saved = killed_while_saving(saved + 1, std::chrono::microseconds(delay_us(random)),
                                [&](int n) { save_plan(folder, plan_numbered(n)); });
    const int found = number_of(load_case(folder).plan);
    EXPECT_GE(found, saved);
    EXPECT_LE(found, saved + 1);
    saved = found;
  }
  EXPECT_GT(saved, 40) << "the child hardly ever came to save";
}

// A whole case is three files; each is the last one saved or the one under way, and the case always opens.
TEST(CaseAfterKill, OpensAfterWholeCasesWereSaved) {
  const test::TemporaryFolder temporary;
  const auto folder = temporary / "Knee.arthro";
  save_case(folder, case_numbered(0));
  std::mt19937 random(20260102);
  std::uniform_int_distribution<int> delay_us(0, 60000);
  int saved = 0;
  for (int i = 0; i < 30; ++i) {
    saved = killed_while_saving(saved + 1, std::chrono::microseconds(delay_us(random)),
                                [&](int n) { save_case(folder, case_numbered(n)); });
    const Case found = load_case(folder);
    for (const int number : {std::stoi(found.name), number_of(found.plan),
                             static_cast<int>(found.bones.at(BoneKind::Femur).mesh.vertices_mm[0].x())}) {
      EXPECT_GE(number, saved);
      EXPECT_LE(number, saved + 1);
    }
    saved = std::stoi(found.name);
  }
  EXPECT_GT(saved, 10);
}

}  // namespace
}  // namespace arthronaut::cases
