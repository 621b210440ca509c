// What the shapes of the imported bones say of the side, and of the axes that the file claims. Inner header
// of import.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/import/bone_import.h"

namespace arthronaut::importing {

// What speaks against it as that bone (segmentation/anatomy_check.h). Where it lies in the file in a way in
// which no knee lies in a scanner, and is that bone all the same once it is put upright by its own shape,
// this is said in its place.
[[nodiscard]] std::vector<std::string> shape_doubts(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                                    std::span<const Eigen::Vector3d> image_ends);

// Proposes landmarks for each bone that nothing speaks against yet (landmarks/propose.h; seconds a bone) and
// adds a doubt where one lies as above, or where the fronts of all bones look backwards: a file of another
// convention (RAS read as LPS turns a knee by half a turn, so that it stays a whole knee, of the same side).
// Which side a shape tells stays with the bone (side_by_shape). Without a side, one that both bones tell
// alike is taken, as a doubt: of a bone alone the shape misleads too often. `fibula_was_seen`: the side needs
// no judging.
void check_shapes(BoneImport& import, bool fibula_was_seen);

}  // namespace arthronaut::importing
