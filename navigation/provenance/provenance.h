// Where the numbers of a camera or a tool come from, and since when: data that travels with them in
// camera.json, tools.json and fluid.json, so that nobody has to guess later from a name or a residual. What
// was found with the simulator is marked so for ever.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::provenance {

enum class Origin {
  Measured,   // calibrated, on real pictures
  Nominal,    // of a drawing, or built in
  Simulated,  // calibrated on pictures of the simulator: true of no scope and no tool
};
[[nodiscard]] std::string_view to_text(Origin origin);  // "measured", "nominal", "simulated": as in files
[[nodiscard]] std::optional<Origin> origin_from_text(std::string_view text);

struct Provenance {
  Origin origin = Origin::Nominal;
  std::string calibrated_utc;  // ISO 8601, "2026-11-21T10:00:00Z"; empty: not known
  friend bool operator==(const Provenance&, const Provenance&) = default;
};

// Of what was found by means of something else (a tip, by a camera): simulated as soon as one of both is.
[[nodiscard]] Origin found_with(Origin itself, Origin by_means_of);

// Days from one time to another, ISO 8601 each ("2026-11-21", or with a time in UTC behind a T); below 0 when
// the second is the earlier one. nullopt when one of them is no date.
[[nodiscard]] std::optional<double> days_between(std::string_view from_utc, std::string_view to_utc);

// The members "origin" and "calibrated_utc" of an entry of a file; an entry without the first one has the
// origin that is given. Throws InvalidInput (file, place, reason) for another word or no date.
[[nodiscard]] Provenance read_provenance(const files::JsonObject& entry, Origin unless_said);

}  // namespace arthronaut::provenance
