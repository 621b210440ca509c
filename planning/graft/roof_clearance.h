// Whether the roof of the notch would press on the graft in extension.
//
// The model: the tibial tunnel is prolonged straight into the joint, with the knee as it was imaged (taken
// for full extension), and compared with Blumensaat's line in the lateral view, along the femur's lateral
// axis. Howell (1995) calls a graft unimpinged when the whole opening of the tibial tunnel lies behind the
// roof's slope prolonged to the plateau.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::graft {

struct RoofQuery {
  Eigen::Vector3d tibial_opening_mm =
      Eigen::Vector3d::Zero();                             // the middle of the tunnel's mouth on the plateau
  Eigen::Vector3d into_tibia = -Eigen::Vector3d::UnitZ();  // unit, the tunnel's direction
  double diameter_mm = 9;
  Eigen::Vector3d blumensaat_anterior_mm = Eigen::Vector3d::Zero(),
                  blumensaat_posterior_mm = Eigen::Vector3d::Zero();
  landmarks::AnatomicalAxes femur_axes;
};

struct RoofClearance {
  // Across the tunnel, in the lateral view, from its anterior border to the roof's anterior end: negative
  // where the roof's outlet stands within the prolonged tunnel or behind it.
  double outlet_mm = 0;
  // Across Blumensaat's line, from the tunnel's anterior border to the line prolonged to the plateau:
  // negative where a part of the opening lies in front of it. The border is taken straight across the tunnel
  // from the opening's middle; on a plateau that the tunnel meets at a slant the opening's own border lies on
  // the same line along the tunnel, some mm further up or down.
  double opening_mm = 0;
};
// nullopt where Blumensaat's line is shorter than 5 mm in the lateral view, or the tunnel stands along the
// view.
[[nodiscard]] std::optional<RoofClearance> roof_clearance(const RoofQuery& query);

}  // namespace arthronaut::graft
