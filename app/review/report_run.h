// The report of one session, or of a case without any, written by `arthronaut report` in a process of its
// own: report_SESSION.pdf or report.pdf in the plan's folder within "export" of the case
// (cases::export_folder), which is its owner's alone to read. It names nobody. One that is there stays: the
// next is report_2.pdf, report_3.pdf.
//
// Threads: made and asked on the window's thread; one worker waits for the process. Its destructor ends it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/own_process/own_process.h"
#include "navigation/worker/worker.h"
#include "planning/cases/case.h"

namespace arthronaut::review {

class ReportRun {
 public:
  // plan: cases::with_named_meshes() of the case, as it is saved: what the report names is its hash. session:
  // its folder's name; empty: of the case. on_news is called from the other thread whenever progress() has
  // changed.
  ReportRun(const std::filesystem::path& case_folder, const cases::Plan& plan, const std::string& session,
            std::function<void()> on_news, const std::filesystem::path& program = "/proc/self/exe");
  [[nodiscard]] bool has_ended() const { return worker_.has_ended(); }
  // Nothing is written then.
  void stop() { worker_.request_stop(); }
  // What goes on, and how much of the whole is done, 0 to 1.
  struct Progress {
    std::string what = "Beginning";
    double share = 0;
    std::optional<own_process::CommandOutcome> outcome = {};  // once it has ended
  };
  [[nodiscard]] Progress progress() const;
  [[nodiscard]] bool was_stopped() const;
  // Once it has ended: why there is no report; empty: it is there.
  [[nodiscard]] std::string problem() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  // Which plan it tells of, see cases::plan_sha256.
  [[nodiscard]] const std::string& plan_sha256() const { return plan_sha256_; }

 private:
  std::filesystem::path file_;
  std::string plan_sha256_;
  worker::Worker<int, Progress> worker_;
};

}  // namespace arthronaut::review
