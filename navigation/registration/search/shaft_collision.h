// The probe came from outside: a pose that leads its shaft through the bone cannot be.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/weighted_points.h"

namespace arthronaut::registration {

class ShaftCollision {
 public:
  // The bone has to outlive it. Without directions of the shaft in the points every pose is possible.
  ShaftCollision(const SurfaceIndex::Data& bone, const WeightedPoints& points);

  // Share of the points, of some two dozen evenly chosen ones, that the shaft would have reached through the
  // bone; up to 35 mm from the tip are looked at, and 1.5 mm into the bone are forgiven, for a bent tip and
  // the field's rounding.
  [[nodiscard]] double share_through_bone(const Eigen::Matrix3f& rotation,
                                          const Eigen::Vector3f& translation_mm) const;
  // At most half: a probe that bends about an edge, or was bent by it, is no reason to drop a pose. Both are
  // bone_from_marker.
  [[nodiscard]] bool is_possible(const Eigen::Matrix3f& rotation,
                                 const Eigen::Vector3f& translation_mm) const;

 private:
  struct Shaft {
    Eigen::Vector3f tip_mm, direction;  // world-marker frame
  };
  [[nodiscard]] bool leads_through_bone(const Shaft& shaft, const Eigen::Matrix3f& rotation,
                                        const Eigen::Vector3f& translation_mm) const;

  const CoarseDistanceField& field_;
  std::vector<Shaft> shafts_;
};

}  // namespace arthronaut::registration
