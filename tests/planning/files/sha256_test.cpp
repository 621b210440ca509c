#include "planning/files/sha256.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::files {

namespace {

// FIPS 180-4's own examples.
TEST(Sha256, KnownDigests) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, PiecesCountAsOne) {
  Sha256 hash;
  for (const char letter : std::string("abc")) hash.add(std::as_bytes(std::span(&letter, 1)));
  EXPECT_EQ(hash.hex(), sha256_of("abc"));
}

TEST(Sha256, AFileIsItsBytes) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "bytes";
  const std::string bytes(200'001, 'x');
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(sha256_of_file(file), sha256_of(bytes));
  EXPECT_THROW((void)sha256_of_file(folder.path() / "absent"), IoError);
}

// One into which nobody writes would be waited for without end.
TEST(Sha256, APipeInAFilesPlaceIsRefusedByName) {
  const test::TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path() / "camera.json";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(test::message_of<IoError>([&] { (void)sha256_of_file(pipe); }),
            pipe.string() + ": is a pipe, not a file");
}

}  // namespace

}  // namespace arthronaut::files
