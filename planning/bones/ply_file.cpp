#include <algorithm>
#include <array>

#include "planning/bones/mesh_formats.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

enum class Scalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };
struct ScalarName {
  std::string_view name, other_name;
  Scalar type;
  std::size_t bytes;
};
constexpr std::array<ScalarName, 8> kScalars{{{"char", "int8", Scalar::Int8, 1},
                                              {"uchar", "uint8", Scalar::UInt8, 1},
                                              {"short", "int16", Scalar::Int16, 2},
                                              {"ushort", "uint16", Scalar::UInt16, 2},
                                              {"int", "int32", Scalar::Int32, 4},
                                              {"uint", "uint32", Scalar::UInt32, 4},
                                              {"float", "float32", Scalar::Float32, 4},
                                              {"double", "float64", Scalar::Float64, 8}}};

struct Property {
  std::string name;
  Scalar type = Scalar::Float32;
  std::optional<Scalar> list_count_type;
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};
enum class Encoding { Text, LittleEndian, BigEndian };
struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
  std::optional<Space> declared_space;
};

Scalar scalar_from(TextCursor& cursor) {
  const std::string_view word = cursor.word();
  for (const auto& s : kScalars) {
    if (word == s.name || word == s.other_name) return s.type;
  }
  cursor.fail("unknown type of a property");
}

Header parse_header(TextCursor& cursor) {
  cursor.expect("ply");
  Header header;
  bool has_format = false;
  for (std::string_view key = cursor.word(); key != "end_header"; key = cursor.word()) {
    if (key == "format") {
      const std::string_view encoding = cursor.word();
      if (encoding == "ascii") {
        header.encoding = Encoding::Text;
      } else if (encoding == "binary_little_endian") {
        header.encoding = Encoding::LittleEndian;
      } else if (encoding == "binary_big_endian") {
        header.encoding = Encoding::BigEndian;
      } else {
        cursor.fail("unknown format");
      }
      has_format = true;
      static_cast<void>(cursor.rest_of_line());
    } else if (key == "comment" || key == "obj_info") {
      if (const auto declared = space_declared_in(cursor.rest_of_line())) header.declared_space = declared;
    } else if (key == "element") {
      Element element;
      element.name = cursor.word();
      const std::int64_t count = cursor.integer();
      if (count < 0) cursor.fail("a count below 0");
      element.count = static_cast<std::size_t>(count);
      header.elements.push_back(element);
    } else if (key == "property") {
      if (header.elements.empty()) cursor.fail("a property before any element");
      Property property;
      const TextCursor before = cursor;
      if (cursor.word() == "list") {
        property.list_count_type = scalar_from(cursor);
      } else {
        cursor.rewind_to(before);
      }
      property.type = scalar_from(cursor);
      property.name = cursor.word();
      header.elements.back().properties.push_back(property);
    } else {
      cursor.fail("not a line of a PLY header");
    }
  }
  if (!has_format) cursor.fail("the header names no format");
  static_cast<void>(cursor.rest_of_line());
  return header;
}

// The numbers after the header, whichever way they are written.
class Values {
 public:
  Values(const std::filesystem::path& file, TextCursor cursor, Encoding encoding)
      : file_(file), cursor_(cursor), encoding_(encoding) {}

  double next(Scalar type, const Element& element, std::size_t row) {
    if (encoding_ == Encoding::Text) {
      // Not cursor_.number(): properties that nobody uses may be nan.
      const auto value = number_from(cursor_.word());
      if (!value) cursor_.fail("not a number");
      return *value;
    }
    const std::size_t size = kScalars[static_cast<std::size_t>(type)].bytes;
    const std::string_view bytes = cursor_.bytes();
    if (bytes.size() < size) {
      throw InvalidInput(file_, "byte " + std::to_string(cursor_.byte() + bytes.size()),
                         "the file ends in " + element.name + " " + std::to_string(row + 1) + " of " +
                             std::to_string(element.count));
    }
    cursor_.skip_bytes(size);
    return decoded(type, bytes.data());
  }
  // An upper bound of how many rows can follow, so that a wrong count does not reserve the memory for it.
  [[nodiscard]] std::size_t bytes_left() const { return cursor_.bytes().size(); }

