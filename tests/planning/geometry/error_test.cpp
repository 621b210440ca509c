#include "planning/geometry/error.h"

#include <gtest/gtest.h>

namespace arthronaut {
namespace {

TEST(Error, NamesTheFileThePlaceAndTheReason) {
  EXPECT_STREQ(InvalidInput("camera.json", "focal_px", "is missing").what(),
               "camera.json: focal_px: is missing");
  EXPECT_STREQ(InvalidInput("camera.json", "", "is empty").what(), "camera.json: is empty");
  EXPECT_STREQ(IoError("camera.json", "no such file").what(), "camera.json: no such file");
}

// What a message quotes is whatever stood in a file: a log takes a line, a terminal takes no commands.
TEST(Error, IsOneLineWhateverItQuotes) {
  const std::string quoted =
      "a\nb\r\tc\x1b[2J\x7f\xc2\x9b"
      "2J";
  const std::string shown = "a\\nb\\r\\tc\\x1b[2J\\x7f\\u009b2J";
  EXPECT_EQ(InvalidInput("is \"" + quoted + "\"").what(), "is \"" + shown + "\"");
  EXPECT_EQ(InvalidInput("file", quoted, quoted).what(), "file: " + shown + ": " + shown);
  EXPECT_EQ(IoError(quoted).what(), shown);
  EXPECT_EQ(IoError(quoted, "no such file").what(), shown + ": no such file");
  EXPECT_EQ(DeviceError(quoted).what(), shown);
}

TEST(Error, KeepsOtherScriptsAsTheyAre) { EXPECT_STREQ(InvalidInput("Müller: 膝").what(), "Müller: 膝"); }

}  // namespace
}  // namespace arthronaut
