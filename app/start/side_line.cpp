#include "app/start/side_line.h"

#include "planning/import/import_side.h"

namespace arthronaut::start {

using widgets::Severity;

SideLine side_line(const importing::BoneImport& import, std::optional<bones::Side> side, bool was_said) {
  if (!side) return {Severity::Caution, "neither names nor images tell: press R or L"};
  const std::string word(bones::to_text(*side));
  const std::string by_name = import.side_is_by_segment  ? ", by the name of a segment"
                              : import.side_is_by_images ? ", as the images are marked"
                                                         : ", by the name of the source";
  if (import.side_in_images && *import.side_in_images != *side) {
    const char* told_by = was_said                  ? ", as you say"
                          : import.side_is_by_shape ? ", by the shape of the bones"
                          : import.side_was_seen    ? ", by the fibula"
                                                    : "";
    return {Severity::Bad, word + told_by + ", but the images are marked as those of a " +
                               std::string(bones::to_text(*import.side_in_images)) +
                               " knee: look at the picture"};
  }
  if (was_said && import.side_was_seen && import.side != side)
    return {import.side_is_by_shape ? Severity::Caution : Severity::Bad,
            word + ", as you say, but " +
                (import.side_is_by_shape ? "the bones are shaped" : "the fibula lies") + " as in a " +
                std::string(bones::to_text(*import.side)) + " knee: look at the picture"};
  if (import.side_is_contradicted && import.side == side)
    return {Severity::Bad, word + (was_said ? ", as you say" : by_name) +
                               ", but the bones speak against it, see below: look at the picture"};
  if (const auto shape = importing::side_by_shapes(import); was_said && shape && *shape != *side)
    return {Severity::Caution, word + ", as you say, but the bones are shaped as in a " +
                                   std::string(bones::to_text(*shape)) + " knee: look at the picture"};
  if (was_said) return {Severity::Good, word + ", as you say"};
  if (import.side_was_guessed) return {Severity::Caution, word + by_name + ": is that so? Press R or L"};
  if (import.side_is_by_shape)
    return {Severity::Caution, word + ", by the shape of the bones alone: is that so? Press R or L"};
  if (import.side_was_seen) return {Severity::Good, word + ", by the fibula"};
  return {Severity::Good, word};
}

}  // namespace arthronaut::start
