#include "app/start/recent_cases.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/case/case_opening.h"
#include "planning/files/json_document.h"
#include "planning/files/local_time.h"
#include "planning/files/private_folder.h"

namespace arthronaut::start {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kRecentFormat = "arthronaut.recent";
constexpr int kRecentVersion = 1;
constexpr std::size_t kMost = 20;

std::optional<std::time_t> time_of(const std::string& utc) {
  std::tm parts{};
  if (std::sscanf(utc.c_str(), "%d-%d-%dT%d:%d:%d", &parts.tm_year, &parts.tm_mon, &parts.tm_mday,
                  &parts.tm_hour, &parts.tm_min, &parts.tm_sec) != 6)
    return std::nullopt;
  parts.tm_year -= 1900;
  parts.tm_mon -= 1;
  return timegm(&parts);
}

}  // namespace

fs::path recent_cases_file() { return open_case::built_in_case_folder().parent_path() / "recent.json"; }

std::vector<RecentCase> load_recent_cases(const fs::path& file) {
  std::vector<RecentCase> cases;
  try {
    if (!fs::exists(file)) return cases;
    for (const auto& node : files::read_json(file, kRecentFormat, kRecentVersion).objects("cases"))
      cases.push_back({node.text("folder"), node.text("name"), node.text("side"), node.text("opened_utc")});
  } catch (const std::exception&) {
    cases.clear();
  }
  return cases;
}

void note_recent_case(const fs::path& file, const RecentCase& opened) noexcept {
  try {
    std::vector<RecentCase> cases = load_recent_cases(file);
    const fs::path folder = fs::absolute(opened.folder).lexically_normal();
    std::erase_if(cases, [&](const RecentCase& other) { return other.folder == folder; });
    cases.insert(cases.begin(), opened);
    cases.front().folder = folder;
    if (cases.size() > kMost) cases.resize(kMost);
    auto nodes = nlohmann::ordered_json::array();
    for (const RecentCase& one : cases)
      nodes.push_back({{"folder", one.folder.string()},
                       {"name", one.name},
                       {"side", one.side},
                       {"opened_utc", one.opened_utc}});
    files::create_private_folder(file.parent_path());
    files::write_json(file,
                      {{"format", kRecentFormat}, {"version", kRecentVersion}, {"cases", std::move(nodes)}});
  } catch (const std::exception&) {  // as the header says
  }
}

std::string when_in_words(const std::string& utc, const std::string& now_utc) {
  const auto then = time_of(utc), now = time_of(now_utc);
  if (!then || !now) return utc.substr(0, std::min<std::size_t>(utc.size(), 10));
  const auto minutes = (*now - *then) / 60;
  if (minutes < 0 || minutes >= 7 * 24 * 60) return files::local_day(utc);
  if (minutes < 2) return "just now";
  if (minutes < 60) return std::to_string(minutes) + " min ago";
  if (minutes < 24 * 60) return std::to_string(minutes / 60) + " h ago";
  const auto days = minutes / (24 * 60);
  return days == 1 ? "yesterday" : std::to_string(days) + " days ago";
}

}  // namespace arthronaut::start
