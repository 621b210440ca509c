// What kind of thing pictures come from. It decides what they may be taken for: nothing that was found in a
// simulation is ever used on a patient.
#pragma once

#include <optional>
#include <string_view>

namespace arthronaut::sources {

enum class SourceKind {
  Live,        // a device: frames come at their own pace and can be missed
  Recording,   // a file that was made before
  Simulation,  // rendered: nobody's knee
};

// "live", "recording", "simulation": as in files.
[[nodiscard]] constexpr std::string_view to_text(SourceKind kind) {
  return kind == SourceKind::Live ? "live" : kind == SourceKind::Recording ? "recording" : "simulation";
}

// nullopt for any other word.
[[nodiscard]] constexpr std::optional<SourceKind> source_kind_from_text(std::string_view text) {
  for (const SourceKind kind : {SourceKind::Live, SourceKind::Recording, SourceKind::Simulation})
    if (text == to_text(kind)) return kind;
  return std::nullopt;
}

}  // namespace arthronaut::sources
