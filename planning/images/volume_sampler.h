// Grey values between the voxels.
#pragma once

#include <cmath>
#include <limits>

#include "planning/images/volume.h"

namespace arthronaut::images {

// Trilinear, at places in LPS; not a number beyond the volume. The volume must outlive it.
class VolumeSampler {
 public:
  explicit VolumeSampler(const Volume& volume)
      : volume_(volume), index_from_lps_(volume.lps_from_index.inverse()) {}

  [[nodiscard]] double at(const Eigen::Vector3d& p_in_lps) const {
    constexpr double kBeyond = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d index = index_from_lps_ * p_in_lps;
    if (!(index.array() >= 0).all()) return kBeyond;
    const Eigen::Vector3i low = index.cast<int>();
    if ((low.array() + 1 >= volume_.size.array()).any()) return kBeyond;
    const Eigen::Vector3d f = index - low.cast<double>();
    const float* const v = volume_.values.data() + volume_.index(low.x(), low.y(), low.z());
    const auto row = static_cast<std::size_t>(volume_.size.x()),
               slice = row * static_cast<std::size_t>(volume_.size.y());
    const auto line = [&](std::size_t o) { return v[o] + f.x() * (v[o + 1] - v[o]); };
    const auto plane = [&](std::size_t o) {
      const double a = line(o);
      return a + f.y() * (line(o + row) - a);
    };
    const double a = plane(0);
    return a + f.z() * (plane(slice) - a);
  }

 private:
  const Volume& volume_;
  Eigen::Affine3d index_from_lps_;
};

}  // namespace arthronaut::images
