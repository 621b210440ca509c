// A clip shown again and again to the check of the bone in the picture, as contour_drift and contour_knock
// do.
#pragma once

#include <ctime>
#include <random>
#include <vector>

#include "navigation/contour/contour_check.h"
#include "navigation/contour/covered.h"
#include "tests/benchmarks/contour_clips.h"

namespace arthronaut::contour_clips {

inline double thread_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

inline geometry::Vector6d noise(std::mt19937_64& random, double mm, double deg) {
  std::normal_distribution<double> normal;
  geometry::Vector6d twist;
  for (int i = 0; i < 3; ++i) twist[i] = mm * normal(random);
  for (int i = 3; i < 6; ++i) twist[i] = geometry::rad_from_deg(deg) * normal(random);
  return twist;
}

// A clip shown again and again, there and back.
class Showing {
 public:
  explicit Showing(const Clip& clip) : clip_(clip) {
    step_ns_ = clip.looks.size() > 1 ? clip.looks[1].timestamp_ns - clip.looks[0].timestamp_ns : 33'333'333;
  }
  [[nodiscard]] const Look& look(std::size_t frame) const {
    const std::size_t n = clip_.looks.size(), at = frame % (2 * n);
    return clip_.looks[at < n ? at : 2 * n - 1 - at];
  }
  [[nodiscard]] std::int64_t time_ns(std::size_t frame) const {
    return (static_cast<std::int64_t>(frame) + 1) * step_ns_;
  }
  [[nodiscard]] double step_s() const { return 1e-9 * static_cast<double>(step_ns_); }

 private:
  const Clip& clip_;
  std::int64_t step_ns_;
};

// `luma`: the picture, the look's own or one made of it; world_from_bone as registered; world_moves: how the
// marker was bumped, once it was.
inline const contour::ContourVerdict& look_at(contour::ContourCheck& check, contour::CoveredPlaces& covered,
                                              const Clip& clip, const Look& look,
                                              const std::vector<std::uint8_t>& luma, std::int64_t time_ns,
                                              const geometry::RigidTransform& world_moves,
                                              std::vector<double>& ms) {
  covered.clear();
  if (look.is_valid)
    covered.add_world_marker(look.camera, look.camera_from_world, clip.tools.world_markers.front());
  for (std::size_t i = 0; i < look.camera_from_tool.size(); ++i)
    if (look.tool_is_tracked[i]) covered.add_tool(look.camera, look.camera_from_tool[i], clip.tools.tools[i]);
  const Eigen::Vector2i size = look.camera.image_size_px();
  const double before = thread_ms();
  const auto& verdict =
      check.look({luma.data(), size.x(), size.y(), size.x()}, look.camera,
                 look.is_valid ? std::optional(look.camera_from_world * world_moves) : std::nullopt,
                 covered.places(), time_ns);
  ms.push_back(thread_ms() - before);
  return verdict;
}

}  // namespace arthronaut::contour_clips
