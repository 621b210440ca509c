#include "app/command_line/after_operation.h"

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

library::TakenImages taken_images(const images::ImageSeries& series) {
  return {{series.patient_name, series.patient_id, ""}, series.study_date, series.uid};
}

void say_planned_cases(const Context& context, const library::TakenImages& images,
                       const std::string& source) {
  const auto cases = workstation_library::planned_cases_of({&images, 1});
  for (const library::PlannedCase& planned : cases.front()) {
    const std::string folder = planned.folder.string();
    context.say(
        "  > the case \"" + planned.name +
        "\" is of this patient and has a plan; taken after the operation, they are compared with it by");
    context.say("    arthronaut compare " + quoted(folder) + " --postop " + quoted(source) +
                (images.series_uid.empty() ? "" : " --series " + images.series_uid) + " -o " +
                quoted(folder + "/achieved.json"));
  }
}

}  // namespace arthronaut::command_line
