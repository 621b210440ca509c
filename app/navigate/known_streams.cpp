#include "app/navigate/known_streams.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/case/case_opening.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"

namespace arthronaut::navigate {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kFormat = "arthronaut.streams";
constexpr int kVersion = 1;
constexpr std::size_t kMost = 5;

}  // namespace

fs::path known_streams_file() { return open_case::built_in_case_folder().parent_path() / "streams.json"; }

std::vector<std::string> load_known_streams(const fs::path& file) {
  std::vector<std::string> addresses;
  try {
    if (!fs::exists(file)) return addresses;
    for (const auto& stream : files::read_json(file, kFormat, kVersion).objects("streams"))
      addresses.push_back(stream.text("address"));
  } catch (const std::exception&) {
    addresses.clear();
  }
  return addresses;
}

void note_stream(const fs::path& file, const std::string& address) noexcept {
  try {
    std::vector<std::string> addresses = load_known_streams(file);
    std::erase(addresses, address);
    addresses.insert(addresses.begin(), address);
    if (addresses.size() > kMost) addresses.resize(kMost);
    auto streams = nlohmann::ordered_json::array();
    for (const std::string& known : addresses) streams.push_back({{"address", known}});
    files::create_private_folder(file.parent_path());
    files::write_json(file, {{"format", kFormat}, {"version", kVersion}, {"streams", std::move(streams)}});
  } catch (const std::exception&) {  // as the header says
  }
}

}  // namespace arthronaut::navigate
