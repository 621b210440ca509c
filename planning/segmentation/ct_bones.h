// Femur and tibia of a knee in a CT, in one go.
//
// What is above the threshold falls into pieces. Slender ones (fibula, patella, splinters) are left out by
// their cross-sections; bones that touch are parted along the joint space; each is filled, and its surface
// taken where its edge is (edge_surface.h). Superior is up by the volume's own axes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/error.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::segmentation {

struct CtBonesOptions {
  // Finds the bones; their surfaces lie at the local edge. Default: 250 HU, 180 HU where voxels are coarse.
  std::optional<double> threshold;
  // Gaps of the cortex up to twice this are closed, then the marrow is filled in.
  double closing_radius_mm = 2.0;
  std::optional<bones::BoneKind> only;                  // this bone alone
  std::optional<bones::Side> side;                      // which knee, where the volume shows both
  std::function<void(double fraction)> tell = nullptr;  // may throw, to stop

  [[nodiscard]] double threshold_for(const images::Volume& volume) const;
};

struct CtBone {
  bones::BoneKind kind = bones::BoneKind::Femur;
  geometry::TriangleMesh mesh;      // LPS, mm, closed; not yet turned outwards
  std::vector<std::string> notes;   // what was chosen, for a person to see
  std::vector<std::string> doubts;  // why it may not be the bone
};

struct CtBones {
  std::vector<CtBone> bones;
  std::vector<std::string> notes;  // on the volume
  // Which side the fibula lies on: that is lateral. Unknown without one.
  std::optional<bones::Side> side_by_fibula;
  std::string why_no_fibula;    // where that is unknown: "no fibula is seen apart from the tibia: ..."
  bool is_one_of_both = false;  // both knees are seen, and the one on the side that was asked for was taken
};

// A volume of both knees, and nobody says which one is meant.
class ShowsBothKnees : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

// Throws ShowsBothKnees, and InvalidInput when no bone of a knee, or not the one that was asked for, is in
// the volume.
[[nodiscard]] CtBones bones_of_ct(const images::Volume& volume, const CtBonesOptions& options = {});

}  // namespace arthronaut::segmentation
