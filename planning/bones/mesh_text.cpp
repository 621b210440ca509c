#include <algorithm>
#include <limits>

#include "planning/bones/mesh_formats.h"
#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// A word of a broken file may be anything: shown short, and without control characters.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 24));
  for (char& c : text) {
    if (c < 32 || c > 126) c = '?';
  }
  return "\"" + text + (word.size() > 24 ? "...\"" : "\"");
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<double> number_from(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  // Too small for a double is 0; too large is refused by the caller as infinite.
  if (error == std::errc::result_out_of_range) {
    const auto exponent = word.find_first_of("eE");
    const bool is_tiny = exponent != std::string_view::npos && word.substr(exponent + 1, 1) == "-";
    return is_tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

std::optional<Space> space_declared_in(std::string_view comment) {
  for (const std::string_view key : {"SPACE=", "SPACE:", "space=", "space:"}) {
    for (auto at = comment.find(key); at != std::string_view::npos; at = comment.find(key, at + 1)) {
      std::string_view value = comment.substr(at + key.size());
      while (!value.empty() && is_space(value.front())) value.remove_prefix(1);
      if (equal_ignoring_case(value.substr(0, 3), "RAS")) return Space::RAS;
      if (equal_ignoring_case(value.substr(0, 3), "LPS")) return Space::LPS;
    }
  }
  return std::nullopt;
}

void TextCursor::skip_space() {
  while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
}

bool TextCursor::at_end() {
  skip_space();
  return at_ >= text_.size();
}

std::string_view TextCursor::word() {
  if (at_end()) fail("the file ends too early");
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view TextCursor::line_left() const {
  return text_.substr(at_, std::min(text_.find('\n', at_), text_.size()) - at_);
}

std::string_view TextCursor::rest_of_line() {
  const std::string_view line = line_left();
  at_ += line.size();
  if (at_ < text_.size()) {
    ++at_;
    ++line_;
  }
  return line;
}

double TextCursor::number() {
  const std::string_view text = word();
  const auto value = number_from(text);
  if (!value) fail(shown(text) + " is not a number");
  if (!std::isfinite(*value)) fail(shown(text) + " is not finite");
  return *value;
}

std::int64_t TextCursor::integer() {
  const std::string_view text = word();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) fail(shown(text) + " is not an integer");
  return value;
}

void TextCursor::expect(std::string_view keyword) {
  const std::string_view text = word();
  if (!equal_ignoring_case(text, keyword)) {
    fail("expected \"" + std::string(keyword) + "\", found " + shown(text));
  }
}

void TextCursor::fail(const std::string& reason) const {
  throw InvalidInput(*file_, "line " + std::to_string(line_), reason);
}

void append_polygon(geometry::TriangleMesh& mesh, const std::vector<std::int32_t>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace arthronaut::bones
