#include "app/report/session_sections.h"

#include "app/report/report_words.h"
#include "app/report/session_rows.h"

namespace arthronaut::report {

void draw_registration(FlowingPages& pages, const registration::RegistrationSummary& registration) {
  const auto of_pose = [&](double value_mm) {
    return registration.has_pose ? number(value_mm, " mm", 2) : std::string("\u2013");
  };
  pages.heading("Registration of the bone");
  pages.pairs({{"Verdict", registration.reliable ? "reliable" : "NOT RELIABLE"},
               {"Touched points", std::to_string(registration.point_count)},
               {"Distance of the points to the bone, RMS", of_pose(registration.rms_mm)},
               {"Points that fit",
                registration.has_pose ? number(100 * registration.inlier_fraction, " %", 0) : "\u2013"},
               {"Predicted error at the target, one sigma", of_pose(registration.predicted_tre_mm)}});
  for (const auto& reason : registration.reasons) pages.sentence("– " + reason, {.ink = kWarning});
  for (const auto& assumption : registration.assumptions) pages.sentence("– assumed: " + assumption);
  pages.sentence(
      "A small distance of the points does not prove a small error at the tunnel: the predicted error is the "
      "figure to go by.",
      {.size_pt = 8, .ink = kGray});
}

void draw_time_line(FlowingPages& pages, const Content& content, std::size_t most_rows) {
  const recording::RecordedSession& session = *content.session;
  std::vector<std::vector<std::string>> rows;
  for (const Step& step : steps_of(session)) rows.push_back({recording::clock_text(step.time_s), step.words});
  if (!rows.empty()) {
    pages.heading("Steps");
    rows.insert(rows.begin(), {"Time", "Step"});
    pages.list({24, 146}, rows, most_rows);
  }
  if (content.marks.empty() && content.marks_problem.empty()) return;
  pages.heading("Marks of who looked at the session");
  rows = {{"Time", "Note"}};
  for (const recording::SessionMark& mark : content.marks)
    rows.push_back({recording::clock_text(time_s(session, mark.timestamp_ns)),
                    (mark.note.empty() ? std::string("(no note)") : mark.note) + "  (frame " +
                        std::to_string(mark.frame) + ")"});
  if (!content.marks.empty()) pages.list({24, 146}, rows, most_rows);
  if (!content.marks_problem.empty())
    pages.sentence("NOT READABLE: " + content.marks_problem, {.ink = kWarning});
}

}  // namespace arthronaut::report
