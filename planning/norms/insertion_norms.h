// Where studies found the ligament's insertions, in percent of the grids of landmarks/insertion_grids.h.
// Means of studies with their spread and their source: no limits of safety; the surgeon decides.
#pragma once

#include <string>
#include <string_view>

#include "planning/bones/bone.h"

namespace arthronaut::norms {

// Which bundle of the ligament: the whole of it (one tunnel), or one of its two.
enum class Bundle { Whole, Anteromedial, Posterolateral };
[[nodiscard]] std::string_view to_text(Bundle bundle);  // "single", "am", "pl", as on the command line
// Throws InvalidInput for any other word.
[[nodiscard]] Bundle bundle_from_text(std::string_view text);

struct PercentNorm {
  double mean = 0, sd = 0;  // of the grid, between knees
};

struct InsertionNorm {
  bones::BoneKind bone = bones::BoneKind::Femur;
  Bundle bundle = Bundle::Whole;
  // Femur: deep to shallow along Blumensaat's line; high to low. Tibia: anterior to posterior; medial to
  // lateral.
  PercentNorm along, across;
  std::string_view source;
  bool is_recalled = false;  // the number was not re-read in its source: see cited()
};

[[nodiscard]] const InsertionNorm& default_norm(bones::BoneKind bone, Bundle bundle);
// Its source as a person is shown it, "..., customary" where the number is recalled.
[[nodiscard]] std::string cited(const InsertionNorm& norm);

}  // namespace arthronaut::norms
