#include "tests/live/marker_scene.h"

#include <algorithm>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

namespace arthronaut::test {

namespace {

constexpr int kPictures = 60, kSide = 84, kQuietZone = 28;

void draw(cv::Mat& picture, int id, int left, int top) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  cv::Mat marker;
  cv::aruco::drawMarker(dictionary, id, kSide, marker);
  const cv::Rect place(left, top, kSide, kSide);
  picture(cv::Rect(left - kQuietZone, top - kQuietZone, kSide + 2 * kQuietZone, kSide + 2 * kQuietZone)) =
      230;
  cv::Mat(marker * 0.75 + cv::Scalar::all(30)).copyTo(picture(place));
}

// A lens blurs light, not the grey values that a sensor makes of it.
cv::Mat seen_by_lens(const cv::Mat& picture) {
  constexpr double kGamma = 2.2;
  cv::Mat light, seen;
  picture.convertTo(light, CV_32FC1, 1.0 / 255);
  cv::pow(light, kGamma, light);
  cv::GaussianBlur(light, light, {7, 7}, 0.8);
  cv::pow(light, 1 / kGamma, light);
  light.convertTo(seen, CV_8UC1, 255);
  return seen;
}

std::vector<std::uint8_t> noisy(const cv::Mat& picture, cv::RNG& random) {
  cv::Mat noise(picture.size(), CV_16SC1), sum;
  random.fill(noise, cv::RNG::NORMAL, 0, 2);
  cv::add(picture, noise, sum, cv::noArray(), CV_8UC1);
  return {sum.datastart, sum.dataend};
}

}  // namespace

camera::Calibration scene_camera() {
  camera::Calibration camera;
  camera.image_size_px = {kSceneWidth, kSceneHeight};
  camera.focal_px = 400;
  camera.principal_point_px = camera.rotation_center_px = {320, 240};
  camera.boundary = {{320, 240}, 400};
  return camera;
}

tools::ToolSet scene_tools() {
  tools::ToolSet tools;
  tools.world_markers = {{bones::BoneKind::Femur, 0, 4.0}};
  tools::Tool guide;
  guide.name = "femoral guide";
  guide.marker_id = 3;
  guide.size_mm = 4;
  guide.axis = tools::ToolAxis{{0, -25, -4}, {0, -1, 0}};
  guide.provenance.origin = provenance::Origin::Measured;
  tools.tools = {guide};
  return tools;
}

MarkerScene::MarkerScene() {
  cv::RNG random(7);
  for (int i = 0; i < kPictures; ++i) {
    // To and fro, so that it can go round without a jump.
    const int moved_px = i < kPictures / 2 ? i : kPictures - i;
    cv::Mat picture(kSceneHeight, kSceneWidth, CV_8UC1, cv::Scalar::all(110));
    for (int x = 0; x < kSceneWidth; x += 40)
      cv::line(picture, {x + moved_px, 0}, {x + moved_px / 2, kSceneHeight}, cv::Scalar::all(95), 3);
    draw(picture, 0, 120 + moved_px, 100);
    draw(picture, 3, 400 - moved_px, 290);
    live_.push_back(noisy(seen_by_lens(picture), random));
    if (i < 10) black_.push_back(noisy(cv::Mat(picture.size(), CV_8UC1, cv::Scalar::all(14)), random));
  }
}

const std::vector<std::uint8_t>& MarkerScene::live(long frame) const {
  return live_[static_cast<std::size_t>(frame) % live_.size()];
}

const std::vector<std::uint8_t>& MarkerScene::black(long frame) const {
  return black_[static_cast<std::size_t>(frame) % black_.size()];
}

std::vector<std::uint8_t> MarkerScene::torn(long frame) const {
  std::vector<std::uint8_t> picture = live(frame);
  const auto half = static_cast<std::ptrdiff_t>(picture.size() / 2);
  const std::vector<std::uint8_t>& before = live(frame - 1);
  std::copy(before.begin() + half, before.end(), picture.begin() + half);
  return picture;
}

}  // namespace arthronaut::test
