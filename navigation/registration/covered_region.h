// Where the mesh is bone and the probe touches cartilage, or the other way round: the touched surface lies off the mesh by
// one thickness over a region. The thickness is solved with the pose when the strokes hold it, else the region is left out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "navigation/registration/pose_pool.h"
#include "navigation/registration/prepared_bone.h"
#include "navigation/registration/refinement.h"

namespace arthronaut::registration {

// The region made ready to be asked. Immutable; a reach that is not above 0 makes it empty. The bone must outlive it.
class CoverMap {
 public:
  CoverMap(const PreparedBone::Data& bone, const CoveredRegion& region);
  // Whether the place of the bone under (or over) a point is covered.
  [[nodiscard]] bool covers(const Eigen::Vector3d& point_in_bone_mm) const;

 private:
  const PreparedBone::Data& bone_;
  double reach_mm_;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3d>> cells_;  // as wide as the reach
};

struct CoverFit {
  TouchedPoints points;      // with their offsets; without the region where it was left out
  bool is_solved = false;
  bool is_left_out = false;  // neither: no stroke lies on the region, or none beside it
  bool has_bare = true;      // false: all strokes lie on the region, and nothing was done about it
  double thickness_mm = 0, sigma_mm = 0;  // one sigma, from how the likelihood falls with the thickness
  geometry::Vector6d drift_per_mm = geometry::Vector6d::Zero();  // twist of the bone frame about its origin, by thickness
  double cost = 0;         // as RefinedPose::cost, over all points with the likeliest thickness, solved or not: compares
  std::string assumption;  // in plain words

  // How far off the mesh the probe touches at a place of the bone; nullopt where that is not known.
  [[nodiscard]] std::optional<double> offset_mm(const CoverMap& map, const Eigen::Vector3d& point_in_bone_mm) const;
};

// Gives each pose of the pool the thickness that suits it best and refines it with it, so that the poses compare; the
// thickness is sought between -4 and 5 mm. Where the best one's is not held, all are refined without the points that it puts
// on the region. Nothing is done to an empty pool.
[[nodiscard]] CoverFit fit_cover(const PreparedBone::Data& bone, PosePool& pool, const TouchedPoints& points,
                                 const CoverMap& map);

}  // namespace arthronaut::registration
