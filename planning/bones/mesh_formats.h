// What the readers of the single formats share. Inner header of bones: others include mesh_file.h.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planning/bones/mesh_file.h"
#include "planning/files/scalar_bytes.h"

namespace arthronaut::bones {

using files::scalar_at;

// In the file's own axes and unit.
struct RawMesh {
  geometry::TriangleMesh mesh;
  std::string format;
  std::optional<Space> declared_space;
};

// `text` is the whole file. Throw InvalidInput.
[[nodiscard]] RawMesh parse_stl(const std::filesystem::path& file, std::string_view text);
[[nodiscard]] RawMesh parse_ply(const std::filesystem::path& file, std::string_view text);
[[nodiscard]] RawMesh parse_obj(const std::filesystem::path& file, std::string_view text);
[[nodiscard]] RawMesh parse_legacy_vtk(const std::filesystem::path& file, std::string_view text);
[[nodiscard]] RawMesh parse_vtp(const std::filesystem::path& file, std::string_view text);

// Looks for SPACE=LPS, SPACE=RAS and the colon forms, in comments and titles.
[[nodiscard]] std::optional<Space> space_declared_in(std::string_view comment);

// Words and lines of a text, with the line they stand on. Throws InvalidInput that names it.
class TextCursor {
 public:
  TextCursor(const std::filesystem::path& file, std::string_view text) : file_(&file), text_(text) {}

  [[nodiscard]] bool at_end();                    // nothing but white space is left
  [[nodiscard]] std::string_view word();          // throws at the end of the file
  [[nodiscard]] std::string_view rest_of_line();  // and goes past it
  [[nodiscard]] std::string_view line_left() const;
  [[nodiscard]] double number();  // finite
  [[nodiscard]] std::int64_t integer();
  void expect(std::string_view keyword);  // case does not matter
  // For binary parts: the bytes from here on, and how to go past them.
  [[nodiscard]] std::string_view bytes() const { return text_.substr(at_); }
  void skip_bytes(std::size_t count) { at_ += count; }
  [[nodiscard]] std::size_t byte() const { return at_; }
  void rewind_to(const TextCursor& before) { *this = before; }
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  void skip_space();

  const std::filesystem::path* file_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);
// The whole of `word` as a number, "+1" and "nan" included; nullopt when it is none.
[[nodiscard]] std::optional<double> number_from(std::string_view word);

// Appends the fan of a polygon's corners, which are in range.
void append_polygon(geometry::TriangleMesh& mesh, const std::vector<std::int32_t>& corners);

}  // namespace arthronaut::bones
