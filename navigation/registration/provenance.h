// What a registration is of. It holds for this mesh of this bone, under this world marker where it was
// placed, seen by this camera through this medium, drawn with this probe, in pictures of this kind. Whatever
// differs makes it void: the number beside the plan would be of another knee, another moment or no knee at
// all.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "navigation/camera/camera_model.h"
#include "navigation/sources/source_kind.h"
#include "navigation/tools/tool_set.h"
#include "planning/bones/bone.h"

namespace arthronaut::registration {

struct Provenance {
  std::string mesh_sha256;  // bones::mesh_sha256; empty: not known, matches any
  bones::BoneKind bone = bones::BoneKind::Femur;
  int world_marker_id = -1;
  // How often the world marker was placed anew in this operation. Nobody can tell from files: they do not
  // carry it.
  int placement = 0;
  std::string camera, tools;    // camera_identity(), tools_identity(); empty: not known, matches any
  double refractive_index = 1;  // of the working medium
  sources::SourceKind source = sources::SourceKind::Simulation;
};

// In the order in which they are told: what can never be mended first.
enum class Mismatch { Bone, Mesh, SourceKind, WorldMarker, Placement, Camera, Tools, Medium };
// "the medium was saline and is air now"; one clause, for a person.
[[nodiscard]] std::string in_words(Mismatch mismatch, const Provenance& of, const Provenance& now);
[[nodiscard]] std::string_view to_text(Mismatch mismatch);  // "bone", "mesh", ..., for journal and tests

// The first thing that differs; nullopt: it holds.
[[nodiscard]] std::optional<Mismatch> mismatch_of(const Provenance& of, const Provenance& now);
// The same, wherever the world marker sits: for what does not depend on it. Allocates nothing.
[[nodiscard]] std::optional<Mismatch> mismatch_but_placement(const Provenance& of, const Provenance& now);
// Whether a touch on bone that is known can show that it holds all the same. Never for another mesh, bone or
// marker, and never between a simulation and anything real: there a touch that fits is chance.
[[nodiscard]] bool can_be_confirmed(const Provenance& of, const Provenance& now);

// SHA-256 over the numbers of the calibration: the same for the same camera.json.
[[nodiscard]] std::string camera_identity(const camera::Calibration& calibration);
// SHA-256 over what a registration depends on: the bone's world marker and the probe, not the guides.
[[nodiscard]] std::string tools_identity(const tools::ToolSet& tools, bones::BoneKind bone,
                                         std::string_view probe_name);
// The same over what a tunnel is drilled by, which no registration depends on: the guide and the drills.
[[nodiscard]] std::string guides_identity(const tools::ToolSet& tools, std::string_view guide_name);

}  // namespace arthronaut::registration
