#include "planning/bones/image_cut.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"

namespace arthronaut::bones {

namespace {

const char* side_in_words(const Eigen::Vector3d& out) {
  Eigen::Index axis = 0;
  out.cwiseAbs().maxCoeff(&axis);
  const bool is_towards_more = out[axis] > 0;
  if (axis == 0) return is_towards_more ? "on the patient's left" : "on the patient's right";
  if (axis == 1) return is_towards_more ? "behind" : "in front";
  return is_towards_more ? "above" : "below";
}

}  // namespace

bool ImageCut::is_sound() const {
  constexpr double kOffUnit = 1e-6;
  return at_mm.allFinite() && std::abs(out.norm() - 1) < kOffUnit && std::isfinite(area_mm2) && area_mm2 > 0;
}

std::string ImageCut::words() const {
  return files::format(
      "the images end within it: %.0f cm\u00B2 of it are cut off flat %s, and what lies beyond is missing",
      area_mm2 / 100, side_in_words(out));
}

bool images_end_at(const std::vector<ImageCut>& cuts, const Eigen::Vector3d& point_mm, double radius_mm) {
  return std::ranges::any_of(cuts, [&](const ImageCut& cut) { return cut.is_reached(point_mm, radius_mm); });
}

}  // namespace arthronaut::bones
