#include "tests/fake_camera/camera_room.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <new>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace arthronaut::test {

namespace {

using Bytes = std::vector<std::uint8_t>;

// Luma, and both colours of half the size, one plane after the other.
struct Planes {
  cv::Mat y, u, v;
};

Planes planes_of(const cv::Mat& bgr) {
  cv::Mat i420;
  cv::cvtColor(bgr, i420, cv::COLOR_BGR2YUV_I420);
  const cv::Mat rest = i420.rowRange(bgr.rows, i420.rows).clone().reshape(1, bgr.rows);
  return {i420.rowRange(0, bgr.rows).clone(), rest.rowRange(0, bgr.rows / 2).clone(),
          rest.rowRange(bgr.rows / 2, bgr.rows).clone()};
}

void append(Bytes& bytes, const cv::Mat& plane) { bytes.insert(bytes.end(), plane.datastart, plane.dataend); }

cv::Mat interleaved(const cv::Mat& first, const cv::Mat& second) {
  cv::Mat both;
  cv::merge(std::vector<cv::Mat>{first, second}, both);
  return both;
}

// Colours of every second pixel and every row.
Bytes packed_422(const Planes& planes, bool luma_first) {
  Bytes bytes;
  for (int y = 0; y < planes.y.rows; ++y)
    for (int x = 0; x < planes.y.cols; ++x) {
      const cv::Mat& colour = x % 2 == 0 ? planes.u : planes.v;
      const std::uint8_t luma = planes.y.at<std::uint8_t>(y, x);
      const std::uint8_t chroma = colour.at<std::uint8_t>(y / 2, x / 2);
      bytes.push_back(luma_first ? luma : chroma);
      bytes.push_back(luma_first ? chroma : luma);
    }
  return bytes;
}

}  // namespace

Bytes packed(std::uint32_t fourcc, const cv::Mat& bgr) {
  Bytes bytes;
  const Planes planes = planes_of(bgr);
  switch (fourcc) {
    case V4L2_PIX_FMT_MJPEG:
      cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, 95});
      break;
    case V4L2_PIX_FMT_BGR24:
      append(bytes, bgr);
      break;
    case V4L2_PIX_FMT_RGB24: {
      cv::Mat rgb;
      cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
      append(bytes, rgb);
      break;
    }
    case V4L2_PIX_FMT_GREY: {
      cv::Mat grey;
      cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
      append(bytes, grey);
      break;
    }
    case V4L2_PIX_FMT_YUV420:
      append(bytes, planes.y);
      append(bytes, planes.u);
      append(bytes, planes.v);
      break;
    case V4L2_PIX_FMT_NV12:
      append(bytes, planes.y);
      append(bytes, interleaved(planes.u, planes.v));
      break;
    case V4L2_PIX_FMT_P010: {
      Bytes eight = packed(V4L2_PIX_FMT_NV12, bgr);
      for (const std::uint8_t value : eight) {
        bytes.push_back(0);
        bytes.push_back(value);
      }
      break;
    }
    case V4L2_PIX_FMT_YUYV:
      return packed_422(planes, true);
    case V4L2_PIX_FMT_UYVY:
      return packed_422(planes, false);
    default:
      throw std::invalid_argument("no such format");
  }
  return bytes;
}

CameraRoom::CameraRoom() {
  const int made = ::open(file().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (made < 0 || ::ftruncate(made, sizeof(FakeCameras)) != 0)
    throw std::runtime_error("no room for cameras");
  void* const at = ::mmap(nullptr, sizeof(FakeCameras), PROT_READ | PROT_WRITE, MAP_SHARED, made, 0);
  ::close(made);
  if (at == MAP_FAILED) throw std::runtime_error("no room for cameras");
  cameras_ = new (at) FakeCameras();
  std::filesystem::create_directory(folder_.path() / "dev");
  for (int i = 0; i < kFakeCameras; ++i) {
    FakeCamera& one = camera(i);
    std::snprintf(one.driver, sizeof one.driver, "fake");
    std::snprintf(one.card, sizeof one.card, "Fake camera %d", i);
    std::snprintf(one.bus, sizeof one.bus, "usb-0000:00:14.0-%d", i);
    one.tells_sizes = true;
  }
  ::setenv(kFakeCamerasVariable, file().c_str(), 1);
}

CameraRoom::~CameraRoom() {
  ::unsetenv(kFakeCamerasVariable);
  ::munmap(cameras_, sizeof(FakeCameras));
}

FakeMode& CameraRoom::add_mode(int index, std::uint32_t fourcc, const std::vector<cv::Mat>& bgr,
                               const std::vector<std::uint32_t>& rates) {
  std::vector<Bytes> pictures;
  for (const cv::Mat& one : bgr) pictures.push_back(packed(fourcc, one));
  return add_mode(index, fourcc, bgr.front().size(), pictures, rates);
}

FakeMode& CameraRoom::add_mode(int index, std::uint32_t fourcc, cv::Size size,
                               const std::vector<Bytes>& pictures, const std::vector<std::uint32_t>& rates) {
  FakeCamera& one = camera(index);
  const std::filesystem::path made =
      folder_.path() / ("pictures" + std::to_string(index) + "_" + std::to_string(one.mode_count));
  std::ofstream out(made, std::ios::binary);
  const auto number = [&out](std::size_t value) {
    const auto written = static_cast<std::uint32_t>(value);
    out.write(reinterpret_cast<const char*>(&written), sizeof written);
  };
  FakeMode& mode = one.modes[one.mode_count++];
  number(pictures.size());
  for (const Bytes& picture : pictures) {
    number(picture.size());
    out.write(reinterpret_cast<const char*>(picture.data()), static_cast<std::streamsize>(picture.size()));
    mode.picture_bytes = std::max(mode.picture_bytes, static_cast<std::uint32_t>(picture.size()));
  }
  mode.fourcc = fourcc;
  mode.width = static_cast<std::uint32_t>(size.width);
  mode.height = static_cast<std::uint32_t>(size.height);
  std::copy(rates.begin(), rates.end(), std::begin(mode.rates));
  std::snprintf(mode.pictures, sizeof mode.pictures, "%s", made.c_str());
  return mode;
}

void CameraRoom::plug(int index) {
  std::ofstream(folder_.path() / "dev" / ("video" + std::to_string(index)));
  camera(index).is_plugged = true;
}

void CameraRoom::unplug(int index) {
  camera(index).is_plugged = false;
  std::filesystem::remove(folder_.path() / "dev" / ("video" + std::to_string(index)));
}

}  // namespace arthronaut::test
