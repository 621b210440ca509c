#include "app/plan/export_work.h"

#include <exception>

#include "planning/cases/plan_file.h"
#include "planning/plan_export/plan_export.h"

namespace arthronaut::plan {

std::string ExportOutcome::in_words(std::uint64_t revision_now) const {
  std::string words = text;
  if (is_written && revision_now != revision) words += "\nIt is the plan as it was before the last change.";
  for (const std::string& one : wrong) words += "\nWrong, and exported all the same: " + one;
  for (const std::string& doubt : doubts) words += "\nLook: " + doubt;
  return words;
}

void ExportWork::start(cases::Case knee, std::uint64_t revision, std::filesystem::path case_folder,
                       std::vector<std::string> wrong) {
  stop_ = {};
  running_.start(
      [case_folder = std::move(case_folder), knee = std::move(knee), revision, wrong = std::move(wrong),
       stop = stop_.get_token()] {
        ExportOutcome outcome{.revision = revision};
        try {  // a full disk is a state of the screen
          // By the hash that stands in the files.
          const auto folder = cases::export_folder(case_folder, cases::with_named_meshes(knee));
          const plan_export::ExportSummary summary = plan_export::export_plan(knee, folder, stop);
          if (summary.was_stopped) {
            outcome.was_stopped = true;
            outcome.text = "The export was stopped: nothing was written.";
            return outcome;
          }
          outcome.text = "Exported into " + folder.string() + ":";
          for (const auto& file : summary.files) outcome.text += " " + file.filename().string();
          outcome.doubts = summary.doubts;
          outcome.wrong = wrong;
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
