#include "app/paint/paint_words.h"

#include <cmath>

namespace arthronaut::paint {

using painting::Layer;

std::string next_step(const painting::Painting& painting, Preview preview, bool is_working) {
  if (preview == Preview::Threshold)
    return "Up and Down move the threshold; Enter takes what is coloured, Esc leaves it";
  if (preview == Preview::Growth)
    return is_working ? "Growing ... go on painting where it will be wrong"
                      : "Paint where it is wrong, and it grows again; Enter takes it, Esc leaves it";
  const bool has_femur = painting.holds(Layer::Strokes, painting::kFemur),
             has_tibia = painting.holds(Layer::Strokes, painting::kTibia),
             has_around = painting.holds(Layer::Strokes, painting::kSurroundings);
  const bool is_one_bone =
      painting.holds(Layer::Bones, painting::kFemur) != painting.holds(Layer::Bones, painting::kTibia);
  if (is_one_bone && painting.volume().modality == "CT")
    return !has_femur || !has_tibia
               ? "Paint a stroke into each bone, also into its marrow (S, then 1 and 2; 3 for fibula and "
                 "patella); then part them (P)"
               : "Part the bones by their strokes (P), or go on with this one alone (A)";
  if (painting.holds(Layer::Bones) && painting.volume().modality == "CT")
    return "Fill the marrow of each bone (Shift+H), look through the slices, correct, then make the bones "
           "(A)";
  if (painting.holds(Layer::Bones))
    return "Look through the slices, correct with the brush on Bones, then make the bones (A)";
  if (!has_femur && !has_tibia) return "Paint a few strokes into the femur (1) on two or three slices";
  if (!has_femur) return "Paint a few strokes into the femur too (1)";
  if (!has_tibia) return "Paint a few strokes into the tibia too (2)";
  if (!has_around) return "Paint a few strokes into what surrounds the bones (3), close to them";
  return "Grow the bones from the strokes (G)";
}

std::vector<QualityLine> quality_lines(const BoneQuality& quality) {
  using widgets::Severity;
  std::vector<QualityLine> lines;
  const double off = quality.painted_ml > 0 ? quality.surface_ml / quality.painted_ml - 1 : 1;
  const bool is_off = !(std::abs(off) <= kMostVolumeOff_fraction);
  lines.push_back({is_off ? Severity::Caution : Severity::Good, "Volume",
                   widgets::fixed(quality.surface_ml, 1) + " ml, painted " +
                       widgets::fixed(quality.painted_ml, 1) + " ml" +
                       (is_off ? ": parts of it were left out, or rounded off" : "")});
  lines.push_back({quality.is_closed ? Severity::Good : Severity::Bad, "Closed",
                   quality.is_closed ? std::to_string(quality.triangles) + " triangles without a hole"
                                     : "no: it cannot be planned on"});
  lines.push_back({quality.edges_not_manifold == 0 ? Severity::Good : Severity::Caution, "Manifold",
                   quality.edges_not_manifold == 0
                       ? "every edge belongs to two triangles"
                       : std::to_string(quality.edges_not_manifold) + " edges did not, and were mended"});
  if (quality.doubts.empty()) lines.push_back({Severity::Good, "Anatomy", "nothing speaks against it"});
  for (const std::string& doubt : quality.doubts) lines.push_back({Severity::Caution, "Look", doubt});
  return lines;
}

std::string label_name(std::uint8_t label) {
  switch (label) {
    case painting::kFemur:
      return "femur";
    case painting::kTibia:
      return "tibia";
    case painting::kSurroundings:
      return "surroundings";
    default:
      return "eraser";
  }
}

}  // namespace arthronaut::paint
