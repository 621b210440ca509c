#include "app/review/check_run.h"
#include "app/review/report_run.h"
#include "app/review/review_panels.h"
#include "app/review/session_list.h"
#include "app/widgets/source_banner.h"
#include "navigation/camera/calibration_words.h"
#include "planning/files/format.h"

namespace arthronaut::review {

namespace {

// Of a whole one in a line: what happened in it stands below and needs the room.
std::string words_of(const recording::SessionCheck& check) {
  if (!check.is_unbroken() || !check.was_finished) return recording::check_words(check);
  return files::format("as recorded: %.1f MB, %lld hashes", static_cast<double>(check.covered_bytes) / 1e6,
                       static_cast<long long>(check.record_count));
}

}  // namespace

void draw_check(const widgets::Ui& ui, const CheckRun& run, const SessionList& sessions) {
  using Outcome = recording::SessionCheck::Outcome;
  const std::string error = run.error();
  const CheckProgress progress = run.progress();
  if (!error.empty()) {
    ui.log.note_state("record", "failed");
    return widgets::status_row(ui, widgets::Severity::Bad, "Record", error);
  }
  if (!progress.result) {
    ui.log.note_state("record", "checking");
    return widgets::status_row(ui, widgets::Severity::Quiet, "Record",
                               "checked to " + std::to_string(progress.percent) + " %");
  }
  const recording::SessionCheck& check = *progress.result;
  const bool is_broken = check.outcome == Outcome::Broken;
  ui.log.note_state("record", is_broken ? "broken" : check.is_unbroken() ? "unbroken" : "unknown");
  widgets::status_row(ui,
                      is_broken             ? widgets::Severity::Bad
                      : check.is_unbroken() ? widgets::Severity::Good
                                            : widgets::Severity::Quiet,
                      is_broken ? "Not as recorded" : "Record", sessions.within(words_of(check)));
}

void draw_camera(const widgets::Ui& ui, const SessionReview& review) {
  const auto& camera = review.session->options.calibrated;
  if (camera == nullptr) return;  // why stands among what is not whole
  const std::string words = camera::in_words(*camera);
  ui.log.note_state("camera", words);
  widgets::status_row(ui, widgets::Severity::Quiet, "Camera", words);
}

void draw_report(const widgets::Ui& ui, const ReportRun* report, const std::string& refusal, bool is_of_now) {
  if (!refusal.empty()) {
    ui.log.note_state("report", "refused");
    widgets::status_row(ui, widgets::Severity::Bad, "No report", refusal);
    return;
  }
  const bool has_ended = report != nullptr && report->has_ended();
  const std::string problem = has_ended ? report->problem() : "";
  ui.log.note_state("report", report == nullptr       ? "none"
                              : !has_ended            ? "running"
                              : report->was_stopped() ? "stopped"
                              : !problem.empty()      ? "failed"
                              : is_of_now             ? "written"
                                                      : "of an earlier plan");
  if (report == nullptr) return;
  if (!has_ended) {
    const ReportRun::Progress progress = report->progress();
    ui.log.note_state("report_part", progress.what);
    widgets::text_in(ui.theme.body, widgets::kQuietText, "Report: " + progress.what + ". R stops it.");
    ImGui::ProgressBar(static_cast<float>(progress.share), {-1, 0});
  } else if (report->was_stopped())
    widgets::status_row(ui, widgets::Severity::Quiet, "Report", "stopped; nothing was written");
  else if (problem.empty() && is_of_now)
    widgets::status_row(ui, widgets::Severity::Good, "Report", report->file().string());
  else if (problem.empty())
    widgets::status_row(ui, widgets::Severity::Caution, "Report of an earlier plan",
                        report->file().string() + ": the plan was changed since");
  else
    widgets::status_row(ui, widgets::Severity::Bad, "No report", problem);
}

void draw_origin(const widgets::Ui& ui, const widgets::Rect& area, const recording::SessionHeader& header) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* const font = ui.theme.afar;
  const std::string words = origin_in_words(header);
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, words.c_str());
  const float margin = ui.theme.px(14);
  const widgets::Rect plate{area.x, area.y, size.x + 2 * margin, area.height};
  draw.AddRectFilled(plate.min(), plate.max(), widgets::banner_color(sources::SourceKind::Recording, true),
                     ui.theme.px(6));
  draw.AddText(font, font->FontSize, {plate.x + margin, plate.center().y - size.y / 2}, widgets::kBackground,
               words.c_str());
  ui.log.note("review.origin", plate.min(), plate.max());
  ui.log.note_state("origin", words);
}

}  // namespace arthronaut::review
