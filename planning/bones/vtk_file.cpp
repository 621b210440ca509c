#include <array>

#include "planning/bones/mesh_formats.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

struct TypeName {
  std::string_view name;
  double (*decode)(const char*);
  std::size_t bytes;
};
template <typename T>
double decode(const char* bytes) {
  return static_cast<double>(scalar_at<T>(bytes, std::endian::big));
}
constexpr std::array<TypeName, 11> kTypes{{{"float", decode<float>, 4},
                                           {"double", decode<double>, 8},
                                           {"int", decode<std::int32_t>, 4},
                                           {"unsigned_int", decode<std::uint32_t>, 4},
                                           {"vtkidtype", decode<std::int32_t>, 4},  // 32 bits in these files
                                           {"vtktypeint64", decode<std::int64_t>, 8},
                                           {"vtktypeint32", decode<std::int32_t>, 4},
                                           {"long", decode<std::int64_t>, 8},
                                           {"short", decode<std::int16_t>, 2},
                                           {"unsigned_char", decode<std::uint8_t>, 1},
                                           {"char", decode<std::int8_t>, 1}}};

// The legacy format: a title line, ASCII or BINARY (big endian), and sections that begin with a keyword.
class LegacyReader {
 public:
  LegacyReader(const std::filesystem::path& file, std::string_view text) : cursor_(file, text) {}

  RawMesh read() {
    read_header();
    while (!cursor_.at_end()) {
      const std::string_view key = cursor_.word();
      if (equal_ignoring_case(key, "POINTS")) {
        read_points();
      } else if (equal_ignoring_case(key, "POLYGONS")) {
        read_cells([this](const std::vector<std::int32_t>& corners) { append_polygon(raw_.mesh, corners); });
      } else if (equal_ignoring_case(key, "TRIANGLE_STRIPS")) {
        read_cells([this](const std::vector<std::int32_t>& corners) { append_strip(corners); });
      } else if (equal_ignoring_case(key, "VERTICES") || equal_ignoring_case(key, "LINES")) {
        read_cells([](const std::vector<std::int32_t>&) {});
      } else if (equal_ignoring_case(key, "METADATA")) {
        static_cast<void>(cursor_.rest_of_line());
        // Ends with an empty line.
        while (!cursor_.bytes().empty() &&
               cursor_.rest_of_line().find_first_not_of("\r ") != std::string_view::npos) {
        }
      } else if (equal_ignoring_case(key, "FIELD")) {
        read_field();
      } else if (equal_ignoring_case(key, "POINT_DATA") || equal_ignoring_case(key, "CELL_DATA")) {
        break;  // values on the surface: nothing that its shape needs
      } else {
        cursor_.fail("unknown section of a VTK file");
      }
    }
    return std::move(raw_);
  }

 private:
  void read_header() {
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    const std::string_view first = cursor_.rest_of_line();
    if (!equal_ignoring_case(first.substr(0, kMagic.size()), kMagic)) cursor_.fail("not a VTK file");
    version_ = number_from(first.substr(kMagic.size(), first.find_last_not_of("\r ") + 1 - kMagic.size()))
                   .value_or(0);
    raw_.declared_space = space_declared_in(cursor_.rest_of_line());
    const std::string_view encoding = cursor_.word();
    is_binary_ = equal_ignoring_case(encoding, "BINARY");
    if (!is_binary_ && !equal_ignoring_case(encoding, "ASCII")) cursor_.fail("expected ASCII or BINARY");
    raw_.format = is_binary_ ? "binary VTK" : "text VTK";
    cursor_.expect("DATASET");
    const std::string_view dataset = cursor_.word();
    if (!equal_ignoring_case(dataset, "POLYDATA"))
      cursor_.fail("holds no surface: expected DATASET POLYDATA");
  }

  std::size_t read_count() {
    const std::int64_t count = cursor_.integer();
    // Each number takes a byte at least.
    if (count < 0 || static_cast<std::size_t>(count) > cursor_.bytes().size()) {
      cursor_.fail("the file is too short for a count of " + std::to_string(count));
    }
    return static_cast<std::size_t>(count);
  }

  const TypeName& read_type() {
    const std::string_view word = cursor_.word();
    for (const auto& type : kTypes) {
      if (equal_ignoring_case(word, type.name)) return type;
    }
    cursor_.fail("unknown type of numbers");
  }

  // Of a coordinate.
  static std::string not_finite(std::size_t number) {
    return "vertex " + std::to_string(number / 3 + 1) + " has a coordinate that is not finite";
  }

