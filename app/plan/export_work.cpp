#include "app/plan/export_work.h"

#include <exception>

#include "planning/plan_export/plan_export.h"

namespace arthronaut::plan {

std::string ExportOutcome::in_words(const std::filesystem::path& open_case_folder) const {
  std::string words = case_folder == open_case_folder ? text : "Of the case \"" + case_name + "\": " + text;
  for (const std::string& doubt : doubts) words += "\nLook: " + doubt;
  return words;
}

void ExportWork::start(cases::Case knee, std::filesystem::path case_folder) {
  running_.start(
      [knee = std::move(knee), folder = std::move(case_folder)] {
        ExportOutcome outcome{.case_folder = folder, .case_name = knee.name};
        try {  // a full disk is a state of the screen
          const plan_export::ExportSummary summary = plan_export::export_plan(knee, folder / "export");
          outcome.text = "Exported into " + (folder / "export").string() + ":";
          for (const auto& file : summary.files) outcome.text += " " + file.filename().string();
          outcome.doubts = summary.doubts;
          outcome.is_written = true;
        } catch (const std::exception& error) {  // the top of a thread: the geometry library's assertions too
          outcome.text = std::string("Not exported: ") + error.what();
        }
        return outcome;
      },
      wake_);
}

std::optional<ExportOutcome> ExportWork::take_outcome() {
  if (!running_.is_ready()) return std::nullopt;
  return running_.take();
}

}  // namespace arthronaut::plan
