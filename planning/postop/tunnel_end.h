// Where a drilled tunnel ends: out of the bone, in the marrow, or where a thinner bore goes on. Inner header
// of postop.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "planning/postop/narrowing.h"
#include "planning/postop/socket_end.h"
#include "planning/postop/tunnel_fit.h"

namespace arthronaut::postop {

// Of a wall that is seen.
inline constexpr double kLeastSeen = 0.5;
// Beyond the end of a socket there is no wall from here to there.
inline constexpr double kBeyondFrom_mm = 2, kBeyondTo_mm = 10;

struct TunnelEnd {
  double from_entry_mm = 0;
  double beyond_mm = 0;  // diameter of the thinner bore beyond; 0: none is seen
  bool comes_out = false, is_seen = false;
  bool leaves_images = false;               // the images end before it does
  std::optional<Narrowing> narrowing = {};  // by its widths
  bool is_narrowing_seen = true;            // false: nothing but its widths tells of a thinner bore
};

[[nodiscard]] Bore bore_of(const TunnelFit& fit, const Passage& passage);

// Ends of tunnels in one bone. All must outlive it.
class TunnelEnds {
 public:
  TunnelEnds(const images::VolumeSampler& postop, const geometry::RigidTransform& postop_from_plan,
             const geometry::Surface& bone)
      : sampler_(postop), postop_from_plan_(postop_from_plan), bone_(bone) {}

  // `before`: of a longer fit; one that ends where the bore gets thinner shows nothing of that any more.
  [[nodiscard]] TunnelEnd find(const std::vector<WallVoxel>& voxels, const TunnelFit& fit,
                               const Passage& passage, const std::optional<Narrowing>& before) const;
  // One sigma of `end`; infinite where it is not seen.
  [[nodiscard]] double sigma_mm(const TunnelFit& fit, const Passage& passage, const TunnelEnd& end) const;

 private:
  [[nodiscard]] AlongBore along(const TunnelFit& fit, const Passage& passage) const;
  [[nodiscard]] double sigma_of_passage_mm(const TunnelFit& fit, const Passage& passage) const;
  [[nodiscard]] double length_in_images_mm(const Passage& passage) const;

  const images::VolumeSampler& sampler_;
  const geometry::RigidTransform& postop_from_plan_;
  const geometry::Surface& bone_;
};

}  // namespace arthronaut::postop
