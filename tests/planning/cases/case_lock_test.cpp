#include "planning/cases/case_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A child process that runs `work`, says what it returned, and then waits for its end.
class OtherProcess {
 public:
  explicit OtherProcess(const std::function<bool()>& work) {
    std::array<int, 2> pipe_ends{};
    if (::pipe(pipe_ends.data()) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) {
      ::close(pipe_ends[0]);
      // The objects of `work` live on while the child waits for its end.
      const char answer = work() ? '1' : '0';
      if (::write(pipe_ends[1], &answer, 1) != 1) ::_exit(1);
      for (;;) ::pause();
    }
    ::close(pipe_ends[1]);
    char answer = '?';
    if (::read(pipe_ends[0], &answer, 1) == 1) result_ = answer == '1';
    ::close(pipe_ends[0]);
  }
  ~OtherProcess() {
    if (process_ > 0) kill_hard();
  }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;
  [[nodiscard]] bool result() const { return result_; }
  [[nodiscard]] pid_t id() const { return process_; }
  // kill -9. Until it is buried the process is still in the system's list.
  void kill_hard(bool bury = true) {
    ::kill(process_, SIGKILL);
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOWAIT);
    if (bury) this->bury();
  }
  void bury() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
  }

 private:
  pid_t process_ = -1;
  bool result_ = false;
};

class CaseLockTest : public ::testing::Test {
 protected:
  void SetUp() override {
    save_case(folder_,
              {.name = "Knee",
               .created_utc = "",
               .bones = {{bones::BoneKind::Femur, {.mesh = test::box({40, 30, 50}), .source = "made"}}},
               .landmarks = {},
               .plan = {}});
  }
  // Takes the case for as long as the process lives.
  [[nodiscard]] std::function<bool()> taking() const {
    return [folder = folder_] {
      static CaseLock lock;
      lock = CaseLock(folder);
      return lock.is_held();
    };
  }
  void write_lock(const std::string& host, long process, const std::string& start) const {
    const nlohmann::ordered_json json = {{"format", "arthronaut.lock"},
                                         {"version", 1},
                                         {"host", host},
                                         {"process", process},
                                         {"process_start", start},
                                         {"user", "anna"},
                                         {"since_utc", "2026-01-31T12:00:00Z"}};
    files::write_atomically(lock_file(folder_), json.dump());
  }
  static std::string this_host() {
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    return name.data();
  }

  test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_ / "Knee.arthro";
};

TEST_F(CaseLockTest, IsHeldByOneAndLetGo) {
  {
    CaseLock lock(folder_);
    EXPECT_TRUE(lock.is_held());
    EXPECT_THAT(lock.refusal(), IsEmpty());
    EXPECT_THAT(lock.notice(), IsEmpty());
    const auto json = nlohmann::json::parse(files::read_text(lock_file(folder_)));
    EXPECT_EQ(json.at("host"), this_host());
    EXPECT_EQ(json.at("process"), ::getpid());
    EXPECT_FALSE(CaseLock(folder_).is_held());
    const CaseLock moved = std::move(lock);
    EXPECT_TRUE(moved.is_held());
    EXPECT_FALSE(CaseLock(folder_).is_held());
  }
  EXPECT_FALSE(std::filesystem::exists(lock_file(folder_)));
  EXPECT_TRUE(CaseLock(folder_).is_held());
}

// Hazard 15: two programs on one case. The second is told who has it, and since when.
TEST_F(CaseLockTest, Hazard15SecondProcessIsRefusedAndToldWhoHolds) {
  const OtherProcess other(taking());
  ASSERT_TRUE(other.result());
  const CaseLock lock(folder_);
  EXPECT_FALSE(lock.is_held());
  EXPECT_THAT(lock.refusal(), HasSubstr("process " + std::to_string(other.id())));
  EXPECT_THAT(lock.refusal(), HasSubstr(this_host()));
  EXPECT_THAT(lock.refusal(), HasSubstr("since 20"));
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)lock_or_refuse(folder_); }),
              HasSubstr("process " + std::to_string(other.id())));
}

