#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "navigation/experiments/plot.h"
#include "navigation/experiments/registration_experiment.h"
#include "planning/files/format.h"

namespace arthronaut::experiments {

namespace {

const cv::Scalar kSpread(170, 110, 40), kError(40, 120, 220);
constexpr int kWidth = 1000, kHeight = 640, kLeft = 90, kRight = 30, kTop = 90, kBottom = 90;

}  // namespace

void write_registration_plot(const std::filesystem::path& file, const RegistrationExperimentResult& result,
                             TrialNoise noise) {
  cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar::all(255));
  double top_mm = 0.1;
  for (const ControlPoint& control : result.control_points) {
    top_mm = std::max({top_mm, control.spread_rms_mm, control.error_rms_mm});
  }
  top_mm = std::ceil(top_mm * 10 + 0.5) / 10;
  const int base = kHeight - kBottom, span = base - kTop;
  const auto height_of = [&](double mm) { return static_cast<int>(std::lround(mm / top_mm * span)); };
  for (int line = 0; line <= 5; ++line) {
    const double mm = top_mm * line / 5;
    const int y = base - height_of(mm);
    cv::line(image, {kLeft, y}, {kWidth - kRight, y}, kGrid);
    write_text(image, files::format("%.2f", mm), {kLeft - 60, y + 5}, 0.5);
  }
  const int count = std::max<int>(1, static_cast<int>(result.control_points.size()));
  const int step = (kWidth - kLeft - kRight) / count, bar = step / 3;
  for (int i = 0; i < static_cast<int>(result.control_points.size()); ++i) {
    const ControlPoint& control = result.control_points[static_cast<std::size_t>(i)];
    const int x = kLeft + i * step + step / 6;
    cv::rectangle(image, {x, base - height_of(control.spread_rms_mm)}, {x + bar - 2, base}, kSpread,
                  cv::FILLED);
    cv::rectangle(image, {x + bar, base - height_of(control.error_rms_mm)}, {x + 2 * bar - 2, base}, kError,
                  cv::FILLED);
    write_text(image, files::format("%.0f mm", control.distance_mm), {x, base + 24}, 0.5);
  }
  cv::line(image, {kLeft, base}, {kWidth - kRight, base}, kInk);
  write_text(image,
             "Registration, " + std::string(to_text(noise)) +
                 files::format(" noise, %.0f trials", static_cast<double>(result.trials.size())) +
                 files::format(", %.0f reliable", static_cast<double>(result.reliable_count)),
             {kLeft, 32}, 0.75);
  cv::rectangle(image, {kLeft, 50}, {kLeft + 16, 66}, kSpread, cv::FILLED);
  write_text(image,
             files::format("RMS about the centroid of the trials (all: %.2f mm)", result.spread_rms_mm),
             {kLeft + 24, 64}, 0.5);
  cv::rectangle(image, {kLeft + 450, 50}, {kLeft + 466, 66}, kError, cv::FILLED);
  write_text(image, files::format("RMS error against the truth (all: %.2f mm)", result.error_rms_mm),
             {kLeft + 474, 64}, 0.5);
  write_text(image, "control points, by distance from the middle of the digitised area; mm",
             {kLeft, kHeight - 24}, 0.55);
  write_plot(file, image);
}

}  // namespace arthronaut::experiments
