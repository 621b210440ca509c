#include "planning/bones/mesh_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "planning/bones/mesh_formats.h"
#include "planning/bones/unit_unknown.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

struct UnitName {
  LengthUnit unit;
  std::string_view name, plural;
  double mm;
};
constexpr std::array<UnitName, 4> kUnits{{{LengthUnit::Millimetre, "mm", "millimetres", 1.0},
                                          {LengthUnit::Centimetre, "cm", "centimetres", 10.0},
                                          {LengthUnit::Metre, "m", "metres", 1000.0},
                                          {LengthUnit::Inch, "in", "inches", 25.4}}};

struct Format {
  std::string_view extension;
  RawMesh (*parse)(const std::filesystem::path&, std::string_view);
};
constexpr std::array<Format, 5> kFormats{{{".stl", parse_stl},
                                          {".ply", parse_ply},
                                          {".obj", parse_obj},
                                          {".vtk", parse_legacy_vtk},
                                          {".vtp", parse_vtp}}};

const Format* format_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) {
    return equal_ignoring_case(f.extension, extension);
  });
  return found == kFormats.end() ? nullptr : found;
}

bool is_size_of_bone(double size_mm) { return size_mm >= kSmallestBone_mm && size_mm <= kLargestBone_mm; }

std::vector<LengthUnit> units_of_bone(double size) {
  std::vector<LengthUnit> fitting;
  for (const auto& unit : kUnits)
    if (is_size_of_bone(size * unit.mm)) fitting.push_back(unit.unit);
  return fitting;
}

// Why a mesh without a stated unit is refused, and what would make a bone of it.
std::string wrong_size(double size) {
  std::string text =
      files::format("is %.3g", size) + " mm large if it is in millimetres, which no bone of the knee is";
  std::string fitting;
  for (const LengthUnit fits : units_of_bone(size)) {
    const UnitName& unit = kUnits[static_cast<std::size_t>(fits)];
    fitting += (fitting.empty() ? "" : " or ") + std::string("--unit ") + std::string(unit.name) + " (" +
               std::string(unit.plural) + ")";
  }
  return fitting.empty() ? text + " (nor in cm, m or inches); --unit says otherwise"
                         : text + "; say its unit with " + fitting;
}

// The unit that was said makes it larger than any bone, and another would make a bone of it. What is small
// may be a piece of one.
void refuse_wrong_unit(const std::filesystem::path& file, double size, LengthUnit said) {
  const double size_mm = size * mm_per(said);
  if (size_mm <= kLargestBone_mm) return;
  std::string others;
  for (const LengthUnit fits : units_of_bone(size))
    others += (others.empty() ? "" : " or ") + std::string(to_text(fits));
  if (others.empty()) return;
  throw InvalidInput(file, "",
                     files::format("is %.3g", size_mm) + " mm large if it is in " +
                         std::string(kUnits[static_cast<std::size_t>(said)].plural) +
                         ", which no bone of the knee is; its unit would be " + others);
}

void to_lps_mm(geometry::TriangleMesh& mesh, Space space, double scale) {
  const double flip = space == Space::RAS ? -1 : 1;
  // A half turn about z: it keeps the orientation of the triangles.
  const Eigen::Vector3d factors(flip * scale, flip * scale, scale);
  for (auto& v : mesh.vertices_mm) v = v.cwiseProduct(factors);
}

void refuse_unwritable(const std::filesystem::path& file, const geometry::TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    if (!mesh.vertices_mm[i].allFinite()) {
      throw InvalidInput(file, "vertex " + std::to_string(i + 1),
                         "would be written with a number that is not finite");
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::int32_t v : mesh.triangles[t]) {
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertices_mm.size()) {
        throw InvalidInput(file, "triangle " + std::to_string(t + 1),
                           "would be written with a vertex out of range");
      }
    }
  }
}

template <typename T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little);
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace

std::string_view to_text(Space space) { return space == Space::LPS ? "lps" : "ras"; }
std::string_view to_text(LengthUnit unit) { return kUnits[static_cast<std::size_t>(unit)].name; }
double mm_per(LengthUnit unit) { return kUnits[static_cast<std::size_t>(unit)].mm; }