 private:
  [[nodiscard]] double decoded(Scalar type, const char* at) const {
    const std::endian order = encoding_ == Encoding::BigEndian ? std::endian::big : std::endian::little;
    switch (type) {
      case Scalar::Int8:
        return scalar_at<std::int8_t>(at, order);
      case Scalar::UInt8:
        return scalar_at<std::uint8_t>(at, order);
      case Scalar::Int16:
        return scalar_at<std::int16_t>(at, order);
      case Scalar::UInt16:
        return scalar_at<std::uint16_t>(at, order);
      case Scalar::Int32:
        return scalar_at<std::int32_t>(at, order);
      case Scalar::UInt32:
        return scalar_at<std::uint32_t>(at, order);
      case Scalar::Float32:
        return scalar_at<float>(at, order);
      case Scalar::Float64:
        break;
    }
    return scalar_at<double>(at, order);
  }

  const std::filesystem::path& file_;
  TextCursor cursor_;
  Encoding encoding_;
};

// Reads the body into a mesh; one element kind after the other, in the header's order.
class Body {
 public:
  Body(const std::filesystem::path& file, Values& values, RawMesh& raw)
      : file_(file), values_(values), raw_(raw) {}

  void read(const Element& element) {
    if (element.properties.empty() && element.count > 0) fail(element, 0, "has no property");
    if (element.name == "vertex")
      raw_.mesh.vertices_mm.reserve(std::min(element.count, values_.bytes_left()));
    for (std::size_t row = 0; row < element.count; ++row) read_row(element, row);
  }

 private:
  void read_row(const Element& element, std::size_t row) {
    Eigen::Vector3d position = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const Property& property : element.properties) {
      if (property.list_count_type) {
        read_list(element, row, property);
        continue;
      }
      const double value = values_.next(property.type, element, row);
      if (element.name == "vertex" && property.name.size() == 1) {
        const auto axis = std::string_view("xyz").find(property.name);
        if (axis != std::string_view::npos) position[static_cast<Eigen::Index>(axis)] = value;
      }
    }
    if (element.name != "vertex") return;
    if (!position.allFinite()) fail(element, row, "has a coordinate that is missing or not finite");
    raw_.mesh.vertices_mm.push_back(position);
  }

  void read_list(const Element& element, std::size_t row, const Property& property) {
    const double count = values_.next(*property.list_count_type, element, row);
    if (!(count >= 0) || count != std::floor(count))
      fail(element, row, "has a list with a count that is none");
    const bool is_polygon =
        element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
    corners_.clear();
    for (double i = 0; i < count; ++i) {
      const double value = values_.next(property.type, element, row);
      if (!is_polygon) continue;
      if (!(value >= 0) || value >= static_cast<double>(raw_.mesh.vertices_mm.size()) ||
          value != std::floor(value)) {
        fail(element, row,
             "refers to a vertex that is not among the " + std::to_string(raw_.mesh.vertices_mm.size()));
      }
      corners_.push_back(static_cast<std::int32_t>(value));
    }
    if (is_polygon) append_polygon(raw_.mesh, corners_);
  }

  [[noreturn]] void fail(const Element& element, std::size_t row, const std::string& reason) const {
    throw InvalidInput(file_, element.name + " " + std::to_string(row + 1), reason);
  }

  const std::filesystem::path& file_;
  Values& values_;
  RawMesh& raw_;
  std::vector<std::int32_t> corners_;
};

}  // namespace

RawMesh parse_ply(const std::filesystem::path& file, std::string_view text) {
  TextCursor cursor(file, text);
  const Header header = parse_header(cursor);
  RawMesh raw;
  raw.format = header.encoding == Encoding::Text ? "text PLY" : "binary PLY";
  raw.declared_space = header.declared_space;
  Values values(file, cursor, header.encoding);
  Body body(file, values, raw);
  for (const Element& element : header.elements) body.read(element);
  return raw;
}

}  // namespace arthronaut::bones
