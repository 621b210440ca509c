// Strict reading of Arthronaut's JSON files: every miss names the file, the place and the reason, and a
// number that is not finite, a newer version or an unknown format is refused. Writing is nlohmann's
// ordered_json in the .cpp of each format, through write_json.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::files {

// One object of a parsed document and where it stands. Copies share the document. Every accessor throws
// InvalidInput
// ("FILE: a.b[2]: reason") when the value is absent or not what is asked for.
class JsonObject {
 public:
  [[nodiscard]] bool has(std::string_view key) const;                // present and not null
  [[nodiscard]] bool is_number(std::string_view key) const;          // throws when the key is missing
  [[nodiscard]] double number(std::string_view key) const;           // finite
  [[nodiscard]] double positive_number(std::string_view key) const;  // finite and > 0
  [[nodiscard]] std::int64_t integer(std::string_view key) const;
  [[nodiscard]] int int32(
      std::string_view key) const;  // an integer that an int holds, no other one in its place
  [[nodiscard]] bool boolean(std::string_view key) const;
  [[nodiscard]] std::string text(std::string_view key) const;
  [[nodiscard]] Eigen::Vector2d vector2(std::string_view key) const;
  [[nodiscard]] Eigen::Vector3d vector3(std::string_view key) const;
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const;
  [[nodiscard]] JsonObject object(std::string_view key) const;
  [[nodiscard]] std::vector<JsonObject> objects(std::string_view key) const;  // an array of objects
  // {"q_wxyz": [..], "t_mm": [..]}; refuses a quaternion whose norm is off 1 by more than 1e-3, then
  // normalises.
  [[nodiscard]] geometry::RigidTransform rigid_transform(std::string_view key) const;

  [[nodiscard]] std::int64_t version() const { return integer("version"); }
  // Throws InvalidInput for this place: for checks that go beyond a type.
  [[noreturn]] void fail(std::string_view key, const std::string& reason) const;

 private:
  friend JsonObject read_json(const std::filesystem::path&, std::string_view, int);
  friend JsonObject parse_json(std::string_view, const std::filesystem::path&, std::string_view, int);
  JsonObject() = default;
  [[nodiscard]] const nlohmann::json& at(std::string_view key) const;

  std::shared_ptr<const nlohmann::json> document_;
  const nlohmann::json* node_ = nullptr;
  std::filesystem::path file_;
  std::string place_;
};

// Reads a file whose "format" is `format` and whose "version" is 1 to `newest_version`.
[[nodiscard]] JsonObject read_json(const std::filesystem::path& file, std::string_view format,
                                   int newest_version);
// The same for text already in memory; `name` stands in messages.
[[nodiscard]] JsonObject parse_json(std::string_view text, const std::filesystem::path& name,
                                    std::string_view format, int newest_version);

// As a file has it: indented, newline at the end.
[[nodiscard]] std::string as_text(const nlohmann::ordered_json& document);
// Atomic, that text. "-" writes to standard output. Throws IoError; InvalidInput when a
// number in it is not finite (nothing is written then).
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& document);

[[nodiscard]] nlohmann::ordered_json to_json(const Eigen::Vector2d& v);
[[nodiscard]] nlohmann::ordered_json to_json(const Eigen::Vector3d& v);
[[nodiscard]] nlohmann::ordered_json to_json(const geometry::RigidTransform& target_from_source);

}  // namespace arthronaut::files
