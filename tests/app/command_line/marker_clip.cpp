#include "tests/app/command_line/marker_clip.h"

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "navigation/recording/video_encoder.h"

namespace arthronaut::test {

namespace {

constexpr int kWidth = 640, kHeight = 480, kSide = static_cast<int>(kClipMarkerPx), kQuietZone = 28;

void draw(cv::Mat& picture, int id, int left, int top) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  cv::Mat marker, colour;
  cv::aruco::drawMarker(dictionary, id, kSide, marker);
  cv::cvtColor(marker, colour, cv::COLOR_GRAY2BGR);
  const cv::Rect place(left, top, kSide, kSide);
  const cv::Rect quiet(left - kQuietZone, top - kQuietZone, kSide + 2 * kQuietZone, kSide + 2 * kQuietZone);
  picture(quiet).setTo(cv::Scalar::all(230));
  // Neither quite black nor quite white, as on a sensor.
  cv::Mat(colour * 0.75 + cv::Scalar::all(30)).copyTo(picture(place));
}

// A lens blurs light, not the grey values that a sensor makes of it.
void blur_light(cv::Mat& picture) {
  constexpr double kGamma = 2.2;
  cv::Mat light;
  picture.convertTo(light, CV_32FC3, 1.0 / 255);
  cv::pow(light, kGamma, light);
  cv::GaussianBlur(light, light, {7, 7}, 0.8);
  cv::pow(light, 1 / kGamma, light);
  light.convertTo(picture, CV_8UC3, 255);
}

int probe_left_px(int frame) { return 360 + 2 * frame; }

}  // namespace

double clip_probe_x_px(int frame) { return probe_left_px(frame) + (kClipMarkerPx - 1) / 2; }

std::string clip_camera_json() {
  return R"({"format": "arthronaut.camera", "version": 1, "image_size_px": [640, 480], "focal_px": 400.0,
    "aspect_ratio": 1.0, "principal_point_px": [320.0, 240.0], "distortion_xi": 0.0,
    "rotation_center_px": [320.0, 240.0], "reference_mark_angle_deg": 0.0,
    "boundary": {"center_px": [320.0, 240.0], "radius_px": 400.0}, "medium": "air"})";
}

std::string clip_tools_json() {
  return R"({"format": "arthronaut.tools", "version": 1,
    "world_markers": [{"bone": "femur", "marker_id": 0, "size_mm": 4.0}],
    "tools": [{"name": "probe", "marker_id": 2, "size_mm": 4.0, "tip_mm": [0.0, -10.0, -2.0]}]})";
}

void write_marker_clip(const TemporaryFolder& folder) {
  write_file(folder / "camera.json", clip_camera_json());
  write_file(folder / "tools.json", clip_tools_json());
  recording::VideoEncoder encoder(folder / "clip.mkv", kWidth, kHeight, 60);
  cv::RNG random(7);
  for (int i = 0; i < kClipFrames; ++i) {
    cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar::all(110));
    draw(picture, 0, 120, 198);
    draw(picture, 2, probe_left_px(i), 198);
    blur_light(picture);
    cv::Mat noise(picture.size(), CV_16SC3), noisy;
    random.fill(noise, cv::RNG::NORMAL, 0, 1.5);
    cv::add(picture, noise, noisy, cv::noArray(), CV_8UC3);
    camera::Frame frame;
    frame.index = i;
    frame.width = kWidth;
    frame.height = kHeight;
    frame.bgr.assign(noisy.datastart, noisy.dataend);
    encoder.encode(frame);
  }
  encoder.finish();
}

}  // namespace arthronaut::test
