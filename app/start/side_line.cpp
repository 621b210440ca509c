#include "app/start/side_line.h"

#include "planning/import/import_side.h"

namespace arthronaut::start {

using widgets::Severity;

namespace {

SideLine line_of(const importing::BoneImport& import, std::optional<bones::Side> side, bool was_said) {
  using importing::SideSource;
  if (!side) return {Severity::Caution, "neither names nor images tell: press R or L"};
  const std::string by = importing::told_by(import.side_source);
  const std::string told = std::string(bones::to_text(*side)) + (was_said     ? ", as you say"
                                                                 : by.empty() ? ""
                                                                              : ", " + by);
  const auto against = [&](Severity severity, const char* witness, bones::Side other) {
    return SideLine{severity, told + ", but " + witness + " a " + std::string(bones::to_text(other)) +
                                  " knee: look at the picture"};
  };
  const auto& images = import.side_in_images;
  const auto& fibula = import.side_by_fibula;
  if (images && *images != *side) return against(Severity::Bad, "the images are marked as those of", *images);
  if (fibula && *fibula != *side) return against(Severity::Bad, "the fibula lies as in", *fibula);
  if (import.side == side && importing::side_is_contradicted(import))
    return {Severity::Bad, told + ", but the bones speak against it, see below: look at the picture"};
  const auto shape =
      import.side_source == SideSource::Shapes ? import.side : importing::side_by_shapes(import);
  if (was_said && shape && *shape != *side)
    return against(Severity::Caution, "the bones are shaped as in", *shape);
  if (was_said || import.side_source == SideSource::Person) {
    // A name that says the same has told it, too.
    const bool is_named = is_guess(import.side_source) && import.side == side;
    if (is_named || shape == side || importing::side_is_borne_out(import, *side))
      return {Severity::Good, told};
    return {Severity::Quiet, told + "; nothing in the images or the shape of the bones confirms it"};
  }
  if (fibula && is_guess(import.side_source)) return {Severity::Good, told + ", and the fibula lies so"};
  if (is_guess(import.side_source) || import.side_source == SideSource::Shapes)
    return {Severity::Caution, told + ": is that so? Press R or L"};
  return {Severity::Good, told};
}

}  // namespace

SideLine side_line(const importing::BoneImport& import, std::optional<bones::Side> side, bool was_said) {
  SideLine line = line_of(import, side, was_said);
  line.needs_choice = !was_said && line.severity != Severity::Good;
  if (line.needs_choice && line.severity == Severity::Bad) line.text += ", then press R or L";
  return line;
}

}  // namespace arthronaut::start
