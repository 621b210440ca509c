#include "planning/files/json_document.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::files {

namespace {

using nlohmann::json;

std::string joined(const std::string& place, std::string_view key) {
  return place.empty() ? std::string(key) : place + "." + std::string(key);
}

// Where a byte offset stands, for syntax errors.
std::string line_and_column(std::string_view text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    column = text[i] == '\n' ? 1 : column + 1;
    line += text[i] == '\n';
  }
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// Where the nth key of a text stands that is valid up to it.
std::size_t byte_of_key(std::string_view text, std::size_t nth) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '"') continue;
    const std::size_t start = i;
    for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\' ? 1 : 0;
    const auto after = text.find_first_not_of(" \t\r\n", i + 1);
    if (after != std::string_view::npos && text[after] == ':' && --nth == 0) return start + 1;
  }
  return text.size();
}

// Builds what json::parse would, but for an object that has a key twice: of two values nobody knows which is
// meant, and nlohmann keeps the last. The parser, not its exception, also says where a number stands that is
// too large for a double.
class StrictBuilder final : public nlohmann::json_sax<json> {
 public:
  explicit StrictBuilder(std::string_view text) : text_(text) { json::sax_parse(text, this); }
  [[nodiscard]] json take() { return std::move(root_); }
  // What is wrong, and where; empty where nothing is.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] const std::string& place() const { return place_; }

  bool parse_error(std::size_t byte, const std::string& token, const json::exception& error) override {
    const bool is_number = dynamic_cast<const json::parse_error*>(&error) == nullptr;
    place_ = line_and_column(text_, is_number ? byte + 1 - std::min(byte, token.size()) : byte);
    const bool is_empty = text_.find_first_not_of(" \t\r\n") == std::string_view::npos;
    reason_ = is_number ? "holds a number out of range" : is_empty ? "is empty" : "is not valid JSON";
    return false;
  }
  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(json::number_integer_t value) override { return put(value); }
  bool number_unsigned(json::number_unsigned_t value) override { return put(value); }
  bool number_float(json::number_float_t value, const std::string&) override { return put(value); }
  bool string(std::string& value) override { return put(std::move(value)); }
  bool binary(json::binary_t&) override { return false; }  // of no text
  bool start_object(std::size_t) override { return open(json::object()); }
  bool key(std::string& name) override {
    ++key_count_;
    const auto [entry, is_new] = open_.back()->get_ref<json::object_t&>().try_emplace(name);
    value_of_key_ = &entry->second;
    if (is_new) return true;
    place_ = line_and_column(text_, byte_of_key(text_, key_count_));
    reason_ = "the key " + json(name).dump() + " stands twice in one object";
    return false;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_array() override { return close(); }

 private:
  json& placed(json value) {
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_object()) return *value_of_key_ = std::move(value);
    return open_.back()->get_ref<json::array_t&>().emplace_back(std::move(value));
  }
  bool put(json value) {
    placed(std::move(value));
    return true;
  }
  bool open(json value) {
    open_.push_back(&placed(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  json root_;
  std::vector<json*> open_;  // objects and arrays around the place, outermost first
  json* value_of_key_ = nullptr;
  std::size_t key_count_ = 0;
  std::string reason_, place_;
};

// nlohmann writes a number that is not finite as null: refuse instead, the reader would.
void refuse_not_finite(const nlohmann::ordered_json& node, const std::filesystem::path& file,
                       const std::string& place) {
  if (node.is_number_float() && !std::isfinite(node.get<double>())) {
    throw InvalidInput(file, place, "would be written as a number that is not finite");
  }
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) refuse_not_finite(value, file, joined(place, key));
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      refuse_not_finite(node[i], file, place + "[" + std::to_string(i) + "]");
    }
  }
}

}  // namespace

void JsonObject::fail(std::string_view key, const std::string& reason) const {
  throw InvalidInput(file_, joined(place_, key), reason);
}

bool JsonObject::has(std::string_view key) const {
  const auto found = node_->find(std::string(key));
  return found != node_->end() && !found->is_null();
}

const json& JsonObject::at(std::string_view key) const {
  const auto found = node_->find(std::string(key));
  if (found == node_->end()) fail(key, "is missing");
  return *found;
}

bool JsonObject::is_number(std::string_view key) const { return at(key).is_number(); }

double JsonObject::number(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_number()) fail(key, "must be a number");
  const double number = value.get<double>();
  if (!std::isfinite(number)) fail(key, "must be finite");
  return number;
}

double JsonObject::positive_number(std::string_view key) const {
  const double value = number(key);
  if (value <= 0) fail(key, "must be above 0");
  return value;
}

std::int64_t JsonObject::integer(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_number_integer()) fail(key, "must be an integer");
  // Beyond 63 bits get() would wrap into another number.
  if (value.is_number_unsigned() &&
      value.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    fail(key, "is out of range");
  }
  return value.get<std::int64_t>();
}

