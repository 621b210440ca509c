#include "planning/log/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::log {

namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class Log : public ::testing::Test {
 protected:
  ~Log() override { close(); }
  [[nodiscard]] std::vector<std::string> lines() const {
    std::ifstream stream(file_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "run.log";
};

TEST_F(Log, TakesNothingUntilItIsOpened) {
  error("before");
  EXPECT_FALSE(takes(Level::Error));
  open(file_, Level::Info);
  info("since");
  EXPECT_THAT(lines(), ElementsAre(EndsWith(" since")));
}

// Lines of the level and above; each is in the file as soon as it is written.
TEST_F(Log, KeepsLinesOfItsLevelAndAboveAtOnce) {
  open(file_, Level::Warning);
  info("not this");
  warning("this");
  EXPECT_THAT(lines(), ElementsAre(HasSubstr(" warning ")));
  error("and this");
  EXPECT_THAT(lines(), ElementsAre(EndsWith(" this"), EndsWith(" and this")));
}

// A run appends to what an earlier one left.
TEST_F(Log, AppendsAndMakesOneLineOfEach) {
  open(file_, Level::Info);
  info("first\nsecond half, {} and %s as they are");
  close();
  info("lost");
  open(file_, Level::Info);
  info("third");
  EXPECT_THAT(lines(), ElementsAre(EndsWith("first second half, {} and %s as they are"), EndsWith("third")));
}

TEST_F(Log, SaysThatItsFileCannotBeWritten) {
  EXPECT_THROW(open(folder_ / "none" / "run.log", Level::Info), IoError);
  EXPECT_THROW(open(folder_.path(), Level::Info), IoError);
  EXPECT_FALSE(takes(Level::Error));
}

// Lines hold names of folders, which may be those of patients.
TEST_F(Log, IsItsOwnersAlone) {
  open(file_, Level::Info);
  EXPECT_EQ(std::filesystem::status(file_).permissions(), std::filesystem::perms{0600});
}

// A full disk takes lines, not the program: nothing is thrown, nothing is said on standard error.
TEST_F(Log, GoesOnWithoutWhatTheDiskDoesNotTake) {
  open(file_, Level::Info);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{10, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  ::testing::internal::CaptureStderr();
  EXPECT_NO_THROW(info("more than ten bytes"));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Log, TakesWholeLinesFromManyThreads) {
  open(file_, Level::Info);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([] {
        for (int i = 0; i < 50; ++i) info("one line of many");
      });
  }
  EXPECT_EQ(lines().size(), 200u);
  EXPECT_THAT(lines(), ::testing::Each(EndsWith("one line of many")));
}

}  // namespace
}  // namespace arthronaut::log
