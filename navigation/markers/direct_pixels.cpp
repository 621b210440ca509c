// Which pixels the direct fit looks at: those across the code's edges, as far as the exposure shows the code
// and its white margin there and nothing else.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "navigation/markers/direct_alignment.h"
#include "navigation/markers/row_timing.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr int kStepsToASide = 4;        // pixels taken across an edge, to either side of it
constexpr double kPixelSigmaPx = 0.29;  // of a pixel's own square

}  // namespace

void DirectFit::take_pixels(const camera::GrayView& frame, const camera::CameraModel& camera, int cells,
                            std::span<const EdgeSample> samples, double size_mm, const DirectStart& start,
                            const DirectOptions& options, std::size_t first, std::size_t every) {
  const RigidTransform& pose = start.pose.camera_from_marker;
  const Eigen::Matrix3d rotation = pose.matrix();
  const double sigma_cells = std::hypot(start.sigma_px, kPixelSigmaPx) * cells / size_mm;
  // From the marker's middle to the end of the white margin of one cell.
  const double known_mm = size_mm * (0.5 + 1.0 / cells);
  const auto center = camera.project(pose.translation_mm);
  if (!center) return;
  const std::size_t stride =
      (samples.size() * (2 * kStepsToASide + 1) + options.max_pixels - 1) / options.max_pixels;
  for (std::size_t s = first * stride; s < samples.size(); s += every * stride) {
    const EdgeSample& sample = samples[s];
    const Eigen::Vector3d place(sample.x * size_mm, sample.y * size_mm, 0);
    Eigen::Matrix<double, 2, 3> d_pixel;
    const auto point = camera.project(pose * place, d_pixel);
    if (!point || !camera.is_inside_view(*point)) continue;
    const Eigen::Matrix<double, 2, 3> d_marker = d_pixel * rotation;
    const Eigen::Matrix2d warp = d_marker.leftCols<2>(), back = warp.inverse();
    const Eigen::Vector2d along = warp.col(1 - sample.axis);
    const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
    const Eigen::Vector3d moved = start.pose.velocity.head<3>() + start.pose.velocity.tail<3>().cross(place);
    const double half_box_px = 0.5 * std::abs(normal.dot(d_marker * moved));
    const double cell_px = std::abs(normal.dot(warp.col(sample.axis))) * size_mm / cells;
    // How far to either side the place that a pixel looks at wanders over the exposure.
    const Eigen::Vector2d wander = 0.5 * (back * (d_marker * moved)).cwiseAbs();
    const double reach =
        half_box_px + std::min(3 * start.sigma_px + 1.5 + options.coarse_cells * cell_px, 0.8 * cell_px);
    const int lane = static_cast<int>((sample.axis == 0 ? 0.5 - sample.y : sample.x + 0.5) * cells);
    const auto line =
        static_cast<int>(std::lround((sample.axis == 0 ? sample.x + 0.5 : 0.5 - sample.y) * cells));
    const Eigen::Vector2d moves =
        d_marker * (start.interval_motion.head<3>() + start.interval_motion.tail<3>().cross(place));
    for (int k = -kStepsToASide; k <= kStepsToASide; ++k) {
      const Eigen::Vector2d pixel = (*point + k * reach / kStepsToASide * normal).array().round();
      if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() >= frame.width || pixel.y() >= frame.height) continue;
      const std::uint8_t grey = frame.row(static_cast<int>(pixel.y()))[static_cast<int>(pixel.x())];
      if (grey >= options.saturated_grey) continue;
      // Where it would look, had its row been exposed with the centre's.
      const Eigen::Vector2d there =
          pixel - row_delay(start.delays, pixel.y(), center->y(), frame.height) * moves;
      // What lies beyond is not known, and a long smear brings its light far into the margin.
      const Eigen::Vector2d looked_at = place.head<2>() + back * (there - *point);
      if ((looked_at.cwiseAbs() + wander).maxCoeff() > known_mm) continue;
      const auto ray = camera.ray(there);
      if (!ray) continue;
      pixels_.add(
          {ray->cast<float>(), static_cast<float>(grey), static_cast<float>(sigma_cells * back.row(0).norm()),
           static_cast<float>(sigma_cells * back.row(1).norm()), (2 / size_mm * looked_at).cast<float>(),
           (sample.axis * (cells + 1) + line) * cells + lane});
    }
  }
}

}  // namespace arthronaut::markers
