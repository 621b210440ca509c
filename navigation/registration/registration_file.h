// registration.json (format "arthronaut.registration", version 1): where the bone lies under its world
// marker, how sure that is, and what it is of; without the use of the cartilage, which the assumptions tell.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "navigation/registration/provenance.h"
#include "navigation/registration/registration.h"

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::registration {

struct RegistrationRecord {
  RegistrationSummary registration;
  std::optional<Provenance> of;  // files of other programs and of older versions do not say
};

// Throws IoError or InvalidInput (file, place, reason). What was written comes back to the last bit, but for
// what the file does not hold: residuals, the use of the cartilage and the marker's placement.
[[nodiscard]] RegistrationRecord read_registration_record(const std::filesystem::path& file);
[[nodiscard]] RegistrationSummary read_registration_file(const std::filesystem::path& file);
// Atomic. Throws IoError. `of` may be null.
void write_registration_file(const std::filesystem::path& file, const RegistrationSummary& registration,
                             const Provenance* of = nullptr);

// The same document inside another one.
[[nodiscard]] RegistrationRecord registration_record_from(const files::JsonObject& document);
[[nodiscard]] nlohmann::ordered_json to_json(const RegistrationSummary& registration, const Provenance* of);
// Its part `of` alone, also without the placement.
[[nodiscard]] nlohmann::ordered_json to_json(const Provenance& of);
[[nodiscard]] Provenance provenance_from(const files::JsonObject& document);

}  // namespace arthronaut::registration
