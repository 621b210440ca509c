#include "navigation/sources/device_identity.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

std::optional<DeviceSays> card_at(const std::string& bus) {
  return DeviceSays{"uvcvideo", "Capture card", bus};
}

// With a number of its own it is the same one in every socket; without, only where it was.
TEST(DeviceIdentity, IsTheCamerasOwnWhereItHasANumber) {
  const test::TemporaryFolder temporary;
  const auto interface = temporary.path() / "usb1" / "interface0",
             entry = temporary.path() / "names" / "video2";
  std::filesystem::create_directories(interface);
  std::filesystem::create_directories(entry);
  std::filesystem::create_directory_symlink(interface, entry / "device");
  const auto at = [&](const std::string& bus) {
    return device_identity("/dev/video2", temporary.path() / "names",
                           [&](const auto&) { return card_at(bus); });
  };
  EXPECT_EQ(at("usb-1"), "uvcvideo, Capture card, at usb-1");
  EXPECT_NE(at("usb-1"), at("usb-2"));
  std::ofstream(temporary.path() / "usb1" / "serial") << "A17\n";
  EXPECT_EQ(at("usb-1"), "uvcvideo, Capture card, serial A17");
  EXPECT_EQ(at("usb-1"), at("usb-2"));
}

// What is no camera, or is not there, says nothing.
TEST(DeviceIdentity, IsEmptyWhereNobodyAnswers) {
  const test::TemporaryFolder temporary;
  std::ofstream(temporary.path() / "video0") << "no device";
  EXPECT_EQ(device_identity(temporary.path() / "video0"), "");
  EXPECT_EQ(device_identity(temporary.path() / "video1"), "");
}

}  // namespace
}  // namespace arthronaut::sources