  // must_be_finite: in a text the line of one that is not is told as it is read.
  std::vector<double> read_numbers(std::size_t count, const TypeName& type, const char* what,
                                   bool must_be_finite = false) {
    std::vector<double> values;
    values.reserve(count);
    if (!is_binary_) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto value = number_from(cursor_.word());
        if (!value) cursor_.fail("not a number");
        if (must_be_finite && !std::isfinite(*value)) cursor_.fail(not_finite(i));
        values.push_back(*value);
      }
      return values;
    }
    static_cast<void>(cursor_.rest_of_line());
    const std::string_view bytes = cursor_.bytes();
    if (bytes.size() / type.bytes < count) {
      cursor_.fail(std::string("the file ends in number ") + std::to_string(bytes.size() / type.bytes + 1) +
                   " of " + std::to_string(count) + " of the " + what);
    }
    for (std::size_t i = 0; i < count; ++i) values.push_back(type.decode(bytes.data() + i * type.bytes));
    cursor_.skip_bytes(count * type.bytes);
    return values;
  }

  void read_points() {
    if (!raw_.mesh.vertices_mm.empty()) cursor_.fail("a second section of points");
    const std::size_t count = read_count();
    const auto values = read_numbers(3 * count, read_type(), "points", true);
    for (std::size_t i = 0; i < count; ++i) {
      raw_.mesh.vertices_mm.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      if (!raw_.mesh.vertices_mm.back().allFinite()) cursor_.fail(not_finite(3 * i));
    }
  }

  std::int32_t vertex(double index, std::size_t cell) {
    if (!(index >= 0) || index >= static_cast<double>(raw_.mesh.vertices_mm.size()) ||
        index != std::floor(index)) {
      cursor_.fail("cell " + std::to_string(cell + 1) + " refers to a vertex that is not among the " +
                   std::to_string(raw_.mesh.vertices_mm.size()));
    }
    return static_cast<std::int32_t>(index);
  }

  template <typename Append>
  void read_cells(const Append& append_cell) {
    const std::size_t first = read_count(), second = read_count();
    std::vector<std::int32_t> corners;
    if (version_ >= 5) {  // offsets and connectivity, a list each
      cursor_.expect("OFFSETS");
      const auto offsets = read_numbers(first, read_type(), "offsets");
      cursor_.expect("CONNECTIVITY");
      const auto indices = read_numbers(second, read_type(), "connectivity");
      for (std::size_t cell = 0; cell + 1 < offsets.size(); ++cell) {
        const double begin = offsets[cell], end = offsets[cell + 1];
        if (!(begin >= 0) || !(end >= begin) || !(end <= static_cast<double>(indices.size()))) {
          cursor_.fail("the offsets of cell " + std::to_string(cell + 1) + " are out of range");
        }
        corners.clear();
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
          corners.push_back(vertex(indices[i], cell));
        }
        append_cell(corners);
      }
      return;
    }
    // One list of "count, corners" for each cell.
    const auto list = read_numbers(second, kTypes[2], "cells");
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < first; ++cell) {
      if (at >= list.size() || !(list[at] >= 0) || !(list[at] <= static_cast<double>(list.size() - at - 1))) {
        cursor_.fail("cell " + std::to_string(cell + 1) + " runs past the end of the list");
      }
      const auto count = static_cast<std::size_t>(list[at++]);
      corners.clear();
      for (std::size_t i = 0; i < count; ++i) corners.push_back(vertex(list[at++], cell));
      append_cell(corners);
    }
  }

  void append_strip(const std::vector<std::int32_t>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const bool is_odd = i % 2 != 0;
      raw_.mesh.triangles.push_back(
          {corners[is_odd ? i - 1 : i - 2], corners[is_odd ? i - 2 : i - 1], corners[i]});
    }
  }

  void read_field() {
    static_cast<void>(cursor_.word());
    const std::size_t count = read_count();
    for (std::size_t i = 0; i < count; ++i) {
      static_cast<void>(cursor_.word());
      const std::size_t components = read_count(), tuples = read_count();
      if (components != 0 && tuples > cursor_.bytes().size() / components)
        cursor_.fail("the field is too long");
      const std::size_t values = components * tuples;
      const TextCursor before = cursor_;
      if (cursor_.word() == "string") {
        static_cast<void>(cursor_.rest_of_line());
        for (std::size_t line = 0; line < values; ++line) {
          if (const auto declared = space_declared_in(cursor_.rest_of_line())) raw_.declared_space = declared;
        }
        continue;
      }
      cursor_.rewind_to(before);
      static_cast<void>(read_numbers(values, read_type(), "field"));
    }
  }

  TextCursor cursor_;
  RawMesh raw_;
  double version_ = 0;
  bool is_binary_ = false;
};

}  // namespace

RawMesh parse_legacy_vtk(const std::filesystem::path& file, std::string_view text) {
  return LegacyReader(file, text).read();
}

}  // namespace arthronaut::bones
