// What of a message the other process believes, whatever its bytes say. Inner header of import.
#pragma once

#include <string>

#include "planning/import/bone_import.h"
#include "planning/import/series_process.h"

namespace arthronaut::importing {

// What a header says of a series, and what is wrong with a file: longer ones are cut off before they are
// sent, and not believed.
inline constexpr std::size_t kLongestText_bytes = 4096;

// No longer than kLongestText_bytes, cut between two characters.
[[nodiscard]] std::string clipped(std::string text);
void clip_texts(images::SeriesList& list);

// Throw InvalidInput where a value is none of its kind: a number that is not finite, a vertex that is not
// there, a picture of another size than its pixels, a text that is longer.
void refuse_unsound(const ImportProgress& progress);
void refuse_unsound(const Failure& failure);
void refuse_unsound(images::SeriesList& list);
void refuse_unsound(const SeriesPicture& picture);
void refuse_unsound(const BoneImport& import);

}  // namespace arthronaut::importing
