#include "app/review/postop_run.h"

#include "planning/postop/achieved_file.h"
#include "planning/postop/postop_source.h"

namespace arthronaut::review {

std::filesystem::path achieved_file(const std::filesystem::path& case_folder) {
  return case_folder / "achieved.json";
}

PostopRun::PostopRun(const std::filesystem::path& case_folder, const std::filesystem::path& source,
                     const std::string& series, bool writes, std::function<void()> on_news)
    : worker_(
          worker::Backlog::Lossless,
          [case_folder, source, series, writes](auto& inbox) {
            PostopProgress progress;
            open_case::PostopQuestion question{
                .case_folder = case_folder, .source = source, .series = series};
            question.on_progress = [&](const std::string& what, double share) {
              progress.what = what;
              progress.share = share;
              inbox.publish(progress);
            };
            question.stops = [&] { return inbox.stops(); };
            if (series.empty()) {
              auto which = postop::comparable_series(
                  source, [&](double share) { question.on_progress("Looking for CTs", share); });
              if (inbox.stops()) return;
              if (which.size() == 1) question.series = which.front().uid;
              if (which.size() > 1) {
                progress.which = std::move(which);
                return inbox.publish(progress);
              }
            }
            auto answer = open_case::compare_with_postop(question);
            if (answer.was_stopped || inbox.stops()) return;
            // What the case keeps of its own patient stays.
            if (writes && answer.other_patient.empty())
              postop::write_achieved_file(achieved_file(case_folder), answer.comparisons, answer.places);
            progress.answer = std::make_shared<const open_case::PostopAnswer>(std::move(answer));
            inbox.publish(progress);
          },
          std::move(on_news)) {}

PostopProgress PostopRun::progress() const {
  const auto latest = worker_.latest();
  return latest != nullptr ? *latest : PostopProgress{};
}

}  // namespace arthronaut::review