// kill -9 leaves the file behind, and no case that cannot be used: neither while the dead process is still in
// the system's list nor after.
TEST_F(CaseLockTest, Hazard15CaseOfAKilledProcessIsTakenOverAndSaid) {
  for (const bool is_buried : {false, true}) {
    OtherProcess other(taking());
    ASSERT_TRUE(other.result());
    const auto id = other.id();
    other.kill_hard(is_buried);
    ASSERT_TRUE(std::filesystem::exists(lock_file(folder_)));
    {
      const CaseLock lock(folder_);
      EXPECT_TRUE(lock.is_held()) << lock.refusal();
      EXPECT_THAT(lock.notice(), HasSubstr("Taken over"));
      EXPECT_THAT(lock.notice(), HasSubstr("process " + std::to_string(id)));
    }
    if (!is_buried) other.bury();
  }
}

// Many programs find the same dead lock at the same moment: one gets the case.
TEST_F(CaseLockTest, Hazard15OneOfManyTakesADeadLockOver) {
  {
    OtherProcess dead(taking());
    ASSERT_TRUE(dead.result());
  }
  for (int round = 0; round < 5; ++round) {
    std::vector<std::unique_ptr<OtherProcess>> others(6);
    std::vector<std::thread> starts;
    starts.reserve(others.size());
    for (auto& other : others) starts.emplace_back([&] { other = std::make_unique<OtherProcess>(taking()); });
    for (auto& start : starts) start.join();
    EXPECT_EQ(std::count_if(others.begin(), others.end(), [](const auto& other) { return other->result(); }),
              1);
  }
}

