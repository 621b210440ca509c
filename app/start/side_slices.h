// Images of which nobody has said the knee: slices that show where the fibula lies, with the patient's sides
// beside them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"
#include "navigation/worker/awaited.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"
#include "planning/import/bone_import.h"

namespace arthronaut::start {

struct SideSlice {
  std::string words = {};  // "Across, 25 mm below the joint"
  std::array<std::string, 4> letters =
      {};  // at its left, right, upper and lower edge, as in "R", "L", "H", "F"
  Eigen::Vector2i size_px{0, 0};
  std::vector<std::uint8_t> grey = {};  // rows from the top
};
// Where the tibia lies in the images, LPS.
struct FoundTibia {
  double joint_z_mm = 0, lowest_z_mm = 0;  // lowest: of it that is in view
  bool is_joint_by_femur = false;          // else the joint is taken to be its top
  geometry::Bounds head = {};              // of its upper end, 30 mm below the joint
};
// nullopt: none was made, or so little of it that no slice below the joint shows a fibula.
[[nodiscard]] std::optional<FoundTibia> found_tibia(const importing::BoneImport& import);
// Two from in front, through the middle and the back of the tibia's head, and two across the leg below the
// joint, as seen from the feet, of the region about the tibia. Without one: of all of the images, the places
// named as what they are. The patient's right is at the left of each.
[[nodiscard]] std::vector<SideSlice> side_slices(const images::Volume& volume,
                                                 const std::optional<FoundTibia>& tibia, int longest_side_px);

class SideSlices {
 public:
  // wake: ends the window's wait, from any thread.
  explicit SideSlices(std::function<void()> wake) : wake_(std::move(wake)) {}

  // Of an import that has images; made beside the screen.
  void show(const importing::BoneImport& import);
  void clear();
  // False: there is nothing to be seen, and nothing was drawn.
  bool draw(const widgets::Ui& ui, const widgets::Rect& area);

 private:
  std::function<void()> wake_;
  worker::Awaited<std::vector<SideSlice>> making_;
  std::vector<SideSlice> slices_;
  std::array<widgets::GreyTexture, 4> textures_;
};

}  // namespace arthronaut::start
