#include "app/plan/export_work.h"

#include <chrono>
#include <exception>

#include "planning/plan_export/plan_export.h"

namespace arthronaut::plan {

void ExportWork::start(cases::Case knee, std::filesystem::path folder) {
  running_ = std::async(std::launch::async, [this, knee = std::move(knee), folder = std::move(folder)] {
    std::string outcome;
    try {  // a full disk is a state of the screen
      const plan_export::ExportSummary summary = plan_export::export_plan(knee, folder);
      outcome = "Exported into " + folder.string() + ":";
      for (const auto& file : summary.files) outcome += " " + file.filename().string();
      for (const std::string& doubt : summary.doubts) outcome += "\nLook: " + doubt;
    } catch (const std::exception& error) {  // the top of a thread: the geometry library's assertions too
      outcome = std::string("Not exported: ") + error.what();
    }
    wake_();
    return outcome;
  });
}

std::optional<std::string> ExportWork::take_outcome() {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  return running_.get();
}

}  // namespace arthronaut::plan
