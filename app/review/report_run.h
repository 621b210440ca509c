// The report of one session, or of a case without any, written by `arthronaut report` in a process of its
// own: report_SESSION.pdf or report.pdf in the folder "export" of the case, which is its owner's alone to
// read. It names nobody.
//
// Threads: made and asked on the window's thread; one worker waits for the process. Its destructor ends it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/own_process/own_process.h"
#include "navigation/worker/worker.h"

namespace arthronaut::review {

class ReportRun {
 public:
  // session: its folder's name; empty: of the case. on_news is called from the other thread when it has
  // ended.
  ReportRun(const std::filesystem::path& case_folder, const std::string& session,
            std::function<void()> on_news, const std::filesystem::path& program = "/proc/self/exe");
  [[nodiscard]] bool has_ended() const { return worker_.has_ended(); }
  // Once it has ended: why there is no report; empty: it is there.
  [[nodiscard]] std::string problem() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  worker::Worker<int, own_process::CommandOutcome> worker_;
};

}  // namespace arthronaut::review
