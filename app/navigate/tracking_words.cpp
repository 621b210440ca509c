#include "app/navigate/tracking_words.h"

#include "app/navigate/beginning_words.h"

namespace arthronaut::navigate {

namespace {

using widgets::Severity;

// Without the folder: that the record is this operation's goes without saying.
std::string record_trouble_of(const theatre::LiveState& live) {
  const std::string folder = live.session_folder.string() + ": ";
  return live.record_trouble.starts_with(folder) ? live.record_trouble.substr(folder.size())
                                                 : live.record_trouble;
}

// What a record holds that has begun is kept, however it ends.
const char* trouble_title(const theatre::LiveState& live) {
  return live.session_folder.empty() ? "Nothing is recorded" : "Record ended early";
}

SeverityText recording_row(const theatre::LiveState& live, bool pictures_come) {
  if (!live.record_trouble.empty()) return {Severity::Bad, trouble_title(live), record_trouble_of(live)};
  if (live.session_folder.empty())
    return {Severity::Caution, "Nothing is recorded", "the case has no folder"};
  if (live.phase != theatre::LiveState::Phase::Running) return {Severity::Quiet, "Recording", "ended"};
  const std::string what = live.keeps_video ? "video and journal" : "journal";
  if (!pictures_come) return {Severity::Quiet, "Recording", what + "; no pictures come"};
  return {live.keeps_video ? Severity::Good : Severity::Quiet, "Recording", what};
}

// Median, and what 99 of 100 pictures keep.
std::string range_text(const theatre::StageLatency& stage) {
  return widgets::fixed(stage.median_ms, 0) + " (" + widgets::fixed(stage.p99_ms, 0) + ")";
}

}  // namespace

std::string record_notice(const theatre::LiveState& live, bool wants_video) {
  if (live.phase != theatre::LiveState::Phase::Running) return "";
  if (!live.record_trouble.empty()) return std::string(trouble_title(live)) + ": " + record_trouble_of(live);
  if (wants_video && !live.video_trouble.empty())
    return "The video is not recorded any more, poses and decisions are: " + live.video_trouble;
  return "";
}

std::vector<SeverityText> contour_rows(const operation::OperationState& state) {
  using contour::ContourState;
  const contour::ContourVerdict& seen = state.contour;
  const std::string name = "Bone in picture";
  switch (seen.state) {
    case ContourState::Drifted:
      return {{Severity::Bad, name, widgets::fixed(seen.drift_mm, 1) + " mm from where it lay"}};
    case ContourState::LooksOtherwise:
      return {{Severity::Caution, name, "does not look as it did"}};
    case ContourState::Holds:
      return {{Severity::Quiet, name, "no shift seen (from 1 to 1.7 mm on)"}};
    case ContourState::NotChecked:
      if (seen.reason == contour::NotCheckedReason::NoRegistration) return {};
      return {{Severity::Quiet, name, "not checked: " + std::string(contour::to_text(seen.reason))}};
  }
  return {};
}

std::vector<SeverityText> source_rows(const theatre::LiveState& live) {
  std::vector<SeverityText> rows;
  if (live.trouble != theatre::SourceTrouble::None) {
    const bool still_guides = live.trouble == theatre::SourceTrouble::Torn ||
                              live.trouble == theatre::SourceTrouble::Repeated ||
                              live.trouble == theatre::SourceTrouble::Lost;
    rows.push_back({still_guides ? Severity::Caution : Severity::Bad, "Source", live.trouble_words});
  }
  using theatre::Stage;
  const theatre::StageLatency& guidance = of(live.latency, Stage::ToGuidance);
  if (guidance.count == 0) return rows;
  const theatre::StageLatency& screen = of(live.latency, Stage::ToScreen);
  std::string text = range_text(guidance) + " ms to guidance";
  if (screen.count > 0) text += ", " + range_text(screen) + " ms to the screen";
  const Severity severity = live.trouble == theatre::SourceTrouble::Late ? Severity::Bad : Severity::Quiet;
  rows.push_back({severity, "Latency", text});
  std::string stages;
  for (const Stage stage : {Stage::Capture, Stage::Decode, Stage::Queue, Stage::Tracking, Stage::Operation,
                            Stage::Publish, Stage::Display})
    if (const theatre::StageLatency& one = of(live.latency, stage); one.count > 0)
      stages +=
          (stages.empty() ? "" : ", ") + std::string(to_text(stage)) + " " + widgets::fixed(one.median_ms, 1);
  rows.push_back({Severity::Quiet, "Stages, ms", stages});
  return rows;
}

std::vector<SeverityText> beginning_rows(const operation::OperationState& state, const std::string& patient,
                                         const plan_review::TunnelVerdict& verdict) {
  using Topic = CardLine::Topic;
  std::vector<SeverityText> rows;
  std::string knee;
  for (const CardLine& line : time_out_lines(state, patient, verdict)) {
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
