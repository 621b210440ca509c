#include "navigation/calibration/residual_plot.h"

#include <opencv2/imgproc.hpp>

#include "navigation/sources/picture.h"
#include "planning/files/format.h"

namespace arthronaut::calibration {
namespace {

constexpr int kWidth = 1600, kHeight = 900, kMargin = 40;
constexpr double kMagnified = 100;

const cv::Scalar kPaper(30, 28, 26), kInk(225, 225, 220), kFaint(95, 92, 88);

// Colours that stay apart for colour-blind eyes too (BGR).
cv::Scalar colour(std::size_t picture) {
  static const cv::Scalar colours[] = {{233, 180, 86},  {0, 159, 230},  {115, 158, 0},
                                       {167, 121, 204}, {66, 228, 240}, {0, 94, 213}};
  return colours[picture % std::size(colours)];
}

cv::Point2d at(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

void write(cv::Mat& canvas, const cv::Point& where, const std::string& text, const cv::Scalar& ink = kInk) {
  cv::putText(canvas, text, where, cv::FONT_HERSHEY_SIMPLEX, 0.55, ink, 1, cv::LINE_AA);
}

void draw_field(cv::Mat& canvas, const CalibrationSummary& summary,
                std::span<const CalibrationPicture> pictures) {
  const camera::Calibration& c = summary.record.calibration;
  // The round view fills the field; where it is larger than the picture, the picture does.
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(1.03 * c.boundary.radius_px);
  const Eigen::Vector2d low = (c.boundary.center_px - reach).cwiseMax(0);
  const Eigen::Vector2d size = (c.boundary.center_px + reach).cwiseMin(c.image_size_px.cast<double>()) - low;
  const double scale = std::min(880.0 / size.x(), 780.0 / size.y());
  const auto place = [&](const Eigen::Vector2d& pixel) {
    return at((pixel - low) * scale + Eigen::Vector2d(kMargin, 95));
  };
  cv::rectangle(canvas, place(low), place(low + size), kFaint, 1);
  cv::circle(canvas, place(c.boundary.center_px), static_cast<int>(c.boundary.radius_px * scale), kFaint, 1,
             cv::LINE_AA);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto& residuals = summary.pictures[i].residuals_px;
    const auto corners = corners_used(pictures[i]);
    for (std::size_t k = 0; k < residuals.size() && k < corners.size(); ++k)
      cv::line(canvas, place(corners[k].pixel), place(corners[k].pixel + kMagnified * residuals[k]),
               colour(i), 1, cv::LINE_AA);
  }
  cv::drawMarker(canvas, place(c.principal_point_px), kInk, cv::MARKER_CROSS, 18, 2, cv::LINE_AA);
  cv::drawMarker(canvas, place(c.rotation_center_px), kInk, cv::MARKER_TILTED_CROSS, 14, 2, cv::LINE_AA);
}

void draw_scatter(cv::Mat& canvas, const CalibrationSummary& summary) {
  const cv::Point middle(1270, 370);
  constexpr double kPxPerPx = 250;
  for (int ring = 1; ring <= 4; ++ring)
    cv::circle(canvas, middle, static_cast<int>(0.25 * ring * kPxPerPx), kFaint, 1, cv::LINE_AA);
  write(canvas, middle + cv::Point(-30, static_cast<int>(kPxPerPx) + 24), "1 px", kFaint);
  for (std::size_t i = 0; i < summary.pictures.size(); ++i)
    for (const Eigen::Vector2d& r : summary.pictures[i].residuals_px)
      cv::circle(canvas, cv::Point2d(middle) + at(kPxPerPx * r), 1, colour(i), cv::FILLED, cv::LINE_AA);
  int y = 690;
  for (std::size_t i = 0; i < summary.pictures.size() && y < kHeight - 20; ++i, y += 26) {
    const auto& picture = summary.pictures[i];
    write(canvas, {970, y},
          files::format("%.18s: %.2f px, %zu corners, tilt %.0f deg, lens %.0f deg",
                        std::filesystem::path(picture.name).filename().c_str(), picture.rms_px,
                        picture.residuals_px.size(), picture.tilt_deg, picture.lens_angle_deg),
          colour(i));
  }
}

}  // namespace

camera::Frame draw_residuals(const CalibrationSummary& summary,
                             std::span<const CalibrationPicture> pictures) {
  camera::Frame frame;
  frame.width = kWidth;
  frame.height = kHeight;
  frame.bgr.resize(3 * static_cast<std::size_t>(kWidth) * kHeight);
  cv::Mat canvas(kHeight, kWidth, CV_8UC3, frame.bgr.data());
  canvas = kPaper;
  const camera::Calibration& c = summary.record.calibration;
  write(canvas, {kMargin, 40},
        files::format("f %.1f px   xi %.4f   principal point (%.1f, %.1f)   rotation centre (%.1f, %.1f)",
                      c.focal_px, c.distortion_xi, c.principal_point_px.x(), c.principal_point_px.y(),
                      c.rotation_center_px.x(), c.rotation_center_px.y()));
  const std::string left_out = summary.leave_one_out_rms_px >= 0
                                   ? files::format("   left out %.3f px", summary.leave_one_out_rms_px)
                                   : "";
  write(canvas, {kMargin, 70},
        files::format("RMS %.3f px%s   lines: residuals x %.0f   + principal point   x centre",
                      summary.rms_px, left_out.c_str(), kMagnified));
  draw_field(canvas, summary, pictures);
  draw_scatter(canvas, summary);
  return frame;
}

void write_residual_plot(const std::filesystem::path& file, const CalibrationSummary& summary,
                         std::span<const CalibrationPicture> pictures) {
  sources::write_png(file, draw_residuals(summary, pictures));
}

}  // namespace arthronaut::calibration
