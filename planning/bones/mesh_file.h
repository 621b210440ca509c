// Bone surfaces in the files that other programs write: STL (text, binary), PLY (text, binary), OBJ, legacy
// VTK, VTP.
//
// The readers are strict: a file that is cut off, holds a number that is not finite, or refers to a vertex
// that it does not have is refused with the file, the place (byte, line, triangle or vertex) and the reason,
// and nothing is returned. VTK's readers return what they could make of such files, mostly without a word; so
// the formats that are simple enough are read here. VTP, whose compressed blocks are not, is read by VTK and
// checked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::bones {

// The patient axes of a file: +x left, +y posterior, +z superior, or +x right, +y anterior, +z superior.
enum class Space { LPS, RAS };
enum class LengthUnit { Millimetre, Centimetre, Metre, Inch };

[[nodiscard]] std::string_view to_text(Space space);      // "lps", "ras"
[[nodiscard]] std::string_view to_text(LengthUnit unit);  // "mm", "cm", "m", "in"
// Throw InvalidInput for any other word. Case does not matter for the space.
[[nodiscard]] Space space_from_text(std::string_view text);
[[nodiscard]] LengthUnit length_unit_from_text(std::string_view text);
[[nodiscard]] double mm_per(LengthUnit unit);

struct MeshFileOptions {
  // Overrides what the file says. A file that says nothing is in LPS.
  std::optional<Space> space;
  // Without it the file is taken to be in mm, and refused when no knee bone in mm has that size
  // (kSmallestBone_mm to kLargestBone_mm, largest extent of the box). With it, when it is too large.
  std::optional<LengthUnit> unit;
};
inline constexpr double kSmallestBone_mm = 30.0;  // half the width of a child's tibial plateau
inline constexpr double kLargestBone_mm = 700.0;  // longer than any femur

struct MeshFile {
  geometry::TriangleMesh mesh;  // LPS, mm; as found otherwise: neither closed nor oriented for sure
  std::string format;           // "binary STL"
  Space space_in_file = Space::LPS;
  bool space_was_declared = false;  // in the file
  LengthUnit unit_in_file = LengthUnit::Millimetre;
};

// The format is told by the extension, and text or binary by the contents. Polygons are cut into triangles,
// the equal points of an STL become one. Throws IoError when the file cannot be read, else InvalidInput.
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& file, const MeshFileOptions& options = {});
[[nodiscard]] geometry::TriangleMesh read_mesh(const std::filesystem::path& file,
                                               const MeshFileOptions& options = {});

// True for the extensions that read_mesh_file takes, upper or lower case.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& file);

// Binary little-endian PLY, double coordinates, LPS, mm. Atomic. Throws IoError; InvalidInput when a
// coordinate is not finite or an index is out of range (nothing is written then). about: a line on what the
// mesh is, in the header.
void write_mesh_ply(const std::filesystem::path& file, const geometry::TriangleMesh& mesh,
                    const std::string& about = "");
// Binary STL, float coordinates as the format has it. Atomic, errors as above. Of `about` as much as the 80
// bytes of the header hold.
void write_mesh_stl(const std::filesystem::path& file, const geometry::TriangleMesh& mesh,
                    const std::string& about = "");
// The bytes of such a file; `name` stands in messages.
[[nodiscard]] std::string mesh_as_stl(const std::filesystem::path& name, const geometry::TriangleMesh& mesh,
                                      const std::string& about = "");

}  // namespace arthronaut::bones
