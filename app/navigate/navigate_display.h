// What may stand on the theatre screen at this moment. Every panel asks here, so that the overlay, the guide
// and the numbers come and go together: what is not valid now is not drawn, and the reason stands in its
// place.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "app/navigate/live_words.h"
#include "app/widgets/controls.h"

namespace arthronaut::navigate {

struct NavigateDisplay {
  bool has_picture = false;       // a picture may be shown; false: nothing but the reason
  bool is_live = false;           // ... and it is of now
  bool world_is_placed = false;   // ... and where the bone's marker is is known, by whichever eye
  bool overlay_is_valid = false;  // what was touched lies on this picture where it was touched
  bool plan_is_valid = false;     // ... and the plan's lines belong to it: a registration stands
  bool tip_is_valid = false;      // ... and where the probe's tip is to the bone is known
  bool guidance_is_valid = false;
  // A registration stands, and the step in which known places are touched by it was passed over.
  bool is_unverified = false;
  double age_s = 0;              // of the picture, from its capture to now; with is_live or when it is late
  std::string headline, detail;  // why not; empty while guidance is valid
  guidance::GuidanceNumbers guidance;  // meaningful when guidance_is_valid
  operation::GuidanceGrades grades;    // likewise: how good they are
  // Of a drill that is seen by its own marker, also while the guide is not: over a wire there is none.
  std::optional<guidance::DrillDepth> drill;
};

// A drill that is seen at the plan is about to leave the bone on the far side, or has.
[[nodiscard]] bool breaks_out(const NavigateDisplay& display);
// Bullseye and numbers are looked at: something guides, did so a moment ago, or a drill with a marker of its
// own is seen, with which no guide need be.
[[nodiscard]] bool gets_screen(const NavigateDisplay& display, const operation::OperationState& state);
// A source runs or is being opened: it has to be stopped before the other bone is taken.
[[nodiscard]] bool is_under_way(const theatre::LiveState& live);
// One is being opened, or is open and has given no picture yet: nothing can be asked of anybody.
[[nodiscard]] bool awaits_picture(const theatre::LiveState& live);
// Live pictures are nearly too old to guide, or older, by when they were looked at: the machine has too much
// to do.
[[nodiscard]] bool pictures_are_late(const theatre::LiveState& live);
// What live.operation says is of the source before: the one that was started last is still being opened, or
// could not be.
[[nodiscard]] bool is_of_source_before(const theatre::LiveState& live);

// What fills the screen beside the picture: the registration that is being made, or the way to the plan.
enum class NavigateLayout { Register, Guide };
// A guide that is hidden for no longer than this does not change the screen.
inline constexpr double kGuideAway_s = 2;
// That of the tool which the step takes: of the one of now, or of the one that the surgeon went back to.
// since_guidance_s: how long ago guidance was valid last; infinite when it never was. since_touch_s:
// likewise, how long ago a touch was asked for: what came of it is read first.
[[nodiscard]] NavigateLayout layout_of(const theatre::LiveState& live, double since_guidance_s,
                                       std::optional<operation::Step> looked_at = std::nullopt,
                                       double since_touch_s = std::numeric_limits<double>::infinity());

// Whether the newest picture is of this moment: NavigateDisplay::is_live, without its words.
[[nodiscard]] bool is_live(const theatre::LiveState* live, double now_s);

// now_s on the clock of theatre::LiveOperation::now_s(). live may be null: no bone was looked at yet.
[[nodiscard]] NavigateDisplay display_of(const theatre::LiveState* live, double now_s);

}  // namespace arthronaut::navigate
