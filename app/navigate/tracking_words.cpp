#include "app/navigate/tracking_words.h"

#include "app/navigate/beginning_words.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

SeverityText recording_row(const theatre::LiveState& live, bool pictures_come) {
  if (!live.record_trouble.empty()) return {Severity::Bad, "Nothing is recorded", live.record_trouble};
  if (live.session_folder.empty())
    return {Severity::Caution, "Nothing is recorded", "the case has no folder"};
  if (live.phase != theatre::LiveState::Phase::Running) return {Severity::Quiet, "Recording", "ended"};
  const std::string what = live.keeps_video ? "video and journal" : "journal";
  if (!pictures_come) return {Severity::Quiet, "Recording", what + "; no pictures come"};
  return {live.keeps_video ? Severity::Good : Severity::Quiet, "Recording", what};
}

}  // namespace

std::vector<SeverityText> beginning_rows(const operation::OperationState& state, const std::string& patient) {
  using Topic = CardLine::Topic;
  std::vector<SeverityText> rows;
  std::string knee;
  for (const CardLine& line : time_out_lines(state, patient)) {
    if (line.topic == Topic::Knee) knee = line.text;
    if (line.topic == Topic::Plan) rows.push_back({line.severity, line.name + ", " + knee, line.text});
    if (line.topic == Topic::Medium) rows.push_back({line.severity, line.name, line.text});
  }
  if (state.depth_stop_mm)
    rows.push_back({Severity::Quiet, "Depth stop", widgets::fixed(*state.depth_stop_mm, 1) + " mm, as read"});
  if (state.resumed != nullptr)
    rows.push_back({Severity::Quiet, "Resumed",
                    state.resumed->session + ", " + std::to_string(state.resumed->stroke_count) +
                        " strokes as history"});
  return rows;
}

std::vector<SeverityText> record_rows(const theatre::LiveState& live, const NavigateDisplay& display) {
  std::vector<SeverityText> rows{recording_row(live, display.is_live)};
  if (!display.is_live) return rows;
  const operation::OperationState& state = *live.operation;
  const bool is_dated = state.source->kind == sources::SourceKind::Live;
  rows.push_back({Severity::Quiet, "Rate",
                  widgets::fixed(live.frames_per_second, 0) + " pictures/s, " +
                      widgets::fixed(state.frame.processing_ms, 0) + " ms each" +
                      (is_dated ? ", " + widgets::fixed(1000 * display.age_s, 0) + " ms old" : "")});
  return rows;
}

}  // namespace arthronaut::navigate
