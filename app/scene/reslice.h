// Slices of a volume in any plane, as grey pictures of the pane that shows them. On the processor: a pane of
// 700 x 500 pixels takes a few milliseconds, wherever OpenGL runs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::scene {

// A plane as a picture sees it: pixel (x, y), counted from the centre of the top-left one, lies at
//   center_mm + mm_per_px * ((x - (width - 1) / 2) * right + (y - (height - 1) / 2) * down).
struct SlicePlane {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();                                // LPS
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), down = Eigen::Vector3d::UnitY();  // unit, at right angles
  double mm_per_px = 0.5;

  [[nodiscard]] Eigen::Vector3d normal() const { return right.cross(down); }  // away from the eye
  [[nodiscard]] Eigen::Vector3d point_at(const Eigen::Vector2d& pixel, const Eigen::Vector2i& size_px) const;
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& point_mm,
                                         const Eigen::Vector2i& size_px) const;
  bool operator==(const SlicePlane&) const = default;
};

// Which values are drawn from black to white: level - width / 2 to level + width / 2.
struct GreyWindow {
  double level = 40, width = 400;
  bool operator==(const GreyWindow&) const = default;
};
inline constexpr GreyWindow kBoneWindow{480, 2500}, kSoftTissueWindow{40, 400};
// From the 1 % to the 99.5 % quantile of about 100,000 of the values: for MR, whose values mean nothing by
// themselves.
[[nodiscard]] GreyWindow automatic_window(const images::Volume& volume);
// The one that a key goes on to: bone, soft tissue, the automatic one. Of images that are known to be no CT
// the automatic one alone: their values are no HU.
[[nodiscard]] GreyWindow next_window(const GreyWindow& now, const GreyWindow& automatic,
                                     images::Modality modality);
// The same of images that are at hand; of a label map, whose values are names, the automatic one alone.
[[nodiscard]] GreyWindow next_window(const GreyWindow& now, const GreyWindow& automatic,
                                     const images::Volume& volume);

// Trilinear between voxel centres; outside of the outermost centres black. `grey` becomes width * height
// bytes, rows from the top.
void reslice(const images::Volume& volume, const SlicePlane& plane, const Eigen::Vector2i& size_px,
             const GreyWindow& window, std::vector<std::uint8_t>& grey);
// The value there, trilinear; nullopt outside.
[[nodiscard]] std::optional<double> value_at(const images::Volume& volume, const Eigen::Vector3d& point_mm);

// Where a mesh crosses the plane: pairs of points, one segment a triangle.
[[nodiscard]] std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> outline_of(
    const geometry::TriangleMesh& mesh, const Eigen::Vector3d& point_mm, const Eigen::Vector3d& normal);

// The patient's side that a direction in LPS points to: "L", or "LA" for one that is more than 20 degrees off
// the axes; the greater part first. R L A P, and H and F for head and foot.
[[nodiscard]] std::string orientation_letters(const Eigen::Vector3d& direction);

}  // namespace arthronaut::scene
