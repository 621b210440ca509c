// Where a voxel lies about the part of a bore's axis that is fitted. Inner header of postop.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>

namespace arthronaut::postop {

struct PlacedByBore {
  double along, off;          // from the axis' middle; from the axis
  double across_u, across_v;  // unit
  std::size_t stretch, bin;

  // Of the turn, in so many equal parts.
  [[nodiscard]] std::size_t sector(std::size_t sectors) const;
};

// The axis between two stations, and two directions across it.
class BoreFrame {
 public:
  // Stations are along the direction from the entry.
  BoreFrame(const Eigen::Vector3d& entry_mm, const Eigen::Vector3d& direction, double from_mm, double to_mm);

  // Nothing beyond the stations; along the axis in so many stretches and bins.
  [[nodiscard]] std::optional<PlacedByBore> place(const Eigen::Vector3d& p_mm, std::size_t stretches,
                                                  std::size_t bins) const;
  // How many parts about this long it has, at least one.
  [[nodiscard]] std::size_t parts_of(double part_mm) const;
  // The middle across the axis, and one end against it, mm; the directions across follow.
  void move(const Eigen::Vector4d& by_mm);

  // By how much the farther of its ends is off the other's.
  [[nodiscard]] double ends_off_mm(const BoreFrame& other) const;

  [[nodiscard]] const Eigen::Vector3d& middle() const { return middle_; }
  [[nodiscard]] const Eigen::Vector3d& direction() const { return direction_; }
  // Across the axis, to where a voxel lies.
  [[nodiscard]] Eigen::Vector3d outwards(const PlacedByBore& placed) const {
    return placed.across_u * u_ + placed.across_v * v_;
  }
  [[nodiscard]] double half_mm() const { return half_mm_; }
  [[nodiscard]] double middle_from_entry_mm() const { return middle_from_entry_mm_; }

 private:
  void set_direction(const Eigen::Vector3d& direction);

  Eigen::Vector3d middle_, direction_, u_, v_;
  double half_mm_, middle_from_entry_mm_;
};

inline std::optional<PlacedByBore> BoreFrame::place(const Eigen::Vector3d& p_mm, std::size_t stretches,
                                                    std::size_t bins) const {
  PlacedByBore placed{};
  const Eigen::Vector3d w = p_mm - middle_;
  placed.along = w.dot(direction_);
  if (std::abs(placed.along) >= half_mm_) return std::nullopt;
  const double a = w.dot(u_), b = w.dot(v_);
  placed.off = std::sqrt(a * a + b * b);
  const double share = (placed.along + half_mm_) / (2 * half_mm_);
  placed.stretch = static_cast<std::size_t>(share * static_cast<double>(stretches));
  placed.bin = static_cast<std::size_t>(share * static_cast<double>(bins));
  if (placed.off > 1e-9) {
    placed.across_u = a / placed.off;
    placed.across_v = b / placed.off;
  }
  return placed;
}

inline std::size_t PlacedByBore::sector(std::size_t sectors) const {
  return static_cast<std::size_t>((std::atan2(across_v, across_u) / M_PI + 1) * 0.5 *
                                  static_cast<double>(sectors)) %
         sectors;
}

}  // namespace arthronaut::postop
