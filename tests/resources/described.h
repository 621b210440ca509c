// Whether a document is as its schema in resources/schemas says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace arthronaut::test {

// name: of the schema, "tip" of tip.schema.json. Each difference on a line of its own; empty: it is as
// described.
[[nodiscard]] std::string undescribed(const nlohmann::json& document, const std::string& name);

}  // namespace arthronaut::test
