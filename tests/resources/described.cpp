#include "tests/resources/described.h"

#include <filesystem>
#include <fstream>

#include "tests/resources/json_schema.h"

namespace arthronaut::test {

std::string undescribed(const nlohmann::json& document, const std::string& name) {
  std::ifstream in(std::filesystem::path(ARTHRONAUT_SCHEMAS) / (name + ".schema.json"));
  std::string text;
  for (const std::string& violation : violations(document, nlohmann::json::parse(in)))
    text += violation + "\n";
  return text;
}

}  // namespace arthronaut::test
