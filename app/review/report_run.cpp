#include "app/review/report_run.h"

#include <vector>

#include "planning/cases/plan_file.h"
#include "planning/files/private_folder.h"

namespace arthronaut::review {

namespace {

// A report may have been read and told of: none is replaced without a word.
std::filesystem::path free_file(const std::filesystem::path& folder, const std::string& name) {
  std::error_code unknown;
  std::filesystem::path file = folder / (name + ".pdf");
  for (int number = 2; std::filesystem::exists(file, unknown); ++number)
    file = folder / (name + "_" + std::to_string(number) + ".pdf");
  return file;
}

}  // namespace

ReportRun::ReportRun(const std::filesystem::path& case_folder, const cases::Plan& plan,
                     const std::string& session, std::function<void()> on_news,
                     const std::filesystem::path& program)
    : file_(free_file(cases::export_folder(case_folder, plan),
                      session.empty() ? "report" : "report_" + session)),
      plan_sha256_(cases::plan_sha256(plan)),
      worker_(
          worker::Backlog::Lossless,
          [case_folder, session, program, file = file_](auto& inbox) {
            files::create_private_folder(file.parent_path());
            std::vector<std::string> words{"report", case_folder.string()};
            if (!session.empty()) words.insert(words.end(), {"--session", session});
            words.insert(words.end(), {"-o", file.string()});
            Progress progress;
            progress.outcome = own_process::run_command(
                program, words, file.string() + ".log", [&inbox] { return inbox.stops(); },
                [&](const std::string& what, double share) {
                  progress.what = what;
                  progress.share = share;
                  inbox.publish(progress);
                });
            inbox.publish(progress);
          },
          std::move(on_news)) {}

ReportRun::Progress ReportRun::progress() const {
  const auto latest = worker_.latest();
  return latest != nullptr ? *latest : Progress{};
}

bool ReportRun::was_stopped() const {
  const auto outcome = progress().outcome;
  return outcome && outcome->end == own_process::CommandOutcome::End::Stopped;
}

std::string ReportRun::problem() const {
  using End = own_process::CommandOutcome::End;
  if (const std::string failure = worker_.failure(); !failure.empty()) return failure;
  const auto outcome = progress().outcome;
  if (!outcome) return "the report is not written yet";
  if (outcome->end == End::Done || outcome->end == End::Unreliable) return {};
  return outcome->words.empty() ? "the report could not be written" : outcome->words;
}

}  // namespace arthronaut::review
