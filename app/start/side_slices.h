// Images of which nobody has said the knee: slices that show where the fibula lies, with the patient's sides
// beside them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"
#include "navigation/worker/awaited.h"
#include "planning/images/volume.h"
#include "planning/images/volume_writer.h"

namespace arthronaut::start {

struct SideSlice {
  std::string words = {};  // "from in front, behind the middle"
  std::array<std::string, 4> letters =
      {};  // at its left, right, upper and lower edge, as in "R", "L", "H", "F"
  Eigen::Vector2i size_px{0, 0};
  std::vector<std::uint8_t> grey = {};  // rows from the top
};
// Two from in front, in the middle and behind it, where the fibula lies, and two across the leg below the
// joint, as seen from the feet. The patient's right is at the left of each.
[[nodiscard]] std::vector<SideSlice> side_slices(const images::Volume& volume, int longest_side_px);

class SideSlices {
 public:
  // wake: ends the window's wait, from any thread.
  explicit SideSlices(std::function<void()> wake) : wake_(std::move(wake)) {}

  void show(const images::EncodedVolume& volume);  // made beside the screen
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
