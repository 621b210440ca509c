#include "planning/files/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::files {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(AtomicFile, WritesReplacesAndReadsBack) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  write_atomically(folder / "x.bin", bytes);
  EXPECT_EQ(read_text(folder / "x.bin"), bytes);
  write_atomically(folder / "x.bin", "");
  EXPECT_EQ(read_text(folder / "x.bin"), "");
  EXPECT_EQ(folder.names().size(), 1U);
}

TEST(AtomicFile, MissingThingsAreIoErrorsThatNameTheFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<IoError>([&] { (void)read_text(folder / "absent"); }), HasSubstr("absent"));
  EXPECT_THAT(message_of<IoError>([&] { (void)read_text(folder.path()); }), HasSubstr("is a folder"));
  EXPECT_THAT(message_of<IoError>([&] { write_atomically(folder / "no" / "x", "1"); }),
              HasSubstr("does not exist"));
  // A folder of the target's name cannot be replaced, and nothing is left beside it.
  std::filesystem::create_directory(folder / "x");
  EXPECT_THAT(message_of<IoError>([&] { write_atomically(folder / "x", "1"); }), HasSubstr("cannot replace"));
  EXPECT_EQ(folder.names().size(), 1U);
}

// A disk or a share that fails while a file is read: no part of it passes for the whole. A program's memory
// can be opened and not be read at its beginning, as such a file.
TEST(AtomicFile, AReadThatFailsIsAnIoError) {
  EXPECT_THAT(message_of<IoError>([] { (void)read_text("/proc/self/mem"); }),
              HasSubstr("/proc/self/mem: cannot be read to its end"));
}

// One into which nobody writes would be waited for without end.
TEST(AtomicFile, APipeInAFilesPlaceIsAnIoError) {
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder / "curves.csv", link = folder / "link.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(pipe, link);
  EXPECT_THROW((void)read_text(pipe), IoError);
  EXPECT_THROW((void)read_text(link), IoError);
}

// What a shell puts in a file's place is read: somebody writes into it.
TEST(AtomicFile, AnOpenPipeUnderDevIsRead) {
  int ends[2] = {};
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], "text", 4), 4);
  ::close(ends[1]);
  EXPECT_EQ(read_text("/dev/fd/" + std::to_string(ends[0])), "text");
  ::close(ends[0]);
}

// /proc refuses new files even to root, as a folder without write permission does to everybody else.
// A path that leads nowhere is an error of that file too, not of the library that walks it.
TEST(AtomicFile, ALoopOfLinksIsAnIoError) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_THAT(message_of<IoError>([&] { (void)read_text(folder / "loop" / "x"); }), HasSubstr("loop"));
  EXPECT_THAT(message_of<IoError>([&] { write_atomically(folder / "loop" / "x", "text"); }),
              HasSubstr("loop"));
}

TEST(AtomicFile, AReadOnlyFolderIsAnIoErrorOfTheTarget) {
  EXPECT_THAT(message_of<IoError>([&] { write_atomically("/proc/case.json", "1"); }),
              AllOf(HasSubstr("/proc/case.json"), Not(HasSubstr(".partial"))));
  if (::geteuid() == 0) return;  // root writes into any folder
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THAT(message_of<IoError>([&] { write_atomically(folder / "x", "1"); }),
              HasSubstr("Permission denied"));
}

// A limit on the size of files ends a write half-way, as a full disk does.
TEST(AtomicFile, ADiskThatFillsUpLeavesTheOldContents) {
  const TemporaryFolder folder;
  write_atomically(folder / "plan.json", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_atomically(folder / "plan.json", std::string(100000, 'x'));
    } catch (const IoError& error) {
      const std::string message = error.what();
      const bool names_target =
          message.find("plan.json") != std::string::npos && message.find("partial") == std::string::npos;
      ::_exit(names_target ? 42 : 43);
    }
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 42);
  EXPECT_EQ(read_text(folder / "plan.json"), "old");
  EXPECT_EQ(folder.names().size(), 1U);
}

// The writer of a PDF or a mesh that fails: its exception passes, its half file goes.
TEST(AtomicFile, AWriterThatThrowsLeavesNothing) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_atomically(folder / "a.pdf",
                                [](const std::filesystem::path& temporary) {
                                  EXPECT_EQ(temporary.extension(), ".pdf");
                                  std::ofstream(temporary) << "half";
                                  throw InvalidInput("no");
                                }),
               InvalidInput);
  EXPECT_EQ(folder.names().size(), 0U);
  // A writer that writes nothing at all is an error of the target too.
  EXPECT_THAT(
      message_of<IoError>([&] { write_atomically(folder / "a.pdf", [](const std::filesystem::path&) {}); }),
      AllOf(HasSubstr("a.pdf"), Not(HasSubstr("partial"))));
}

// A PDF or a volume into a pipe: through it, which is a pipe afterwards, and nothing beside it.
TEST(AtomicFile, AWriterOfAFileWritesIntoAPipe) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "a.pdf").c_str(), 0600), 0);
  const int reader = ::open((folder / "a.pdf").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  write_atomically(folder / "a.pdf",
                   [](const std::filesystem::path& temporary) { std::ofstream(temporary) << "whole"; });
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "a.pdf"));
  std::array<char, 16> came{};
  EXPECT_EQ(::read(reader, came.data(), came.size()), 5);
  EXPECT_STREQ(came.data(), "whole");
  ::close(reader);
  EXPECT_EQ(folder.names().size(), 1U);
}

// kill -9 between write and rename, and at thirty other moments: the old or the new contents, never a
// mixture.
TEST(AtomicFile, AKilledWriterLeavesAWholeFile) {
  const TemporaryFolder folder;
  const std::string first(200000, 'a'), second(150000, 'b');
  for (int round = 0; round < 30; ++round) {
    write_atomically(folder / "case.json", first);
    const pid_t child = ::fork();
    if (child == 0) {
      for (;;) {
        write_atomically(folder / "case.json", second);
        write_atomically(folder / "case.json", first);
      }
    }
    ::usleep(static_cast<useconds_t>(500 + 400 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    const std::string found = read_text(folder / "case.json");
    EXPECT_TRUE(found == first || found == second) << "round " << round << ": " << found.size() << " bytes";
  }
  const pid_t child = ::fork();
  if (child == 0) {
    write_atomically(folder / "case.json", [](const std::filesystem::path& temporary) {
      std::ofstream(temporary) << "new";
      ::kill(::getpid(), SIGKILL);
    });
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  const std::string found = read_text(folder / "case.json");
  EXPECT_TRUE(found == first || found == second);
}

}  // namespace
}  // namespace arthronaut::files
