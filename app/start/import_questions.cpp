#include "app/start/import_questions.h"

#include <algorithm>

#include "planning/files/format.h"

namespace arthronaut::start {

std::string unit_question(const std::string& mesh, const importing::Failure& refusal) {
  std::string text =
      mesh + files::format(" is %.3g mm large if it is in millimetres, as no bone of the knee is.",
                           refusal.size_in_file);
  for (const bones::LengthUnit unit : refusal.units) {
    const bool is_metre = unit == bones::LengthUnit::Metre, is_inch = unit == bones::LengthUnit::Inch;
    text += files::format(" In %s it is %.0f mm: press %s.",
                          is_metre  ? "metres"
                          : is_inch ? "inches"
                                    : "centimetres",
                          refusal.size_in_file * bones::mm_per(unit),
                          is_metre  ? "M"
                          : is_inch ? "N"
                                    : "C");
  }
  return text;
}

std::string chosen_label(const std::vector<importing::FoundLabel>& labels,
                         const std::map<bones::BoneKind, int>& chosen, bones::BoneKind bone) {
  const auto label = chosen.find(bone);
  if (label == chosen.end()) return "none of the labels";
  const auto found =
      std::find_if(labels.begin(), labels.end(), [&](const auto& of) { return of.label == label->second; });
  if (found == labels.end()) return "label " + std::to_string(label->second);
  const Eigen::Vector3d size = found->highest_mm - found->lowest_mm;
  return files::format("label %d: %.3g cm\u00B3, %.0f x %.0f x %.0f mm", found->label, found->volume_cm3,
                       size.x(), size.y(), size.z());
}

void choose_next_label(const std::vector<importing::FoundLabel>& labels,
                       std::map<bones::BoneKind, int>& chosen, bones::BoneKind bone) {
  const auto other =
      chosen.find(bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia : bones::BoneKind::Femur);
  const auto now = chosen.find(bone);
  for (const importing::FoundLabel& label : labels) {
    if (now != chosen.end() && label.label <= now->second) continue;
    if (other != chosen.end() && label.label == other->second) continue;
    chosen[bone] = label.label;
    return;
  }
  chosen.erase(bone);
}

}  // namespace arthronaut::start