// From now on the kernel locks no folders for this process and its children, as on some network file systems.
bool take_folder_locks_away() {
  std::array<sock_filter, 4> refuse_flock{
      sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_flock, 0, 1),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOLCK),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  const sock_fprog program{refuse_flock.size(), refuse_flock.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

// Where the kernel locks no folders, of many programs that come at once one gets the case, a dead lock in it
// or none.
TEST_F(CaseLockTest, Hazard15OneOfManyGetsInWithoutTheKernelsLocks) {
  const OtherProcess trial(take_folder_locks_away);
  if (!trial.result()) GTEST_SKIP() << "no system call can be refused here";
  const auto taking_without = [taking = taking()] { return take_folder_locks_away() && taking(); };
  for (int round = 0; round < 20; ++round) {
    std::filesystem::remove(lock_file(folder_));
    if (round % 2 == 1) write_lock(this_host(), ::getppid(), "1@an earlier start of the machine");
    std::vector<std::unique_ptr<OtherProcess>> others(6);
    std::vector<std::thread> starts;
    starts.reserve(others.size());
    for (auto& other : others)
      starts.emplace_back([&] { other = std::make_unique<OtherProcess>(taking_without); });
    for (auto& start : starts) start.join();
    EXPECT_EQ(std::count_if(others.begin(), others.end(), [](const auto& other) { return other->result(); }),
              1)
        << round;
  }
}

// Somebody is taking it at this moment: nobody else looks at the lock and writes it.
TEST_F(CaseLockTest, Hazard15WithoutTheKernelsLocksOneTakesTheCaseAtATime) {
  files::write_atomically(folder_ / "case.lock.taking", std::string_view());
  const OtherProcess other([folder = folder_] {
    if (!take_folder_locks_away()) return true;
    const CaseLock lock(folder);
    return !lock.is_held() && lock.refusal().find("case.lock.taking") != std::string::npos;
  });
  EXPECT_TRUE(other.result());
  EXPECT_TRUE(CaseLock(folder_).is_held()) << "with the kernel's locks it is nobody's business";
}

// The number of a dead process comes again: its start tells the two apart.
TEST_F(CaseLockTest, Hazard15ALaterProcessOfTheSameNumberDoesNotHold) {
  write_lock(this_host(), ::getppid(), "1@an earlier start of the machine");
  EXPECT_TRUE(CaseLock(folder_).is_held());
}

// Where the kernel's lock does not reach (a network folder) the living process named in the file counts.
TEST_F(CaseLockTest, Hazard15ALivingProcessOfThisHostHolds) {
  write_lock(this_host(), ::getppid(), "");
  EXPECT_FALSE(CaseLock(folder_).is_held());
}

// A case that is copied while it is open brings the lock of the original along.
TEST_F(CaseLockTest, ACopyOfAnOpenCaseIsFree) {
  const OtherProcess other(taking());
  ASSERT_TRUE(other.result());
  const std::filesystem::path copy = temporary_ / "Copy.arthro";
  std::filesystem::copy(folder_, copy, std::filesystem::copy_options::recursive);
  {
    const CaseLock lock(copy);
    EXPECT_TRUE(lock.is_held()) << lock.refusal();
    EXPECT_THAT(lock.notice(), HasSubstr("copy of a case that was open"));
    EXPECT_THAT(lock.dead_since_utc(), IsEmpty());
  }
  EXPECT_FALSE(CaseLock(folder_).is_held()) << "the original is the other program's";
}

// Nobody here can know whether a process of another machine lives: it is said what to do.
TEST_F(CaseLockTest, Hazard15AnotherMachinesLockIsNeverTakenOver) {
  write_lock("theatre-2", 4711, "");
  {
    const CaseLock lock(folder_);
    EXPECT_FALSE(lock.is_held());
    EXPECT_THAT(lock.refusal(), HasSubstr("anna on theatre-2 (process 4711) since 2026-01-31 12:00:00"));
    EXPECT_THAT(lock.refusal(), HasSubstr("arthronaut cases --take-over"));
  }
  EXPECT_TRUE(std::filesystem::exists(lock_file(folder_)));
  std::filesystem::remove(lock_file(folder_));
  EXPECT_TRUE(CaseLock(folder_).is_held());
}

// A case that was copied from a machine on which it was open, or whose machine died, is taken over where
// somebody says so; never one that a living process of this machine has, nor one that the kernel knows to be
// held.
TEST_F(CaseLockTest, Hazard15AnotherMachinesLockIsTakenOverWhereSomebodySaysSo) {
  write_lock("theatre-2", 4711, "");
  EXPECT_TRUE(CaseLock(folder_).is_of_other_host());
  {
    const CaseLock lock(folder_, LockTaking::FromOtherHost);
    ASSERT_TRUE(lock.is_held()) << lock.refusal();
    EXPECT_FALSE(lock.is_of_other_host());
    EXPECT_THAT(lock.notice(), HasSubstr("Taken over from anna on theatre-2 (process 4711)"));
    EXPECT_FALSE(CaseLock(folder_, LockTaking::FromOtherHost).is_held()) << "it is ours now";
  }
  EXPECT_TRUE(CaseLock(folder_).is_held());
  write_lock(this_host(), ::getppid(), "");
  EXPECT_FALSE(CaseLock(folder_, LockTaking::FromOtherHost).is_held());
  EXPECT_FALSE(CaseLock(folder_).is_of_other_host());
  std::filesystem::remove(lock_file(folder_));
  const OtherProcess other(taking());
  ASSERT_TRUE(other.result());
  EXPECT_FALSE(CaseLock(folder_, LockTaking::FromOtherHost).is_held());
}

TEST_F(CaseLockTest, ABrokenFileDoesNotLockForEver) {
  files::write_atomically(lock_file(folder_), std::string_view("{\"format\": \"artho"));
  EXPECT_TRUE(CaseLock(folder_).is_held());
}

// A program that forks (for an import, say) does not lose its case when the child ends.
TEST_F(CaseLockTest, AChildsEndDoesNotLetGo) {
  const CaseLock lock(folder_);
  const pid_t child = ::fork();
  if (child == 0) {
    { CaseLock copy = std::move(const_cast<CaseLock&>(lock)); }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(std::filesystem::exists(lock_file(folder_)));
  EXPECT_FALSE(CaseLock(folder_).is_held());
}

// A case on a medium that can only be read, or of another user, is read-only, with that as the reason.
TEST_F(CaseLockTest, AFolderThatCannotBeWrittenIsRefusedWithTheReason) {
  constexpr uid_t kNobody = 65534;
  const auto readable = temporary_ / "readable";
  std::filesystem::create_directory(readable);
  std::filesystem::permissions(readable, std::filesystem::perms{0555});
  const OtherProcess other([&] {
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) return false;
    const CaseLock lock(readable);
    return !lock.is_held() && lock.refusal().find("cannot be written") != std::string::npos;
  });
  EXPECT_TRUE(other.result());
}

}  // namespace
}  // namespace arthronaut::cases
