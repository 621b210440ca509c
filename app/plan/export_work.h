// The plan written for other programs while the screen goes on: drilling the bones takes a while.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "navigation/worker/awaited.h"
#include "planning/cases/case.h"

namespace arthronaut::plan {

struct ExportOutcome {
  std::uint64_t revision = 0;  // PlanModel::revision() of what was exported
  bool is_written = false, was_stopped = false;
  std::string text = {};                 // where what was written, or why nothing was
  std::vector<std::string> doubts = {};  // what to look at in what was written
  std::vector<std::string> wrong = {};   // what of it cannot be drilled like this, by the checks

  // For who may have changed the plan meanwhile.
  [[nodiscard]] std::string in_words(std::uint64_t revision_now) const;
};

class ExportWork {
 public:
  // wake: called from another thread when it is done.
  explicit ExportWork(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~ExportWork() { stop(); }  // and waits
  ExportWork(const ExportWork&) = delete;
  ExportWork& operator=(const ExportWork&) = delete;

  // Into the plan's folder within "export" of the case (cases::export_folder), which is its owner's alone to
  // read, as `arthronaut plan --export` writes them (plan_export::export_plan). Precondition: not
  // is_running(). wrong: what the plan's checks say, which goes into the outcome.
  void start(cases::Case knee, std::uint64_t revision, std::filesystem::path case_folder,
             std::vector<std::string> wrong = {});
  // Nothing will have been written, unless all was drilled by then: the outcome says it.
  void stop() { stop_.request_stop(); }
  [[nodiscard]] bool is_running() const { return running_.is_busy(); }
  // Asked to stop, and not there yet: a bone that is being drilled is drilled to its end.
  [[nodiscard]] bool is_stopping() const { return is_running() && stop_.stop_requested(); }
  // For every frame: once what came of it; nullopt while there is no news.
  [[nodiscard]] std::optional<ExportOutcome> take_outcome();

 private:
  std::function<void()> wake_;
  std::stop_source stop_;
  worker::Awaited<ExportOutcome> running_;  // last: ends first
};

}  // namespace arthronaut::plan