int JsonObject::int32(std::string_view key) const {
  const std::int64_t value = integer(key);
  if (!std::in_range<int>(value)) fail(key, "is out of range");
  return static_cast<int>(value);
}

bool JsonObject::boolean(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_boolean()) fail(key, "must be true or false");
  return value.get<bool>();
}

std::string JsonObject::text(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_string()) fail(key, "must be a text");
  return value.get<std::string>();
}

std::vector<double> JsonObject::numbers(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_array()) fail(key, "must be a list of numbers");
  std::vector<double> result;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].is_number() || !std::isfinite(value[i].get<double>())) {
      fail(std::string(key) + "[" + std::to_string(i) + "]", "must be a finite number");
    }
    result.push_back(value[i].get<double>());
  }
  return result;
}

std::vector<std::string> JsonObject::texts(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_array()) fail(key, "must be a list of texts");
  std::vector<std::string> result;
  for (const auto& item : value) {
    if (!item.is_string()) fail(key, "must be a list of texts");
    result.push_back(item.get<std::string>());
  }
  return result;
}

Eigen::Vector2d JsonObject::vector2(std::string_view key) const {
  const auto values = numbers(key);
  if (values.size() != 2) fail(key, "must hold 2 numbers, holds " + std::to_string(values.size()));
  return {values[0], values[1]};
}

Eigen::Vector3d JsonObject::vector3(std::string_view key) const {
  const auto values = numbers(key);
  if (values.size() != 3) fail(key, "must hold 3 numbers, holds " + std::to_string(values.size()));
  return {values[0], values[1], values[2]};
}

JsonObject JsonObject::object(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_object()) fail(key, "must be an object");
  JsonObject child = *this;
  child.node_ = &value;
  child.place_ = joined(place_, key);
  return child;
}

std::vector<JsonObject> JsonObject::objects(std::string_view key) const {
  const json& value = at(key);
  if (!value.is_array()) fail(key, "must be a list of objects");
  std::vector<JsonObject> result;
  for (std::size_t i = 0; i < value.size(); ++i) {
    JsonObject child = *this;
    child.node_ = &value[i];
    child.place_ = joined(place_, key) + "[" + std::to_string(i) + "]";
    if (!value[i].is_object()) throw InvalidInput(file_, child.place_, "must be an object");
    result.push_back(std::move(child));
  }
  return result;
}

geometry::RigidTransform JsonObject::rigid_transform(std::string_view key) const {
  const JsonObject node = object(key);
  const auto q = node.numbers("q_wxyz");
  if (q.size() != 4) node.fail("q_wxyz", "must hold 4 numbers, holds " + std::to_string(q.size()));
  geometry::RigidTransform transform{Eigen::Quaterniond(q[0], q[1], q[2], q[3]), node.vector3("t_mm")};
  if (std::abs(transform.rotation.norm() - 1) > 1e-3) node.fail("q_wxyz", "must have unit norm");
  // A quaternion that was written by this program comes back to the last bit.
  if (std::abs(transform.rotation.norm() - 1) > 1e-12) transform.rotation.normalize();
  return transform;
}

JsonObject parse_json(std::string_view text, const std::filesystem::path& name, std::string_view format,
                      int newest_version) {
  JsonObject root;
  root.file_ = name;
  StrictBuilder builder(text);
  if (!builder.reason().empty()) throw InvalidInput(name, builder.place(), builder.reason());
  root.document_ = std::make_shared<json>(builder.take());
  root.node_ = root.document_.get();
  if (!root.node_->is_object()) throw InvalidInput(name, "", "must hold a JSON object");
  const std::string found = root.text("format");
  if (found != format) root.fail("format", "is \"" + found + "\", expected \"" + std::string(format) + "\"");
  const auto version = root.version();
  if (version < 1) root.fail("version", "must be 1 or more");
  if (version > newest_version) {
    root.fail("version", "is " + std::to_string(version) + ", newer than this program reads (" +
                             std::to_string(newest_version) + "); nothing was changed");
  }
  return root;
}

JsonObject read_json(const std::filesystem::path& file, std::string_view format, int newest_version) {
  return parse_json(read_text(file), file, format, newest_version);
}

std::string as_text(const nlohmann::ordered_json& document) {
  // Bytes that are no UTF-8 (of a file name, say) become the replacement character instead of an exception.
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& document) {
  refuse_not_finite(document, file, "");
  write_atomically(file, as_text(document));
}

nlohmann::ordered_json to_json(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }
nlohmann::ordered_json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
nlohmann::ordered_json to_json(const geometry::RigidTransform& target_from_source) {
  const auto& q = target_from_source.rotation;
  return {{"q_wxyz", {q.w(), q.x(), q.y(), q.z()}}, {"t_mm", to_json(target_from_source.translation_mm)}};
}

}  // namespace arthronaut::files
