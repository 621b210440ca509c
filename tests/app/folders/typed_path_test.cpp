#include "app/folders/typed_path.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::folders {
namespace {

namespace fs = std::filesystem;

class TypedPathTest : public ::testing::Test {
 protected:
  TypedPathTest() {
    fs::create_directories(folder_ / "images" / "knee right");
    fs::create_directories(folder_ / "images" / "knee left");
    fs::create_directories(folder_ / ".hidden");
    std::ofstream(folder_ / "imagine.stl") << "solid";
  }
  [[nodiscard]] std::string completed(const std::string& text) const {
    return completed_path(text, folder_.path());
  }
  const test::TemporaryFolder folder_;
};

TEST_F(TypedPathTest, IsTakenFromWhereOneLooks) {
  EXPECT_EQ(typed_path("images/knee left", folder_.path()).path, folder_ / "images/knee left");
  EXPECT_EQ(typed_path("images/knee left", folder_.path()).problem, "");
  const std::string whole = (folder_ / "imagine.stl").string();
  for (const std::string& text : {whole, "  " + whole + "\n", "\"" + whole + "\"", "file://" + whole})
    EXPECT_EQ(typed_path(text, "/").path, whole) << text;
  EXPECT_EQ(typed_path("file://" + (folder_ / "images/knee%20left").string(), "/").path,
            folder_ / "images/knee left");
  EXPECT_EQ(typed_path("images/../imagine.stl", folder_.path()).path, whole);
  ::setenv("HOME", folder_.path().c_str(), 1);
  EXPECT_EQ(typed_path("~/images", "/").path, folder_ / "images");
}

// What is not there is said with how far it is: a slip in the middle of a long path is found.
TEST_F(TypedPathTest, WhatIsNotThereIsSaidWithHowFarItIs) {
  const TypedPath typed = typed_path("images/shoulder/left", folder_.path());
  EXPECT_EQ(typed.problem, "There is no " + (folder_ / "images/shoulder/left").string() + ". As far as " +
                               (folder_ / "images").string() + " it is there");
  EXPECT_NE(typed_path("  ", folder_.path()).problem, "");
}

TEST_F(TypedPathTest, IsCompletedAsFarAsTheNamesAgree) {
  EXPECT_EQ(completed("im"), "imag");
  EXPECT_EQ(completed("imagi"), "imagine.stl");
  EXPECT_EQ(completed("image"), "images/");
  EXPECT_EQ(completed("images/"), "images/knee ");
  EXPECT_EQ(completed("images/knee l"), "images/knee left/");
  EXPECT_EQ(completed("x"), "x");
  EXPECT_EQ(completed("none/x"), "none/x");
  EXPECT_EQ(completed(".h"), ".hidden/");
  EXPECT_EQ(completed((folder_ / "imagi").string()), (folder_ / "imagine.stl").string());
  EXPECT_EQ(completed("~"), "~/");
  // Both letters begin with the same byte.
  std::ofstream(folder_ / "Knie_\u00E4rztlich") << "a";
  std::ofstream(folder_ / "Knie_\u00F6stlich") << "b";
  EXPECT_EQ(completed("K"), "Knie_");
}

}  // namespace
}  // namespace arthronaut::folders
