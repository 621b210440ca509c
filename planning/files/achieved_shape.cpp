#include "planning/files/achieved_shape.h"

#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace {

constexpr std::string_view kFormat = "arthronaut.achieved";
// Of a session's: one that was taken back has 2. A comparison's is 1.
constexpr int kNewestOfSession = 2, kNewestOfComparison = 1;

}  // namespace

JsonObject read_achieved(const std::filesystem::path& file, AchievedShape needed) {
  const JsonObject root = read_json(file, kFormat, kNewestOfSession);
  const bool is_of_session = root.has("measured"), is_of_comparison = root.has("tunnels");
  if (needed == AchievedShape::OfComparison && is_of_session && !is_of_comparison)
    throw InvalidInput(
        file, "measured",
        "this is what navigation measured of one tunnel, as a session keeps it; what `arthronaut "
        "compare` found in a CT after the operation is needed (\"tunnels\" and \"bones\")");
  if (needed == AchievedShape::OfSession && is_of_comparison && !is_of_session)
    throw InvalidInput(
        file, "tunnels",
        "this is what `arthronaut compare` found in a CT after the operation; what navigation "
        "measured of one tunnel, as a session keeps it, is needed (\"planned\" and \"measured\")");
  return needed == AchievedShape::OfSession ? root : read_json(file, kFormat, kNewestOfComparison);
}

}  // namespace arthronaut::files
