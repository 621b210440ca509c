#include "planning/postop/bore_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arthronaut::postop {

using Eigen::Vector3d;

BoreFrame::BoreFrame(const Vector3d& entry_mm, const Vector3d& direction, double from_mm, double to_mm)
    : half_mm_(0.5 * (to_mm - from_mm)), middle_from_entry_mm_(0.5 * (from_mm + to_mm)) {
  set_direction(direction);
  middle_ = entry_mm + middle_from_entry_mm_ * direction_;
}

std::size_t BoreFrame::parts_of(double part_mm) const {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(2 * half_mm_ / part_mm)));
}

void BoreFrame::move(const Eigen::Vector4d& by_mm) {
  middle_ += by_mm[0] * u_ + by_mm[1] * v_;
  set_direction(direction_ + (by_mm[2] * u_ + by_mm[3] * v_) / half_mm_);
}

double BoreFrame::ends_off_mm(const BoreFrame& other) const {
  const Vector3d off = middle_ - other.middle_,
                 tilted = half_mm_ * direction_ - other.half_mm_ * other.direction_;
  return std::max((off + tilted).norm(), (off - tilted).norm());
}

void BoreFrame::set_direction(const Vector3d& direction) {
  direction_ = direction.normalized();
  u_ = direction_.unitOrthogonal();
  v_ = direction_.cross(u_);
}

}  // namespace arthronaut::postop
