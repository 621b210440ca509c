// Label maps over a slice of their volume: what is painted, as a translucent picture with the labels' borders
// drawn solid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/scene/reslice.h"

namespace arthronaut::scene {

// One of several over each other; a later one covers an earlier one where it has a label.
struct LabelLayer {
  std::span<const std::uint8_t> labels = {};  // in the grid of the volume; empty: see `threshold`
  std::optional<float> threshold = {};        // else label 1 where the volume is at least so bright
  std::vector<std::uint32_t> colors = {};  // of each label from 0 on, as bytes red, green, blue, alpha of the
                                           // inside; alpha 0, and labels beyond: not drawn
};

// `rgba` becomes width * height pixels (alpha not multiplied in), rows from the top: each has the label of
// the voxel that it lies in; clear outside of the volume. A border is opaque, one pixel wide.
void draw_labels(const images::Volume& volume, std::span<const LabelLayer> layers, const SlicePlane& plane,
                 const Eigen::Vector2i& size_px, std::vector<std::uint32_t>& rgba);

}  // namespace arthronaut::scene
