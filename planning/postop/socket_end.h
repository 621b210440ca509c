// Where a bore ends within the bone, and how well that is seen. Inner header of postop.
#pragma once

#include <optional>

#include "planning/postop/drilled_mouth.h"

namespace arthronaut::postop {

// What of a bore tells where it ends: the grey from here to there off its axis.
struct TellingRing {
  double from_mm, to_mm;
};
// The middle of a bore that has marrow beyond its end.
[[nodiscard]] inline TellingRing middle_of(double radius_mm) { return {0.2 * radius_mm, 0.9 * radius_mm}; }

class AlongBore {
 public:
  // `contrast_hu`: what the bore's wall stands out by; `blur_mm`: sigma that it is seen through. All must
  // outlive it.
  AlongBore(const images::VolumeSampler& postop, const geometry::RigidTransform& postop_from_plan,
            const geometry::Surface& bone, const Passage& passage, double radius_mm, double contrast_hu,
            double blur_mm)
      : postop_(postop),
        postop_from_plan_(postop_from_plan),
        bone_(bone),
        passage_(passage),
        radius_mm_(radius_mm),
        contrast_hu_(contrast_hu),
        blur_mm_(blur_mm) {}

  // How far from the entry a bore ends that does not come out: where the grey of the ring first steps up by
  // half of the contrast. nullopt when no step is seen that stands out of the noise.
  [[nodiscard]] std::optional<double> end_mm(const TellingRing& ring) const;
  // One sigma of an end that was found so, by trial: marrow along lines beside the bore, each as grainy as it
  // is there, is put in the place of what lies beyond the end, and the end is sought again. Where the marrow
  // beyond is by chance as dark as the graft the bore looks longer than it is, which is seen of no single
  // step. Infinite where too little marrow lies beside it.
  [[nodiscard]] double end_sigma_mm(const TellingRing& ring, double end_mm) const;

 private:
  const images::VolumeSampler& postop_;
  const geometry::RigidTransform& postop_from_plan_;
  const geometry::Surface& bone_;
  Passage passage_;
  double radius_mm_, contrast_hu_, blur_mm_;

  [[nodiscard]] std::vector<double> greys(const Eigen::Vector3d& from, const TellingRing& ring) const;
  [[nodiscard]] std::optional<double> step_in(std::vector<double> grey) const;
  [[nodiscard]] std::vector<std::vector<double>> marrow_beside(const TellingRing& ring, double end_mm) const;
};

}  // namespace arthronaut::postop
