// Where near a supposed pose a marker's code lies in the frame: shifted, turned, nearer or farther. The code
// is compared with the frame made small, at the middles of its cells and of its margin; what is saturated
// says nothing, and what covers a part lowers the score and no more. For a marker that was lost: it finds a
// start for the measurement, and stands for nothing by itself.
#pragma once

#include <array>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/square_search.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

struct CodePlace {
  geometry::RigidTransform camera_from_marker;
  double score = -1;  // correlation of the picture with the code, 1 at best
};

// Has its memory from the beginning: a marker is lost for the first time in the middle of an operation.
class CodeSearch {
 public:
  static constexpr double kMinScore = 0.55;
  static constexpr int kTogether = 16;  // places of a row that are scored at once

  CodeSearch() { points_.reserve((kMaxCells + 2) * (kMaxCells + 2)); }

  // The best place within reach_px (frame pixels) of where the pose puts the marker; a score below kMinScore
  // is none. The wider the reach, the more turns and distances are tried.
  [[nodiscard]] CodePlace find(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                               const geometry::RigidTransform& supposed, double size_mm,
                               const MarkerCode& code, double reach_px);

 private:
  struct Point {
    int offset = 0;  // into the small picture, from the marker's centre
    int dx = 0, dy = 0;
    bool is_bright = false;
  };
  bool place_points(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                    const geometry::RigidTransform& pose, double size_mm, const MarkerCode& code,
                    Eigen::Vector2i& center);
  // Of a place by itself; and of so many in a row, `step` pixels apart from x on.
  [[nodiscard]] float score_at(const SquareSearch::SmallPicture& picture, int x, int y) const;
  void score_row(const SquareSearch::SmallPicture& picture, int x, int y, int step,
                 std::array<float, kTogether>& scores) const;

  std::vector<Point> points_;
  int left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;  // reach of the points
};

}  // namespace arthronaut::markers
