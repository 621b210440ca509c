// registration.json (format "arthronaut.registration", version 1): where the bone lies under its world
// marker, how sure that is, what it made of cartilage, and what it is of.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "navigation/registration/provenance.h"
#include "navigation/registration/registration.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::files {
class JsonObject;
}

namespace arthronaut::registration {

// The surface that it was found on, where there is no operation that could say more.
struct RegisteredMesh {
  std::string sha256;  // bones::mesh_sha256
  geometry::Bounds bounds;
};
[[nodiscard]] RegisteredMesh registered_mesh(const geometry::TriangleMesh& mesh);
// Whether it may be this bone's: the same mesh, or one in its place, as another program or a repair leaves
// it, no face of its bounds further off than 1 mm.
[[nodiscard]] bool may_be(const RegisteredMesh& mesh, const geometry::TriangleMesh& bone);

struct RegistrationRecord {
  RegistrationSummary registration;
  std::optional<Provenance> of;        // files of other programs and of older versions do not say
  std::optional<RegisteredMesh> mesh;  // `arthronaut register` says it
};

// Throws IoError or InvalidInput (file, place, reason). What was written comes back to the last bit, but for
// what the file does not hold: residuals and the marker's placement. Of one that says nothing of cartilage,
// as those of other programs and of older versions, the cartilage was left out.
[[nodiscard]] RegistrationRecord read_registration_record(const std::filesystem::path& file);
[[nodiscard]] RegistrationSummary read_registration_file(const std::filesystem::path& file);
// Atomic. Throws IoError. `of` may be null.
void write_registration_file(const std::filesystem::path& file, const RegistrationSummary& registration,
                             const Provenance* of = nullptr);
void write_registration_file(const std::filesystem::path& file, const RegistrationSummary& registration,
                             const RegisteredMesh& mesh);

// The same document inside another one.
[[nodiscard]] RegistrationRecord registration_record_from(const files::JsonObject& document);
[[nodiscard]] nlohmann::ordered_json to_json(const RegistrationSummary& registration, const Provenance* of);
// Its part `of` alone, also without the placement.
[[nodiscard]] nlohmann::ordered_json to_json(const Provenance& of);
[[nodiscard]] Provenance provenance_from(const files::JsonObject& document);

}  // namespace arthronaut::registration
