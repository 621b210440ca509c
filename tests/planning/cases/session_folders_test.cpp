// Hazard 16: which session is the newest is told by its number, whatever the clock says.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "planning/cases/case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

namespace fs = std::filesystem;

class SessionFolders : public ::testing::Test {
 protected:
  void add(const std::string& name) const { fs::create_directories(temporary_ / "sessions" / name); }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& folder : session_folders(temporary_.path())) names.push_back(folder.filename());
    return names;
  }
  test::TemporaryFolder temporary_;
};

TEST_F(SessionFolders, Hazard16TheNewestIsTheLargestNumberNotTheClock) {
  add("0002-20261122-103000");
  add("0003-20200101-000000");  // the machine's clock had been reset
  add("0001-20261122-110000");
  EXPECT_EQ(names(), (std::vector<std::string>{"0001-20261122-110000", "0002-20261122-103000",
                                               "0003-20200101-000000"}));
  const auto next = create_session_folder(temporary_.path());
  EXPECT_EQ(session_number(next), 4);
  EXPECT_EQ(session_folders(temporary_.path()).back(), next);
}

// Sessions of older versions have no number: they are older than all that have one, and among each other the
// clock is all there is.
TEST_F(SessionFolders, Hazard16SessionsWithoutANumberAreOlder) {
  for (const char* name : {"20261122-103000", "0001-20200101-000000", "20261122-103000-001", "by hand"})
    add(name);
  EXPECT_EQ(names(), (std::vector<std::string>{"20261122-103000", "20261122-103000-001", "by hand",
                                               "0001-20200101-000000"}));
  EXPECT_EQ(session_number(create_session_folder(temporary_.path())), 2);
}

TEST_F(SessionFolders, NumbersGoOnAboveFourDigits) {
  add("9999-20260131-120000");
  EXPECT_EQ(create_session_folder(temporary_.path()).filename().string().substr(0, 6), "10000-");
  EXPECT_EQ(session_number(create_session_folder(temporary_.path())), 10001);
}

TEST_F(SessionFolders, ReadsNumbersOnlyWhereTheyAre) {
  EXPECT_EQ(session_number("sessions/0007-20261122-103000"), 7);
  EXPECT_EQ(session_number("20261122-103000"), 0);
  EXPECT_EQ(session_number("20261122-103000-007"), 0);
  EXPECT_EQ(session_number("-20261122-103000"), 0);
  EXPECT_EQ(session_number("7"), 0);
  EXPECT_EQ(session_number(""), 0);
  EXPECT_EQ(session_number("99999999999999999999-20261122-103000"), 0);
}

// A session that was deleted does not give its place to one that is older than the rest.
TEST_F(SessionFolders, Hazard16NumbersOfAGapAreNotTakenAgain) {
  for (int i = 0; i < 3; ++i) (void)create_session_folder(temporary_.path());
  fs::remove_all(session_folders(temporary_.path())[1]);
  EXPECT_EQ(session_number(create_session_folder(temporary_.path())), 4);
}

// Two processes that begin sessions at the same moment.
TEST_F(SessionFolders, Hazard16TwoProcessesNeverShareANumber) {
  constexpr int kEach = 25;
  for (int child = 0; child < 2; ++child) {
    if (::fork() != 0) continue;
    for (int i = 0; i < kEach; ++i) (void)create_session_folder(temporary_.path());
    ::_exit(0);
  }
  for (int child = 0; child < 2; ++child) {
    int status = 1;
    ::wait(&status);
    EXPECT_EQ(status, 0);
  }
  std::set<std::int64_t> numbers;
  for (const auto& folder : session_folders(temporary_.path())) numbers.insert(session_number(folder));
  EXPECT_EQ(numbers.size(), 2U * kEach);
  EXPECT_EQ(*numbers.rbegin(), 2 * kEach);
}

}  // namespace
}  // namespace arthronaut::cases
