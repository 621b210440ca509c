#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "navigation/experiments/lens_rotation.h"
#include "navigation/experiments/plot.h"
#include "planning/files/format.h"

namespace arthronaut::experiments {

namespace {

constexpr int kWidth = 1200, kPanelHeight = 230, kGap = 50, kLeft = 90, kRight = 30, kTop = 90;
const std::array<cv::Scalar, 3> kModeColors{cv::Scalar(170, 110, 40), cv::Scalar(40, 120, 220),
                                            cv::Scalar(110, 160, 60)};

// One diagram over the frames: y from low to high.
class Panel {
 public:
  Panel(cv::Mat& image, int position, double low, double high, std::int64_t frame_count,
        const std::string& title)
      : image_(image),
        top_(kTop + position * (kPanelHeight + kGap)),
        low_(low),
        high_(high),
        frame_count_(std::max<std::int64_t>(2, frame_count)) {
    for (int line = 0; line <= 4; ++line) {
      const double value = low + (high - low) * line / 4;
      const int y = row_of(value);
      cv::line(image_, {kLeft, y}, {kWidth - kRight, y}, kGrid);
      write_text(image_, files::format("%.*f", high - low > 10 ? 0 : 2, value), {kLeft - 62, y + 5}, 0.45);
    }
    write_text(image_, title, {kLeft, top_ - 10}, 0.55);
  }

  // value_of(i): the value of frame i, or nothing. Values above the panel are drawn at its top.
  template <class ValueOf>
  void draw(const cv::Scalar& color, ValueOf value_of) {
    std::optional<cv::Point> before;
    for (std::int64_t i = 0; i < frame_count_; ++i) {
      const std::optional<double> value = value_of(static_cast<std::size_t>(i));
      if (!value) {
        before.reset();
        continue;
      }
      const cv::Point at(kLeft + static_cast<int>(i * (kWidth - kLeft - kRight) / (frame_count_ - 1)),
                         row_of(std::clamp(*value, low_, high_)));
      if (before) cv::line(image_, *before, at, color, 1, cv::LINE_AA);
      before = at;
    }
  }

 private:
  int row_of(double value) const {
    return top_ + kPanelHeight -
           static_cast<int>(std::lround((value - low_) / (high_ - low_) * kPanelHeight));
  }

  cv::Mat& image_;
  int top_;
  double low_, high_;
  std::int64_t frame_count_;
};

// A round number a little above the greatest 95 % of the modes.
double fitting_top(double greatest) {
  const double step = std::pow(10.0, std::floor(std::log10(std::max(greatest, 1e-3))));
  return std::ceil(1.25 * greatest / (0.5 * step)) * 0.5 * step;
}

}  // namespace

void write_lens_rotation_plot(const std::filesystem::path& file, const LensRotationResult& result,
                              const std::string& title) {
  const auto frame_count = static_cast<std::int64_t>(result.frames.size());
  double top_mm = 0.05, top_deg = 0.2, least_deg = 0, most_deg = 10;
  for (const LensModeSummary& mode : result.modes) {
    top_mm = std::max(top_mm, mode.p95_mm);
    top_deg = std::max(top_deg, mode.p95_deg);
  }
  for (const auto& frame : result.frames) {
    least_deg = std::min(least_deg, frame.lens_angle_deg.value_or(0));
    most_deg = std::max(most_deg, frame.lens_angle_deg.value_or(0));
  }
  cv::Mat image(kTop + 3 * (kPanelHeight + kGap), kWidth, CV_8UC3, cv::Scalar::all(255));
  write_text(image, title, {kLeft, 30}, 0.75);
  Panel translation(image, 0, 0, fitting_top(top_mm), frame_count, "translation error, mm");
  Panel rotation(image, 1, 0, fitting_top(top_deg), frame_count, "rotation error, degrees");
  // In steps of 10 degrees on the axis, which has four of them or a multiple.
  const double low_deg = 40 * std::floor(least_deg / 40),
               high_deg = low_deg + 40 * std::ceil((most_deg - low_deg) / 40);
  Panel lens(image, 2, low_deg, high_deg, frame_count, "rotation of the lens, degrees, over frames");
  // The mode that matters is drawn last, over the others.
  for (const std::size_t mode : {std::size_t{1}, std::size_t{2}, std::size_t{0}}) {
    const auto at = [&](std::size_t i) {
      return i < result.frames.size() ? result.frames[i].errors[mode] : std::optional<RulerError>{};
    };
    translation.draw(kModeColors[mode], [&](std::size_t i) {
      const auto error = at(i);
      return error ? std::optional(error->translation_mm) : std::nullopt;
    });
    rotation.draw(kModeColors[mode], [&](std::size_t i) {
      const auto error = at(i);
      return error ? std::optional(error->rotation_deg) : std::nullopt;
    });
    write_text(image, std::string(to_text(kLensModes[mode])), {kLeft + 260 * static_cast<int>(mode), 58},
               0.55, kModeColors[mode]);
  }
  lens.draw(kInk, [&](std::size_t i) {
    return i < result.frames.size() ? result.frames[i].lens_angle_deg : std::optional<double>{};
  });
  write_plot(file, image);
}

}  // namespace arthronaut::experiments
