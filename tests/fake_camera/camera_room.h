// A room with cameras that are none (fake_camera.h), for as long as this lives: for this program, and for
// those that are started with environment().
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/fake_camera/fake_camera.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

// As a driver would write the picture in this format (V4L2_PIX_FMT_...): luma 16 to 235 by BT.601
// (0 to 255 where it is grey).
[[nodiscard]] std::vector<std::uint8_t> packed(std::uint32_t fourcc, const cv::Mat& bgr);

class CameraRoom {
 public:
  // Sets the variable by which this program finds the cameras. One at a time.
  CameraRoom();
  ~CameraRoom();
  CameraRoom(const CameraRoom&) = delete;
  CameraRoom& operator=(const CameraRoom&) = delete;

  [[nodiscard]] FakeCamera& camera(int index = 0) { return cameras_->cameras[index]; }
  // Gives these pictures over and over, of one size, at these rates.
  FakeMode& add_mode(int camera, std::uint32_t fourcc, const std::vector<cv::Mat>& bgr,
                     const std::vector<std::uint32_t>& rates);
  // The same, of pictures as they are.
  FakeMode& add_mode(int camera, std::uint32_t fourcc, cv::Size size,
                     const std::vector<std::vector<std::uint8_t>>& pictures,
                     const std::vector<std::uint32_t>& rates);
  void plug(int camera = 0);
  void unplug(int camera = 0);
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "cameras"; }

 private:
  TemporaryFolder folder_;
  FakeCameras* cameras_ = nullptr;
};

}  // namespace arthronaut::test
