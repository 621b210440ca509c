// What was touched, laid on the 3D bone: strokes coloured and thickened by how far they lie off it, and how
// well each part of the bone nearby is held.
#pragma once

#include <vector>

#include "app/scene/scene_content.h"
#include "navigation/operation/operation_state.h"

namespace arthronaut::navigate {

inline constexpr scene::Color kDoubtColor{0.94F, 0.75F, 0.24F}, kOffColor{1.0F, 0.44F, 0.36F};
inline constexpr scene::Color kExcludedColor{0.45F, 0.48F, 0.52F};
// Drawn, and nobody knows whether on the bone: until a registration is sure, the pose that the strokes are
// laid by is fitted to them, wherever the tip was.
inline constexpr scene::Color kDrawnColor{0.85F, 0.88F, 0.92F};

class TouchedPicture {
 public:
  // Adds the strokes of `state`, laid on the bone by the registration in force or else by the one that runs
  // along, by which none is called touched yet; the selected stroke is thicker. Nothing without a pose.
  // Distances are kept from call to call.
  void add_strokes(scene::SceneContent& content, const operation::RegistrationState& state,
                   const geometry::Surface& surface, int selected_curve);

 private:
  struct Point {
    int curve;
    Eigen::Vector3d in_bone_mm;
    double residual_mm;
  };
  std::shared_ptr<const strokes::Curves> drawn_;  // that the points below were made of
  geometry::RigidTransform marker_from_bone_;
  std::vector<Point> points_;
};

// A disc on every part of the bone near the strokes: white where one was drawn, orange and the larger the
// more a stroke there would help, grey where it is held already.
void add_patches(scene::SceneContent& content, const registration::Coach& coach);

}  // namespace arthronaut::navigate
