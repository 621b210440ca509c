// The femoral condyles as the true lateral view shows them. Inner header of landmarks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planning/landmarks/shape_samples.h"

namespace arthronaut::landmarks {

// The condylar line is the direction of view in which the outlines of both condyles, from behind to below,
// come nearest to each other: the view in which a radiographer calls the condyles superposed. Outlines are
// compared by how far either reaches in each of a fan of directions, so that neither osteophytes inside of
// the outline nor the two condyles' different curvature disturb it.
struct Condyles {
  Eigen::Matrix3d bone_from_frame =
      Eigen::Matrix3d::Identity();  // x along the condylar line, y anterior, z proximal
  // In the bone's frame: how far the condyles on the -x and the +x side reach backwards and downwards.
  Eigen::Vector3d posterior_minus, posterior_plus, distal_minus, distal_plus;
  double depth_mm = 0;  // from the hindmost to the foremost point of the joint's end
  // Half way between the condyles, about where the circles through their posterior outlines have their
  // centres.
  Eigen::Vector3d center_mm;
  double misfit_mm = 0;  // root mean square of what is left between the outlines
};

// samples: of the joint's end, without the cut, one for each each_mm2. bone_from_frame, origin_mm: rough, as
// RoughFrame has it; z is kept as far as the condylar line lets it: what is hindmost and lowest depends on
// it, the condylar line does not. nullopt where there are no two condyles.
[[nodiscard]] std::optional<Condyles> find_condyles(const std::vector<SurfaceSample>& samples,
                                                    double each_mm2, const Eigen::Matrix3d& bone_from_frame,
                                                    const Eigen::Vector3d& origin_mm);

}  // namespace arthronaut::landmarks
