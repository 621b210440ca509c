#include "planning/bones/mesh_formats.h"
#include "tests/fuzzing/reader.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::fuzzing {
namespace {

using Parser = bones::RawMesh (*)(const std::filesystem::path&, std::string_view);

std::string what_is_wrong(const bones::RawMesh& raw) {
  for (const auto& v : raw.mesh.vertices_mm) {
    if (!v.allFinite()) return "a vertex that is not finite";
  }
  for (const auto& t : raw.mesh.triangles) {
    for (const auto v : t) {
      if (v < 0 || static_cast<std::size_t>(v) >= raw.mesh.vertices_mm.size())
        return "a corner without vertex";
    }
  }
  return "";
}

Reader reader_of(const std::string& name, Parser parse) {
  const std::string ending = "." + name;
  return {name, "input" + ending,
          [ending](const std::filesystem::path&) {
            auto forms = test::all_forms(test::ellipsoid({40, 30, 25}, 0), "SPACE=LPS");
            std::erase_if(forms, [&](const auto& form) { return !form.first.ends_with(ending); });
            return forms;
          },
          [parse, ending](const std::filesystem::path&, std::string_view bytes) {
            return what_is_wrong(parse("input" + ending, bytes));
          }};
}

}  // namespace

std::vector<Reader> mesh_readers() {
  return {reader_of("stl", bones::parse_stl), reader_of("ply", bones::parse_ply),
          reader_of("obj", bones::parse_obj), reader_of("vtk", bones::parse_legacy_vtk),
          reader_of("vtp", bones::parse_vtp)};
}

}  // namespace arthronaut::fuzzing
