// Collecting the poses of a tool that is pivoted on its tip, or turned in its sleeve, without threads: a Job
// of LiveRun. The poses are taken in the frame of the first world marker that is seen with the tool.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/markers/seen_bodies.h"
#include "navigation/pipeline/medium_check.h"
#include "navigation/pipeline/view_tracker.h"
#include "navigation/tools/pivot_calibration.h"
#include "navigation/tools/spin_calibration.h"

namespace arthronaut::setup {

enum class ToolTask {
  Tip,   // pivoted on its tip
  Axis,  // turned about its axis
};

struct ToolChoice {
  std::string tool_name;
  ToolTask task = ToolTask::Tip;
};

// What can be calibrated of these tools: the tip of each that has one (or nothing), the axis of each that has
// one.
[[nodiscard]] std::vector<ToolChoice> choices_of(const tools::ToolSet& tools);

struct ToolResult {
  ToolTask task = ToolTask::Tip;
  tools::PivotCalibrationSummary tip;  // of the task, the other was not run
  tools::SpinCalibrationSummary axis;
  [[nodiscard]] bool is_usable() const { return task == ToolTask::Tip ? tip.is_usable() : axis.is_usable(); }
  [[nodiscard]] double rms_mm() const { return task == ToolTask::Tip ? tip.rms_mm : axis.rms_mm; }
};

// The tools with the result in the place of what was known, and where it comes from. Precondition: the tool
// is there, the result usable.
[[nodiscard]] tools::ToolSet with_result(tools::ToolSet tools, const std::string& tool_name,
                                         const ToolResult& result, const provenance::Provenance& provenance);

struct ToolStatus {
  camera::FramePtr picture;
  struct Seen {
    std::string name = "";
    bool stands = false;
    std::string text = "";                        // its state in words
    std::array<Eigen::Vector2d, 4> corners_px{};  // meaningful when it stands
  };
  std::vector<Seen> markers;  // the tool, then the world markers
  std::string reason;         // why this picture does not count; empty when it does
  std::size_t pose_count = 0;
  bool is_collecting = true;
  camera::Boundary view;                     // the round view; radius 0: not known
  std::shared_ptr<const ToolResult> result;  // of the poses so far; null before the first few
};

class ToolJob {
 public:
  using Status = ToolStatus;

  // Throws InvalidInput for an unusable calibration, a tool that is not there, a set without world markers.
  ToolJob(const pipeline::ViewTrackerOptions& view, const tools::ToolSet& tools, const ToolChoice& choice);

  void look(const camera::FramePtr& frame);
  bool work();  // calibrates anew when enough poses have come
  [[nodiscard]] bool wants_next_still() const { return true; }
  [[nodiscard]] Status status() const;

  void clear();
  // No more poses: this result stays.
  void settle(std::shared_ptr<const ToolResult> result);

 private:
  void judge_markers();
  void judge_medium(const camera::Frame& frame);
  // Of the picture in view_. Precondition: it is declared.
  [[nodiscard]] const markers::BodyObservation& body_of(int id) const;
  [[nodiscard]] const markers::MarkerObservation& outlined_marker(const markers::BodyObservation& body) const;

  ToolChoice choice_;
  tools::ToolSet tools_;
  markers::SeenBodies seen_bodies_;
  pipeline::ViewTracker tracker_;
  pipeline::MediumCheck medium_;
  pipeline::SecondLook second_look_;
  pipeline::PictureObservation view_;
  std::vector<markers::BodyObservation> bodies_;  // of view_
  std::vector<geometry::RigidTransform> fixed_from_tool_;
  std::vector<std::int64_t> taken_ns_;  // each of them
  std::optional<int> world_id_;         // whose frame the poses are in
  std::size_t calibrated_count_ = 0;
  ToolStatus status_;
};

}  // namespace arthronaut::setup
