// The plan written for other programs while the screen goes on: drilling the bones takes a while.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>

#include "planning/cases/case.h"

namespace arthronaut::plan {

class ExportWork {
 public:
  // wake: called from another thread when it is done.
  explicit ExportWork(std::function<void()> wake) : wake_(std::move(wake)) {}

  // As `arthronaut plan --export` writes them (plan_export::export_plan). Precondition: not is_running().
  void start(cases::Case knee, std::filesystem::path folder);
  [[nodiscard]] bool is_running() const { return running_.valid(); }
  // For every frame: once what was written, or why nothing was; nullopt while there is no news.
  [[nodiscard]] std::optional<std::string> take_outcome();

 private:
  std::function<void()> wake_;
  std::future<std::string> running_;  // last: ends first
};

}  // namespace arthronaut::plan
