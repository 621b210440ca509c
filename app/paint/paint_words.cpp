#include "app/paint/paint_words.h"

namespace arthronaut::paint {

using painting::Layer;

std::string next_step(const painting::Painting& painting, Preview preview, bool is_working, bool is_of_case,
                      bool makes_bones) {
  if (makes_bones) return "Wait for the surfaces: they are judged here before they are taken. Esc stops";
  if (preview == Preview::Threshold)
    return "Up and Down move the threshold; Enter takes what is coloured, Esc leaves it";
  if (preview == Preview::Growth)
    return is_working ? "Growing ... go on painting where it will be wrong"
                      : "Paint where it is wrong, and it grows again; Enter takes it, Esc leaves it";
  if (is_of_case)
    return "These are the bones of the case: correct them with brush (B) and eraser (E), then make the bones "
           "(A)";
  const bool has_femur = painting.holds(Layer::Strokes, painting::kFemur),
             has_tibia = painting.holds(Layer::Strokes, painting::kTibia),
             has_around = painting.holds(Layer::Strokes, painting::kSurroundings);
  const bool is_one_bone =
      painting.holds(Layer::Bones, painting::kFemur) != painting.holds(Layer::Bones, painting::kTibia);
  if (is_one_bone && painting.volume().modality == images::Modality::Ct)
    return !has_femur || !has_tibia
               ? "Paint a stroke into each bone, also into its marrow (S, then 1 and 2; 3 for fibula and "
                 "patella); then part them (P)"
               : "Part the bones by their strokes (P), or go on with this one alone (A)";
  if (painting.holds(Layer::Bones) && painting.volume().modality == images::Modality::Ct)
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

widgets::Severity severity_of(importing::QualityVerdict verdict) {
  switch (verdict) {
    case importing::QualityVerdict::Good:
      return widgets::Severity::Good;
    case importing::QualityVerdict::Caution:
      return widgets::Severity::Caution;
    case importing::QualityVerdict::Bad:
      return widgets::Severity::Bad;
    case importing::QualityVerdict::NotChecked:
      return widgets::Severity::Quiet;
  }
  return widgets::Severity::Bad;
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
