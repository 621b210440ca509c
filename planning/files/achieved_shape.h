// Two files are called achieved.json and have one format name: in a session's folder what navigation measured
// of a tunnel, in a case's what `arthronaut compare` found in a CT. Whoever is given the other one says so.
#pragma once

#include "planning/files/json_document.h"

namespace arthronaut::files {

enum class AchievedShape { OfSession, OfComparison };

// Throws what read_json() throws, and InvalidInput for the other shape: what the file is and what is needed.
[[nodiscard]] JsonObject read_achieved(const std::filesystem::path& file, AchievedShape needed);

}  // namespace arthronaut::files
