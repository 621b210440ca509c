// Whether the session that is looked at is still what was recorded (recording::check_session), found out
// beside the screen.
//
// Threads: made and asked on the window's thread; one worker reads. Letting go of it ends it within a record
// of the chain, 64 MiB at most.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "navigation/recording/session_check.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

struct CheckProgress {
  int percent = 0;
  std::optional<recording::SessionCheck> result;  // once it has ended
};

class CheckRun {
 public:
  CheckRun(const std::filesystem::path& session_folder, std::function<void()> on_news);
  [[nodiscard]] CheckProgress progress() const;
  [[nodiscard]] std::string error() const { return worker_.failure(); }  // empty: none

 private:
  worker::Worker<int, CheckProgress> worker_;
};

}  // namespace arthronaut::review
