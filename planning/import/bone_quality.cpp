#include "planning/import/bone_quality.h"

#include <cmath>
#include <utility>

#include "planning/files/format.h"
#include "planning/import/import_side.h"
#include "planning/segmentation/dark_rim.h"
#include "planning/segmentation/surface_roughness.h"

namespace arthronaut::importing {

BoneQuality quality_of(const BoneImport& import, const ImportedBone& made, double labelled_ml,
                       const images::Volume& images) {
  const segmentation::DarkRim rim = segmentation::rim_outside(made.bone.mesh, images);
  return {.kind = made.bone.kind,
          .labelled_ml = labelled_ml,
          .surface_ml = made.repair.volume_mm3 / 1000,
          .is_closed = made.repair.is_closed,
          .edges_not_manifold = made.repair.edges_not_manifold,
          .triangles = made.repair.triangles_now,
          .cortex_outside_mm = rim.is_seen() ? rim.thickness_mm : 0,
          .roughness_mm = segmentation::roughness_mm(made.bone.mesh),
          .beneath = segmentation::bone_beneath(made.bone.mesh, images),
          .doubts = cases::words_of(doubts_with(import, made, import.side))};
}

namespace {

std::string leak_doubt(const BoneQuality& quality) {
  if (quality.beneath.outcome != segmentation::BoneBeneath::Outcome::NotEverywhere) return "";
  return files::format("no bone is seen beneath %.0f cm\u00B2 of the surface, ", quality.beneath.area_cm2) +
         quality.beneath.reason + ": has it run into soft tissue?";
}

std::string rough_doubt(const BoneQuality& quality) {
  if (quality.roughness_mm < kRough_mm) return "";
  return files::format("rough by %.1f mm, a bone by less than 0.2: smooth it, or paint where it ran out",
                       quality.roughness_mm);
}

}  // namespace

std::vector<std::string> surface_doubts(const BoneQuality& quality) {
  std::vector<std::string> doubts;
  if (std::string leak = leak_doubt(quality); !leak.empty()) doubts.push_back(std::move(leak));
  if (const std::string rough = rough_doubt(quality); !rough.empty())
    doubts.push_back("its surface is " + rough);
  return doubts;
}

std::vector<QualityLine> quality_lines(const BoneQuality& quality) {
  using enum QualityVerdict;
  std::vector<QualityLine> lines;
  const double off = quality.labelled_ml > 0 ? quality.surface_ml / quality.labelled_ml - 1 : 1;
  const bool is_off = !(std::abs(off) <= kMostVolumeOff_fraction);
  lines.push_back({is_off ? Caution : Good, "Volume",
                   files::format("%.1f ml, painted %.1f ml", quality.surface_ml, quality.labelled_ml) +
                       (is_off ? ": parts of it were left out, or rounded off" : "")});
  lines.push_back({quality.is_closed ? Good : Bad, "Closed",
                   quality.is_closed
                       ? std::to_string(quality.triangles) + " triangles, two at every edge, without a hole"
                       : "no: it cannot be planned on"});
  if (quality.edges_not_manifold > 0)
    lines.push_back(
        {Caution, "Edges",
         std::to_string(quality.edges_not_manifold) + " had not two triangles each, and were mended"});
  if (quality.cortex_outside_mm > 0)
    lines.push_back(
        {Caution, "Cortex",
         files::format("a rim of %.1f mm, dark as cortex is in an MR, lies outside: the bone is so "
                       "much larger all about, and walls are thicker than they are said to be",
                       quality.cortex_outside_mm)});
  if (const std::string rough = rough_doubt(quality); !rough.empty())
    lines.push_back({Caution, "Surface", rough});
  using Outcome = segmentation::BoneBeneath::Outcome;
  if (const std::string leak = leak_doubt(quality); !leak.empty())
    lines.push_back({Caution, "Grey values", leak});
  else if (quality.beneath.outcome == Outcome::NotChecked)
    lines.push_back({NotChecked, "Grey values", "not checked: " + quality.beneath.reason});
  else
    lines.push_back({Good, "Grey values", "bone lies beneath all of the surface"});
  if (quality.doubts.empty()) lines.push_back({Good, "Shape", "nothing speaks against it"});
  for (const std::string& doubt : quality.doubts) lines.push_back({Caution, "Look", doubt});
  return lines;
}

}  // namespace arthronaut::importing
