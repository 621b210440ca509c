// Finds dark squares on a brighter margin in the whole frame, nothing known: dark regions of the frame at a
// quarter of its size, whose outline is a quadrilateral once it is undistorted. One corner, or a bite out of
// a side, may be covered.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/markers/planar_pose.h"

namespace arthronaut::markers {

struct FoundSquare {
  Corners corners_px;  // clockwise in the image, any of them first; good to about 2 px
  Corners tangent;     // the same, undistorted
  double shortest_side_px = 0;
  double longest_side_px = 0;
};

// Keeps its memory from call to call; a frame of the same size allocates nothing.
class SquareSearch {
 public:
  [[nodiscard]] std::span<const FoundSquare> find(const camera::GrayView& frame,
                                                  const camera::CameraModel& camera);

 private:
  struct Region {
    int left, right, top, bottom, area;
  };
  void shrink(const camera::GrayView& frame, const camera::CameraModel& camera);
  void mark_dark_pixels(int radius);
  void label_regions();
  bool outline_square(int label, const Region& region, const camera::CameraModel& camera,
                      FoundSquare& square);
  void take_hull();
  bool straighten_sides(std::array<Eigen::Vector2d, 4>& quad) const;

  int shrink_ = 4;
  int left_ = 0, top_ = 0;      // of the shrunk picture's first pixel, in frame pixels
  int width_ = 0, height_ = 0;  // of the shrunk picture
  std::vector<std::uint8_t> small_;
  std::vector<std::uint32_t> sums_;  // integral image of small_, one row and column larger
  std::vector<std::uint8_t> dark_;
  std::vector<int> labels_, parents_;
  std::vector<Region> regions_;
  std::vector<int> first_, last_;  // extremes of a region's rows or columns
  std::vector<Eigen::Vector2d> outline_, hull_;
  std::vector<FoundSquare> squares_;
};

}  // namespace arthronaut::markers
