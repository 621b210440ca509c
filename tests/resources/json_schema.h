// As much of JSON Schema (2020-12) as the schemas of resources use. A keyword beyond that is reported, so
// that none is passed over.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace arthronaut {

// What is wrong with a document, each with its place; empty: it is as the schema says. A member that the
// schema does not describe counts as wrong: the schema is the files' documentation.
[[nodiscard]] std::vector<std::string> violations(const nlohmann::json& document,
                                                  const nlohmann::json& schema);

}  // namespace arthronaut
