// What an edit changed of a label map, kept small for undo: runs of neighbouring voxels that had one label
// and got another. A stroke is some hundred runs, a grown knee some hundred thousand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/segmentation/seed_growth.h"

namespace arthronaut::painting {

using segmentation::Labels;

// What the numbers of a label map stand for, in strokes and in bones. Strokes alone hold surroundings.
inline constexpr std::uint8_t kNothing = 0, kFemur = 1, kTibia = 2, kSurroundings = 3;

struct LabelRun {
  std::uint32_t first = 0, count = 0;  // voxels, i runs fastest
  std::uint8_t before = kNothing, after = kNothing;
};

class LabelChange {
 public:
  // A voxel that got another label. In the order in which it happened: the same voxel may change again.
  void note(std::size_t voxel, std::uint8_t before, std::uint8_t after);
  [[nodiscard]] bool is_empty() const { return runs_.empty(); }
  [[nodiscard]] const std::vector<LabelRun>& runs() const { return runs_; }
  // Of a label map that is as it was before, or after.
  void redo(Labels& labels) const;
  void undo(Labels& labels) const;

 private:
  std::vector<LabelRun> runs_;
};

// Precondition: of the same size.
[[nodiscard]] LabelChange change_between(std::span<const std::uint8_t> before,
                                         std::span<const std::uint8_t> after);

}  // namespace arthronaut::painting
