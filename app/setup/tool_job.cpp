#include "app/setup/tool_job.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "navigation/tools/measured_part.h"
#include "planning/geometry/error.h"

namespace arthronaut::setup {

namespace {

constexpr std::size_t kMostPoses = 3000;         // a minute at 50 pictures a second
constexpr std::size_t kPosesBetweenResults = 6;  // and a twentieth of those there are

const tools::Tool& tool_of(const tools::ToolSet& tools, const std::string& name) {
  const tools::Tool* tool = tools.find_tool(name);
  if (tool == nullptr) throw InvalidInput("tools.json declares no tool named \"" + name + "\"");
  return *tool;
}

}  // namespace

std::vector<ToolChoice> choices_of(const tools::ToolSet& tools) {
  std::vector<ToolChoice> choices;
  for (const tools::Tool& tool : tools.tools) {
    if (tool.tip_mm || !tool.axis) choices.push_back({tool.name, ToolTask::Tip});
    if (tool.axis) choices.push_back({tool.name, ToolTask::Axis});
  }
  return choices;
}

tools::ToolSet with_result(tools::ToolSet tools, const std::string& tool_name, const ToolResult& result,
                           const provenance::Provenance& provenance) {
  for (tools::Tool& tool : tools.tools) {
    if (tool.name != tool_name) continue;
    result.task == ToolTask::Tip ? tools::take_tip(tool, result.tip, provenance)
                                 : tools::take_axis(tool, result.axis, provenance);
  }
  return tools;
}

ToolJob::ToolJob(const pipeline::ViewTrackerOptions& view, const tools::ToolSet& tools,
                 const ToolChoice& choice)
    : choice_(choice),
      tools_(tools),
      seen_bodies_(tools),
      tracker_(view, markers::make_tracker(markers::declared_markers(tools))),
      medium_(markers::declared_markers(tools), view.refractive_index, view.calibration.refractive_index),
      second_look_(markers::declared_markers(tools), medium_.other_index(),
                   view.calibration.refractive_index) {
  (void)tool_of(tools_, choice_.tool_name);
  if (tools_.tracker)
    throw InvalidInput("the tools of this case are seen by an outside tracker: measure them there");
  if (tools_.world_markers.empty()) throw InvalidInput("tools.json declares no world marker");
}

void ToolJob::look(const camera::FramePtr& frame) {
  status_.picture = frame;
  tracker_.observe(*frame, view_);
  seen_bodies_.observe(view_.markers, view_.camera, bodies_);
  status_.view = view_.camera.boundary();
  judge_markers();
  judge_medium(*frame);
  if (!status_.reason.empty() || !status_.is_collecting) return;
  if (fixed_from_tool_.size() == kMostPoses) {
    status_.reason = "enough poses were taken";
    return;
  }
  const markers::BodyObservation& world = body_of(*world_id_);
  const markers::BodyObservation& tool = body_of(tool_of(tools_, choice_.tool_name).marker_id);
  fixed_from_tool_.push_back(world.camera_from_body.inverse() * tool.camera_from_body);
  taken_ns_.push_back(view_.timestamp_ns);
  status_.pose_count = fixed_from_tool_.size();
}

const markers::BodyObservation& ToolJob::body_of(int id) const {
  return *std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& body) { return body.id == id; });
}

// Of several, the first that is part of the pose.
const markers::MarkerObservation& ToolJob::outlined_marker(const markers::BodyObservation& body) const {
  const std::vector<markers::Body>& bodies = seen_bodies_.declared();
  const auto declared =
      std::find_if(bodies.begin(), bodies.end(), [&](const markers::Body& one) { return one.id == body.id; });
  return view_.markers[declared->first + static_cast<std::size_t>(std::countr_zero(body.used))];
}

void ToolJob::judge_markers() {
  const auto judge = [&](const std::string& name, int id) {
    const markers::BodyObservation& body = body_of(id);
    ToolStatus::Seen seen{name};
    seen.stands = view_.intrinsics_are_known && body.is_tracked() && !view_.is_frozen && !view_.is_repeating;
    seen.text = std::string(markers::to_text(body.state));
    if (body.is_tracked()) {
      seen.corners_px = outlined_marker(body).corners_px;
      if (body.odd_marker != markers::BodyObservation::kNone)
        seen.text += "; marker " + std::to_string(body.odd_marker) + " is out of place";
      if (!view_.intrinsics_are_known) seen.text = "lens angle unknown";
      if (view_.is_frozen) seen.text = "the picture is frozen";
      if (view_.is_repeating) seen.text = "the picture repeats itself";
    }
    status_.markers.push_back(seen);
    return seen.stands;
  };
  status_.markers.clear();
  const bool has_tool = judge(choice_.tool_name, tool_of(tools_, choice_.tool_name).marker_id);
  bool has_world = false;
  for (const tools::WorldMarker& marker : tools_.world_markers) {
    if (world_id_ && *world_id_ != marker.marker_id) continue;  // the poses are in one frame
    if (!judge(std::string(bones::to_text(marker.bone)) + " marker", marker.marker_id)) continue;
    has_world = true;
    if (has_tool) world_id_ = marker.marker_id;
  }
  status_.reason = !has_tool    ? "the marker of the " + choice_.tool_name + " is not seen well"
                   : !has_world ? "no world marker is seen well beside it"
                                : "";
}

// In the wrong medium every pose is wrong, and a tip comes out of them all the same: what was taken since the
// medium was sure goes, too.
void ToolJob::judge_medium(const camera::Frame& frame) {
  medium_.look(view_);
  if (medium_.wants_second_look()) medium_.look_again(view_, second_look_.look(frame, view_.camera));
  const pipeline::MediumVerdict& verdict = medium_.verdict();
  if (verdict.fit != pipeline::MediumFit::Contradicts) return;
  status_.reason = reason_text(verdict);
  for (ToolStatus::Seen& seen : status_.markers) seen.stands = false;
  if (!status_.is_collecting) return;
  while (!taken_ns_.empty() && taken_ns_.back() > verdict.last_sure_ns) {
    taken_ns_.pop_back();
    fixed_from_tool_.pop_back();
  }
  if (fixed_from_tool_.size() == status_.pose_count) return;
  status_.pose_count = fixed_from_tool_.size();
  calibrated_count_ = 0;
  status_.result.reset();
}

bool ToolJob::work() {
  const std::size_t count = fixed_from_tool_.size();
  const std::size_t wait = std::max(kPosesBetweenResults, calibrated_count_ / 20);
  if (!status_.is_collecting || count < calibrated_count_ + wait) return false;
  calibrated_count_ = count;
  auto result = std::make_shared<ToolResult>();
  result->task = choice_.task;
  if (choice_.task == ToolTask::Tip)
    result->tip = tools::calibrate_pivot(fixed_from_tool_);
  else
    result->axis = tools::calibrate_spin(
        fixed_from_tool_, {.declared_direction = tool_of(tools_, choice_.tool_name).axis->direction});
  status_.result = std::move(result);
  return true;
}

ToolStatus ToolJob::status() const { return status_; }

void ToolJob::clear() {
  fixed_from_tool_.clear();
  taken_ns_.clear();
  world_id_.reset();
  calibrated_count_ = 0;
  status_.pose_count = 0;
  status_.is_collecting = true;
  status_.result.reset();
}

void ToolJob::settle(std::shared_ptr<const ToolResult> result) {
  status_.is_collecting = false;
  status_.result = std::move(result);
}

}  // namespace arthronaut::setup
