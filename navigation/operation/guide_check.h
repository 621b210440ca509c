// Whether a nominal guide was held against a known place before it guides in a live operation.
//
// A guide that was calibrated says by a residual how well it is known; one that was turned in its sleeve, of
// its line alone, and not where on it the guide ends. One that was taken from a drawing may be another one,
// or its marker may be glued on elsewhere: everything else would be right, and the tunnel beside the plan. So
// its tip is held on the control point, which the probe has touched: where the guide's numbers put its tip,
// and where the probe's put the point, must be the same place. That tells the tip in all three directions; of
// the axis' direction it says nothing, whose predicted error stays that of a nominal guide.
//
// Thread-free, deterministic.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "navigation/operation/touches.h"
#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::operation {

// Why a touch, a check or the word that the marker is out was not taken.
enum class TouchRefusal {
  None,
  NoSource,
  TipUnknown,
  TipMoves,
  NoControlPoint,
  MarkerIsSeen,  // said to be out
  TimeOutDue,    // see SourceSetup::time_out_first
};
[[nodiscard]] TouchRefusal refusal_of(SteadyTip::Reason reason);

enum class GuideStanding {
  NotAsked,  // no live source, no such guide, or one that was measured, its end too
  Due,
  Off,      // held against the control point, and elsewhere
  Checked,  // found there
  Trusted,  // by the word of whoever began; nobody checked
};

struct GuideCheckState {
  GuideStanding standing = GuideStanding::NotAsked;
  double error_mm = 0;     // with Off and Checked: tip to control point
  bool has_point = false;  // a control point to hold it on, touched with this camera, probe and medium
  [[nodiscard]] bool may_guide() const {
    return standing != GuideStanding::Due && standing != GuideStanding::Off;
  }
};

class GuideCheck {
 public:
  // Of a source with these tools, through that camera and medium. What was found of the same guide before
  // holds on, whatever marker or plan came meanwhile.
  void begin(const pipeline::PipelineOptions& options, const registration::Provenance& now, bool is_live);
  void add(const pipeline::FrameResult& frame);
  // No picture comes any more.
  void end_source() { tip_.clear(); }

  // The tip rests where the control point is, in the world-marker frame; empty: none was touched. Nothing
  // changes with a refusal.
  TouchRefusal check(const std::optional<Eigen::Vector3d>& control_point_mm, const TouchLimits& limits);
  void trust();
  // What was found of it in this source after that time was found wrongly.
  void forget_since(std::int64_t time_ns);
  // The control point that it was held on is gone: that it was off there says nothing any more.
  void forget_point();

  [[nodiscard]] const GuideCheckState& state() const { return state_; }

 private:
  struct Subject {  // what was checked, and by means of what
    tools::Tool guide;
    registration::Provenance of;
  };
  [[nodiscard]] static bool is_same(const Subject& a, const Subject& b);

  std::optional<Subject> subject_;  // empty: nothing is to be checked
  std::optional<std::size_t> place_in_frame_;
  SteadyTip tip_;
  // Of this source: of its newest frame, and of the frame in which it was held; min: before all of its
  // frames.
  std::int64_t now_ns_ = std::numeric_limits<std::int64_t>::min(), held_ns_ = now_ns_;
  GuideCheckState state_;
};

}  // namespace arthronaut::operation
