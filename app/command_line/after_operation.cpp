#include "app/command_line/after_operation.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/library/workstation_library.h"

namespace arthronaut::command_line {

namespace {

// As a shell reads it back.
std::string quoted(const std::string& text) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_./:,+@%=";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string words = "'";
  for (const char c : text) words += c == '\'' ? "'\\''" : std::string(1, c);
  return words + "'";
}

}  // namespace

std::vector<std::vector<library::PlannedCase>> planned_cases_of(std::span<const images::ImageSeries> series) {
  std::vector<library::TakenImages> images(series.size());
  std::ranges::transform(series, images.begin(), library::taken_images);
  return workstation_library::planned_cases_of(images);
}

void say_planned_cases(const Context& context, std::span<const library::PlannedCase> cases,
                       const std::string& series_uid, const std::string& source) {
  for (const library::PlannedCase& planned : cases) {
    const std::string folder = planned.folder.string();
    context.say(
        "  > the case \"" + planned.name +
        "\" is of this patient and has a plan; taken after the operation, they are compared with it by");
    context.say("    arthronaut compare " + quoted(folder) + " --postop " + quoted(source) +
                (series_uid.empty() ? "" : " --series " + series_uid) + " -o " +
                quoted(folder + "/achieved.json"));
  }
}

nlohmann::ordered_json planned_cases_json(std::span<const library::PlannedCase> cases) {
  auto all = nlohmann::ordered_json::array();
  for (const library::PlannedCase& planned : cases)
    all.push_back({{"name", planned.name}, {"folder", planned.folder.string()}});
  return all;
}

}  // namespace arthronaut::command_line