Space space_from_text(std::string_view text) {
  for (const Space space : {Space::LPS, Space::RAS}) {
    if (equal_ignoring_case(text, to_text(space))) return space;
  }
  throw InvalidInput("\"" + std::string(text) + "\" is not a space: lps or ras");
}

LengthUnit length_unit_from_text(std::string_view text) {
  for (const auto& unit : kUnits) {
    if (text == unit.name) return unit.unit;
  }
  throw InvalidInput("\"" + std::string(text) + "\" is not a unit: mm, cm, m or in");
}

UnitUnknown::UnitUnknown(const std::filesystem::path& file, double size_in_file)
    : InvalidInput(file, "", wrong_size(size_in_file)),
      size_in_file_(size_in_file),
      fitting_units_(units_of_bone(size_in_file)) {}

bool is_mesh_file(const std::filesystem::path& file) { return format_of(file) != nullptr; }

MeshFile read_mesh_file(const std::filesystem::path& file, const MeshFileOptions& options) {
  const std::string text = files::read_text(file);
  const Format* format = format_of(file);
  if (!format) throw InvalidInput(file, "", "is not a mesh this program reads: STL, PLY, OBJ, VTK or VTP");
  if (text.empty()) throw InvalidInput(file, "", "is empty");
  RawMesh raw = format->parse(file, text);
  if (raw.mesh.triangles.empty()) throw InvalidInput(file, "", "holds no triangle");

  MeshFile result;
  result.mesh = std::move(raw.mesh);
  result.format = raw.format;
  result.space_was_declared = raw.declared_space.has_value();
  result.space_in_file = options.space.value_or(raw.declared_space.value_or(Space::LPS));
  result.unit_in_file = options.unit.value_or(LengthUnit::Millimetre);
  const double size = geometry::bounds_of(result.mesh).size_mm().maxCoeff();
  if (options.unit)
    refuse_wrong_unit(file, size, *options.unit);
  else if (!is_size_of_bone(size))
    throw UnitUnknown(file, size);
  to_lps_mm(result.mesh, result.space_in_file, mm_per(result.unit_in_file));
  return result;
}

geometry::TriangleMesh read_mesh(const std::filesystem::path& file, const MeshFileOptions& options) {
  return read_mesh_file(file, options).mesh;
}

void write_mesh_ply(const std::filesystem::path& file, const geometry::TriangleMesh& mesh,
                    const std::string& about) {
  refuse_unwritable(file, mesh);
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment SPACE=LPS\ncomment unit mm\n" +
                      (about.empty() ? "" : "comment " + about + "\n") + "element vertex " +
                      std::to_string(mesh.vertices_mm.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 24 * mesh.vertices_mm.size() + 13 * mesh.triangles.size());
  for (const auto& v : mesh.vertices_mm) {
    for (int i = 0; i < 3; ++i) append(bytes, v[i]);
  }
  for (const auto& t : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::int32_t v : t) append(bytes, v);
  }
  files::write_atomically(file, bytes);
}

std::string mesh_as_stl(const std::filesystem::path& name, const geometry::TriangleMesh& mesh,
                        const std::string& about) {
  refuse_unwritable(name, mesh);
  std::string bytes = "Arthronaut, mm, SPACE=LPS" + (about.empty() ? "" : ", " + about);
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  bytes.reserve(bytes.size() + 50 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices_mm[t[0]], &b = mesh.vertices_mm[t[1]],
                          &c = mesh.vertices_mm[t[2]];
    const Eigen::Vector3d normal = Eigen::Vector3d((b - a).cross(c - a)).stableNormalized();
    for (const Eigen::Vector3d& p : {normal, a, b, c}) {
      for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(p[i]));
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

void write_mesh_stl(const std::filesystem::path& file, const geometry::TriangleMesh& mesh,
                    const std::string& about) {
  files::write_atomically(file, mesh_as_stl(file, mesh, about));
}

}  // namespace arthronaut::bones
