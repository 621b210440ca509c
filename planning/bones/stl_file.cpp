#include <algorithm>
#include <unordered_map>

#include "planning/bones/mesh_formats.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

constexpr std::size_t kHeaderBytes = 84, kTriangleBytes = 50;

struct PointHash {
  std::size_t operator()(const std::array<float, 3>& p) const {
    std::size_t hash = 0;
    for (const float c : p) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(c == 0.0F ? 0.0F : c)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

// STL repeats each point in every triangle that has it: equal coordinates become one vertex again.
class Welder {
 public:
  explicit Welder(geometry::TriangleMesh& mesh, std::size_t triangle_count) : mesh_(mesh) {
    mesh_.triangles.reserve(triangle_count);
    index_.reserve(triangle_count);
  }
  void add(const std::array<std::array<float, 3>, 3>& corners) {
    std::array<std::int32_t, 3> triangle{};
    for (int i = 0; i < 3; ++i) {
      const auto& p = corners[i];
      const auto [at, is_new] = index_.try_emplace(p, static_cast<std::int32_t>(mesh_.vertices_mm.size()));
      if (is_new) mesh_.vertices_mm.emplace_back(p[0], p[1], p[2]);
      triangle[i] = at->second;
    }
    mesh_.triangles.push_back(triangle);
  }

 private:
  geometry::TriangleMesh& mesh_;
  std::unordered_map<std::array<float, 3>, std::int32_t, PointHash> index_;
};

RawMesh parse_binary(const std::filesystem::path& file, std::string_view text) {
  const std::size_t count = scalar_at<std::uint32_t>(text.data() + 80, std::endian::little);
  const std::size_t whole = (text.size() - kHeaderBytes) / kTriangleBytes;
  if (whole < count) {
    throw InvalidInput(
        file, "byte " + std::to_string(text.size()),
        "the file ends in triangle " + std::to_string(whole + 1) + " of " + std::to_string(count));
  }
  RawMesh raw;
  raw.format = "binary STL";
  raw.declared_space = space_declared_in(text.substr(0, 80));
  Welder welder(raw.mesh, count);
  for (std::size_t t = 0; t < count; ++t) {
    const char* bytes = text.data() + kHeaderBytes + t * kTriangleBytes + 12;  // past the normal
    std::array<std::array<float, 3>, 3> corners{};
    for (int i = 0; i < 9; ++i) {
      const float c = scalar_at<float>(bytes + 4 * i, std::endian::little);
      if (!std::isfinite(c)) {
        throw InvalidInput(file, "triangle " + std::to_string(t + 1), "has a coordinate that is not finite");
      }
      corners[i / 3][i % 3] = c;
    }
    welder.add(corners);
  }
  return raw;
}

RawMesh parse_text(const std::filesystem::path& file, std::string_view text) {
  RawMesh raw;
  raw.format = "text STL";
  Welder welder(raw.mesh, text.size() / 250);
  TextCursor cursor(file, text);
  // A file may hold several solids one after the other: one mesh all the same.
  while (!cursor.at_end()) {
    cursor.expect("solid");
    const auto declared = space_declared_in(cursor.rest_of_line());
    if (declared) raw.declared_space = declared;
    for (std::string_view word = cursor.word(); !equal_ignoring_case(word, "endsolid");
         word = cursor.word()) {
      if (!equal_ignoring_case(word, "facet")) cursor.fail("expected \"facet\" or \"endsolid\"");
      // The normal is not used, and degenerate triangles have it as nan in files of several programs.
      static_cast<void>(cursor.rest_of_line());
      cursor.expect("outer");
      cursor.expect("loop");
      std::array<std::array<float, 3>, 3> corners{};
      for (auto& corner : corners) {
        cursor.expect("vertex");
        for (float& c : corner) {
          c = static_cast<float>(cursor.number());
          if (!std::isfinite(c)) cursor.fail("the coordinate is not finite");
        }
      }
      cursor.expect("endloop");
      cursor.expect("endfacet");
      welder.add(corners);
    }
    static_cast<void>(cursor.rest_of_line());
  }
  return raw;
}

bool looks_like_text(std::string_view text) {
  const std::string_view start = text.substr(0, 1000);
  return equal_ignoring_case(start.substr(0, 5), "solid") && start.find('\0') == std::string_view::npos &&
         (start.find("facet") != std::string_view::npos || start.find("FACET") != std::string_view::npos ||
          start.find("endsolid") != std::string_view::npos);
}

}  // namespace

RawMesh parse_stl(const std::filesystem::path& file, std::string_view text) {
  // Some programs begin a binary file with "solid": the length that the count asks for decides first.
  const bool is_binary_by_length =
      text.size() >= kHeaderBytes &&
      text.size() ==
          kHeaderBytes + kTriangleBytes * scalar_at<std::uint32_t>(text.data() + 80, std::endian::little);
  if (!is_binary_by_length && looks_like_text(text)) return parse_text(file, text);
  if (text.size() < kHeaderBytes) {
    throw InvalidInput(file, "byte " + std::to_string(text.size()), "the file ends within the STL header");
  }
  return parse_binary(file, text);
}

}  // namespace arthronaut::bones
