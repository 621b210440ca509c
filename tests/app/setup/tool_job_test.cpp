#include "app/setup/tool_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "navigation/camera/medium.h"
#include "navigation/simulator/simulated_ruler.h"

namespace arthronaut::setup {
namespace {

using ::testing::HasSubstr;

// A ruler whose one end is the bone's marker and whose other end is a tool's.
tools::ToolSet ruler_tools() {
  tools::ToolSet tools;
  tools.world_markers = {{bones::BoneKind::Femur, 5, 2.89}};
  tools::Tool end;
  end.name = "ruler end";
  end.marker_id = 6;
  end.size_mm = 2.89;
  tools.tools = {end};
  return tools;
}

// A tip that was found in the wrong medium is wrong by millimetres and looks like any other: no pose is
// taken, those that were go, and why is said. In the right medium they are taken.
TEST(ToolJob, Hazard27TakesNoPoseInTheWrongMedium) {
  for (const double truth : {camera::kSalineIndex, camera::kAirIndex}) {
    simulator::RulerOptions scene;
    scene.camera = simulator::standard_camera();
    scene.refractive_index = truth;
    scene.frame_count = 45;
    scene.rotation_deg = 20;
    simulator::SimulatedRuler source(scene);
    pipeline::ViewTrackerOptions view;
    view.calibration = scene.camera;
    view.refractive_index = camera::kSalineIndex;
    ToolJob job(view, ruler_tools(), {"ruler end", ToolTask::Tip});
    while (const camera::FramePtr frame = source.next()) job.look(frame);
    if (truth == camera::kSalineIndex) {
      EXPECT_GT(job.status().pose_count, 30U) << job.status().reason;
    } else {
      EXPECT_EQ(job.status().pose_count, 0U);
      EXPECT_THAT(job.status().reason, HasSubstr("the markers look as in air, not as in saline"));
    }
  }
}

}  // namespace
}  // namespace arthronaut::setup
