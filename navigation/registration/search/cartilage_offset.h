// Where the mesh is bone and the probe touches cartilage, or the other way round: the touched surface lies
// off the mesh by one thickness over a region. The thickness is solved with the pose when the strokes hold
// it, else the region is left out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/pose_pool.h"
#include "navigation/registration/search/refinement.h"

namespace arthronaut::registration {

// The region made ready to be asked. Immutable; a reach that is not above 0 makes it empty. The bone must
// outlive it.
class CartilageMap {
 public:
  CartilageMap(const SurfaceIndex::Data& bone, const CartilageRegion& region);
  // Whether the place of the bone under (or over) a point belongs to the region.
  [[nodiscard]] bool covers(const Eigen::Vector3d& point_in_bone_mm) const;

 private:
  const SurfaceIndex::Data& bone_;
  double reach_mm_;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3d>> cells_;  // as wide as the reach
};

struct CartilageFit {
  WeightedPoints points;  // with their offsets; without the region where it was left out
  double kept_share = 1;  // of the touched path; below 1 where the region was left out
  bool is_solved = false;
  bool is_left_out = false;  // neither: no stroke lies on the region, or none beside it
  bool has_bare = true;      // false: all strokes lie on the region, and nothing was done about it
  double thickness_mm = 0, sigma_mm = 0;  // one sigma, from how the likelihood falls with the thickness
  // Twist of the bone frame about its origin, by thickness.
  geometry::Vector6d drift_per_mm = geometry::Vector6d::Zero();
  // As RefinedPose::cost, over all points with the likeliest thickness, whether it was solved or not:
  // compares.
  double cost = 0;
  std::string assumption;  // in plain words

  // How far off the mesh the probe touches at a place of the bone; nullopt where that is not known.
  [[nodiscard]] std::optional<double> offset_mm(const CartilageMap& map,
                                                const Eigen::Vector3d& point_in_bone_mm) const;
  // The same, by point of the curves.
  [[nodiscard]] std::vector<std::optional<double>> offsets_mm(
      const CartilageMap& map, const strokes::Curves& curves,
      const geometry::RigidTransform& bone_from_marker) const;
  // What the pose is uncertain by because the thickness is, one sigma: a twist of the bone frame about its
  // origin.
  [[nodiscard]] geometry::Vector6d drift() const {
    return is_solved ? geometry::Vector6d(sigma_mm * drift_per_mm) : geometry::Vector6d::Zero();
  }
  // Says in a summary of these points what was assumed, and doubts one that nothing bare holds.
  void add_to(RegistrationSummary& summary) const;
};

// Gives each pose of a pool the thickness that suits it best and refines it with it, so that the poses
// compare; the thickness is sought between -4 and 5 mm. Where the best one's is not held, all are refined
// without the points that it puts on the region.
class CartilageFitter {
 public:
  // All three must outlive it.
  CartilageFitter(const SurfaceIndex::Data& bone, const CartilageMap& map, const MarkerPrior& prior)
      : bone_(bone), map_(map), prior_(prior) {}

  // Follows the poses that it found the last time as points come in; anew, or the first time, it tries all
  // thicknesses with each pose of the pool as well. The best of all are left in the pool, which must not be
  // empty. For 500 points 9 ms a pose anew, 3 ms else.
  [[nodiscard]] CartilageFit fit(PosePool& pool, const WeightedPoints& points, bool anew);
  void forget() { known_.clear(); }

 private:
  struct Known {
    RefinedPose pose;
    double thickness_mm = 0;
    double profile_width_mm = 0;  // how far the likely thicknesses were spread when all were tried
  };

  const SurfaceIndex::Data& bone_;
  const CartilageMap& map_;
  const MarkerPrior& prior_;
  std::vector<Known> known_;  // best first
};

}  // namespace arthronaut::registration
