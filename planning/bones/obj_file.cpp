#include "planning/bones/mesh_formats.h"

namespace arthronaut::bones {

// Wavefront OBJ: "v x y z", "f a b c ..." with a, a/t, a//n or a/t/n, counted from 1 or, below 0, from the
// end.
RawMesh parse_obj(const std::filesystem::path& file, std::string_view text) {
  RawMesh raw;
  raw.format = "OBJ";
  TextCursor cursor(file, text);
  std::vector<std::int32_t> corners;
  while (!cursor.at_end()) {
    const std::string_view key = cursor.word();
    if (key == "v") {
      Eigen::Vector3d v;
      for (int i = 0; i < 3; ++i) v[i] = cursor.number();
      raw.mesh.vertices_mm.push_back(v);
      static_cast<void>(cursor.rest_of_line());  // a weight or a colour may follow
    } else if (key == "f") {
      const auto count = static_cast<std::int64_t>(raw.mesh.vertices_mm.size());
      corners.clear();
      const std::string_view line = cursor.line_left();
      for (TextCursor words(file, line); !words.at_end();) {
        const std::string_view word = words.word();
        const auto number = number_from(word.substr(0, word.find('/')));
        if (!number || *number != std::floor(*number)) cursor.fail("a corner of the face is not an integer");
        const double index = *number < 0 ? static_cast<double>(count) + *number : *number - 1;
        if (index < 0 || index >= static_cast<double>(count)) {
          cursor.fail("the face refers to a vertex that is not among the " + std::to_string(count) +
                      " above it");
        }
        corners.push_back(static_cast<std::int32_t>(index));
      }
      if (corners.size() < 3) cursor.fail("the face has fewer than 3 corners");
      append_polygon(raw.mesh, corners);
      static_cast<void>(cursor.rest_of_line());
    } else {
      // Normals, texture, groups, materials: nothing that the surface needs.
      const std::string_view rest = cursor.rest_of_line();
      if (!key.starts_with('#')) continue;
      for (const std::string_view comment : {key, rest}) {
        if (const auto declared = space_declared_in(comment)) raw.declared_space = declared;
      }
    }
  }
  return raw;
}

}  // namespace arthronaut::bones
