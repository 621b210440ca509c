#include "planning/segmentation/label_surface.h"

#include <string>

#include "planning/geometry/error.h"
#include "planning/images/contour.h"
#include "planning/segmentation/ct_bones.h"
#include "planning/segmentation/edge_surface.h"

namespace arthronaut::segmentation {

geometry::TriangleMesh label_surface_at_edges(const images::Volume& ct, const images::Volume& labels,
                                              int label) {
  if (ct.size != labels.size) throw InvalidInput("the labels are not of the volume's size");
  const auto wanted = static_cast<float>(label);
  const auto bounds = images::bounds_of_label(labels, label);
  if (!bounds) throw InvalidInput("the volume holds no label " + std::to_string(label));
  // The profiles across the edge need room.
  constexpr double kRoom_mm = 3;
  const Eigen::Vector3i room = (kRoom_mm * ct.spacing_mm().cwiseInverse()).array().ceil().cast<int>();
  Box box;
  box.first = (bounds->low - room).cwiseMax(0);
  box.size =
      (bounds->high + room).cwiseMin(ct.size - Eigen::Vector3i::Ones()) - box.first + Eigen::Vector3i::Ones();
  images::VoxelMask solid(box.size), others(box.size);
  std::size_t v = 0;
  for (int k = 0; k < box.size.z(); ++k) {
    for (int j = 0; j < box.size.y(); ++j) {
      for (int i = 0; i < box.size.x(); ++i, ++v) {
        const float here = labels.at(box.first.x() + i, box.first.y() + j, box.first.z() + k);
        solid.inside[v] = here == wanted;
        others.inside[v] = here != wanted && here != 0;
      }
    }
  }
  return edge_surface(ct, box, solid, others, {.threshold = CtBonesOptions{}.threshold_for(ct)});
}

}  // namespace arthronaut::segmentation
