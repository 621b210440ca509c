// Where a marker is that a long exposure smears over a cell and more, and how it moved meanwhile. Each of the
// motions that may have brought it here is laid over the frame made small, as the code would look after it;
// the one that looks most like the frame is a start for the direct fit, and stands for nothing by itself.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/exposed_code.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/square_search.h"

namespace arthronaut::markers {

struct SmearedPlace {
  ExposedPose exposed;
  double score = -1;  // correlation of the frame with the smeared code, 1 at best
};

// How the frame shows what is smeared.
struct SmearedLook {
  double sigma_px = 1.2;  // of the optics, in frame pixels
  double gamma = 1.6;     // grey level = light ^ (1 / gamma)
};

// Has its memory from the beginning.
class SmearSearch {
 public:
  SmearSearch() : rays_(kRaysAcross * kRaysAcross) { points_.reserve(kMostPoints); }

  // The likeliest of these motions, and where within reach_px (frame pixels) of its place; a score of -1:
  // none can be looked at.
  [[nodiscard]] SmearedPlace find(const SquareSearch::SmallPicture& picture,
                                  const camera::CameraModel& camera, const MarkerCode& code, double size_mm,
                                  const SmearedLook& look, std::span<const ExposedPose> motions,
                                  double reach_px);

 private:
  static constexpr std::size_t kMostPoints = (kMaxCells + 2) * (kMaxCells + 2);
  struct Point {
    int x = 0, y = 0;  // in the small picture
    float level = 0;   // grey, of what is 0 dark and 1 bright
  };
  // Along which a pixel of the small picture is seen, which the motions share: those of the last pixels, kept
  // by the last bits of their places.
  struct Ray {
    int x = std::numeric_limits<int>::min(), y = 0;
    bool is_known = false;
    Eigen::Vector3f along = Eigen::Vector3f::Zero();
  };
  static constexpr int kRaysAcross = 64;  // a power of two
  const Ray& ray_of(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                    const Point& point);
  bool place_points(const SquareSearch::SmallPicture& picture, const camera::CameraModel& camera,
                    const MarkerCode& code, double size_mm, const SmearedLook& look,
                    const ExposedPose& motion, ExposedCode& exposed);
  [[nodiscard]] double score_at(const SquareSearch::SmallPicture& picture, int dx, int dy) const;

  std::vector<Point> points_;
  std::vector<Ray> rays_;
};

}  // namespace arthronaut::markers
