#include "tests/resources/json_schema.h"

#include <algorithm>

namespace arthronaut {
namespace {

using nlohmann::json;

bool is_of_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  return type == "number" && value.is_number();
}

class Validator {
 public:
  explicit Validator(const json& root) : root_(root) {}

  void check(const json& value, const json& schema, const std::string& place) {
    for (const auto& [keyword, rule] : schema.items()) check_keyword(value, schema, keyword, rule, place);
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(found_); }

 private:
  void require(bool holds, const std::string& place, const std::string& what) {
    if (!holds) found_.push_back(place + ": " + what);
  }

  void check_keyword(const json& value, const json& schema, const std::string& keyword, const json& rule,
                     const std::string& place) {
    if (keyword == "title" || keyword == "description" || keyword == "$schema" || keyword == "$defs") return;
    if (keyword == "type") {
      require(is_of_type(value, rule), place, "is no " + rule.get<std::string>());
    } else if (keyword == "$ref") {
      check(value, root_.at(json::json_pointer(rule.get<std::string>().substr(1))), place);
    } else if (keyword == "const") {
      require(value == rule, place, "is not " + rule.dump());
    } else if (keyword == "enum") {
      require(std::find(rule.begin(), rule.end(), value) != rule.end(), place, "is none of " + rule.dump());
    } else if (keyword == "oneOf") {
      const auto fitting = std::count_if(rule.begin(), rule.end(), [&](const json& choice) {
        Validator one(root_);
        one.only_names_ = choice.size() == 1 && choice.contains("required");
        one.check(value, choice, place);
        return one.found_.empty();
      });
      require(fitting == 1, place, "fits " + std::to_string(fitting) + " of the choices");
    } else if (value.is_number() &&
               (keyword == "minimum" || keyword == "maximum" || keyword == "exclusiveMinimum")) {
      const double number = value, limit = rule;
      require(keyword == "minimum"   ? number >= limit
              : keyword == "maximum" ? number <= limit
                                     : number > limit,
              place, "breaks " + keyword + " " + rule.dump());
    } else if (value.is_string() && keyword == "minLength") {
      require(value.get<std::string>().size() >= rule.get<std::size_t>(), place, "is too short");
    } else if (value.is_array() && (keyword == "minItems" || keyword == "maxItems")) {
      const auto limit = rule.get<std::size_t>();
      require(keyword == "minItems" ? value.size() >= limit : value.size() <= limit, place,
              "has " + std::to_string(value.size()) + " entries");
    } else if (value.is_array() && keyword == "items") {
      for (std::size_t i = 0; i < value.size(); ++i) check(value[i], rule, place + "/" + std::to_string(i));
    } else if (value.is_object()) {
      check_members(value, schema, keyword, rule, place);
    }
  }

  void check_members(const json& value, const json& schema, const std::string& keyword, const json& rule,
                     const std::string& place) {
    if (keyword == "required") {
      for (const std::string name : rule) require(value.contains(name), place, "lacks " + name);
    } else if (keyword == "dependentRequired") {
      for (const auto& [name, others] : rule.items())
        for (const std::string other : others)
          require(!value.contains(name) || value.contains(other), place, name + " without " + other);
    } else if (keyword == "properties") {
      for (const auto& [name, member] : value.items()) {
        require(rule.contains(name), place, name + " is not described");
        if (rule.contains(name)) check(member, rule.at(name), place + "/" + name);
      }
    } else {
      require(false, place, "the schema's keyword " + keyword + " is not known here");
    }
    require(only_names_ || schema.contains("properties"), place, "the schema describes no members");
  }

  const json& root_;
  bool only_names_ = false;  // which members there are decides between choices; what they are is said outside
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> violations(const nlohmann::json& document, const nlohmann::json& schema) {
  Validator validator(schema);
  validator.check(document, schema, "");
  return validator.take();
}

}  // namespace arthronaut
