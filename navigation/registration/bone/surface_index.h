// What SurfaceIndex holds.
#pragma once

#include <utility>

#include "navigation/registration/bone/distance_field.h"
#include "navigation/registration/bone/pair_table.h"
#include "navigation/registration/registration.h"
#include "planning/geometry/surface.h"

namespace arthronaut::registration {

struct SurfaceIndex::Data {
  explicit Data(const geometry::TriangleMesh& mesh) : Data(mesh, DistanceField(mesh), PairTable(mesh)) {}
  Data(const geometry::TriangleMesh& mesh, DistanceField distance_field, PairTable pair_table)
      : field(std::move(distance_field)),
        coarse_field(field),
        pairs(std::move(pair_table)),
        surface(mesh),
        bounds(geometry::bounds_of(mesh)) {}

  DistanceField field;
  CoarseDistanceField coarse_field;
  PairTable pairs;
  geometry::Surface surface;
  geometry::Bounds bounds;
};

}  // namespace arthronaut::registration
