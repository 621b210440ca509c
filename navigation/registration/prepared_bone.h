// What PreparedBone holds.
#pragma once

#include "navigation/registration/distance_field.h"
#include "navigation/registration/pair_table.h"
#include "navigation/registration/registration.h"
#include "planning/geometry/surface.h"

namespace arthronaut::registration {

struct PreparedBone::Data {
  explicit Data(const geometry::TriangleMesh& mesh)
      : field(mesh), coarse_field(field), pairs(mesh), surface(mesh), bounds(geometry::bounds_of(mesh)) {}

  DistanceField field;
  CoarseDistanceField coarse_field;
  PairTable pairs;
  geometry::Surface surface;
  geometry::Bounds bounds;
};

}  // namespace arthronaut::registration
