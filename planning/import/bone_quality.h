// What a person judges a bone by that was made from labels: what was labelled against what became of it,
// closed, manifold, plausible. The same lines on the screen, on paper and in the command line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "planning/images/volume.h"
#include "planning/import/bone_import.h"
#include "planning/segmentation/bone_beneath.h"

namespace arthronaut::importing {

struct BoneQuality {
  bones::BoneKind kind = bones::BoneKind::Femur;
  double labelled_ml = 0, surface_ml = 0;
  bool is_closed = false;
  std::size_t edges_not_manifold = 0;  // that were found, and mended
  std::size_t triangles = 0;
  // Of an MR: so thick a rim, dark as cortex is, lies outside of the surface (segmentation/dark_rim.h); 0
  // where none is seen.
  double cortex_outside_mm = 0;
  double roughness_mm = 0;            // see segmentation/surface_roughness.h
  segmentation::BoneBeneath beneath;  // whether bone lies beneath all of the surface
  std::vector<std::string> doubts;    // of the mesh and of its shape; empty: nothing speaks against it
};

// images: that it was labelled in.
[[nodiscard]] BoneQuality quality_of(const BoneImport& import, const ImportedBone& made, double labelled_ml,
                                     const images::Volume& images);

enum class QualityVerdict {
  Good,
  Caution,
  Bad,        // it cannot be planned on
  NotChecked  // what was to be looked at could not be: no tick
};
struct QualityLine {
  QualityVerdict verdict = QualityVerdict::Good;
  std::string name, text;  // "Closed", "81234 triangles without a hole"
};
// Bones are smoother, and ragged ones rougher, by half.
inline constexpr double kRough_mm = 0.3;
// A surface that holds more than this share less or more than what was labelled is to be looked at.
inline constexpr double kMostVolumeOff_fraction = 0.05;
[[nodiscard]] std::vector<QualityLine> quality_lines(const BoneQuality& quality);
// What the lines say of the surface that the case is to keep with the bone: that no bone lies beneath a part
// of it, that it is rough. Empty where nothing is.
[[nodiscard]] std::vector<std::string> surface_doubts(const BoneQuality& quality);

}  // namespace arthronaut::importing
