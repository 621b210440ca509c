#include <GLFW/glfw3.h>

#include "app/theatre_view/theatre_view.h"

namespace arthronaut::theatre_view {

void TheatreView::add_actions(widgets::Actions& actions) {
  const auto running = [this] { return is_running(); };
  const auto simulates = [this] { return can_simulate(); };
  actions.add({"operate.next",
               "Next step",
               "Starts, registers, drills: whatever comes next",
               GLFW_KEY_SPACE,
               0,
               false,
               [this] { return model_ != nullptr; },
               {},
               [this] { take_next_step(); }});
  actions.add({"operate.scratch", "Simulate: probe", "The simulated surgeon touches the bone with the probe",
               GLFW_KEY_S, 0, false, simulates,
               [this] { return is_running() && part_ == SimulatedPart::Scratch; },
               [this] { start_simulation(SimulatedPart::Scratch); }});
  actions.add({"operate.drill", "Simulate: drill", "The simulated surgeon aims the guide and drills",
               GLFW_KEY_G, 0, false, simulates,
               [this] { return is_running() && part_ == SimulatedPart::Drill; },
               [this] { start_simulation(SimulatedPart::Drill); }});
  actions.add({"operate.video",
               "Video of the case",
               "Navigates on the next video in the case's folder",
               GLFW_KEY_O,
               0,
               false,
               [this] { return model_ != nullptr && !videos_of(case_folder_).empty(); },
               {},
               [this] { start_video(); }});
  actions.add({"operate.stop",
               "Stop",
               "Ends the source",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return operation_ != nullptr; },
               {},
               [this] {
                 operation_.reset();
                 options_.reset();
               }});
  actions.add({"operate.digitise", "Probe draws",
               "While on, where the probe's tip goes is kept for the registration", GLFW_KEY_D, 0, false,
               running, [this] { return is_running() && status_.digitises; },
               [this] { operation_->set_digitising(!status_.digitises); }});
  actions.add({"operate.clear",
               "Clear points",
               "Forgets what the probe drew",
               GLFW_KEY_C,
               0,
               false,
               [this] { return operation_ != nullptr && !status_.trail->empty(); },
               {},
               [this] { operation_->clear_curves(); }});
  actions.add({"operate.register",
               "Register",
               "Fits the bone to what the probe drew",
               GLFW_KEY_R,
               0,
               false,
               [this] { return operation_ != nullptr && !status_.trail->empty() && !status_.is_registering; },
               {},
               [this] { operation_->register_curves(); }});
  actions.add({"operate.record", "Record", "Keeps video, poses and decisions in the case", GLFW_KEY_R,
               GLFW_MOD_CONTROL, false, running, [this] { return !status_.recording.empty(); },
               [this] { toggle_recording(); }});
  actions.add({"operate.overlay",
               "Plan on video",
               "Full, off; it fades by itself",
               GLFW_KEY_V,
               0,
               false,
               {},
               [this] { return choices_.overlay_on; },
               [this] { cycle_overlay(); }});
  actions.add({"operate.undistort",
               "Undistorted",
               "The picture without the lens' distortion: what is straight is straight",
               GLFW_KEY_U,
               0,
               false,
               {},
               [this] { return choices_.undistorts; },
               [this] { choices_.undistorts = !choices_.undistorts; }});
  actions.add({"operate.bone",
               "Other bone",
               "Navigate on the other bone",
               GLFW_KEY_TAB,
               0,
               false,
               [this] {
                 const auto other = choices_.bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia
                                                                            : bones::BoneKind::Femur;
                 return model_ != nullptr && model_->has_bone(other);
               },
               {},
               [this] {
                 operation_.reset();
                 options_.reset();
                 choices_.bone = choices_.bone == bones::BoneKind::Femur ? bones::BoneKind::Tibia
                                                                         : bones::BoneKind::Femur;
                 look_along_plan();
               }});
  actions.add({"operate.medium",
               "Saline",
               "Saline while on, air while off; for the next video",
               GLFW_KEY_M,
               0,
               false,
               {},
               [this] { return choices_.saline; },
               [this] { choices_.saline = !choices_.saline; }});
}

void TheatreView::draw_controls(const widgets::Ui& ui, const widgets::Rect& area) {
  const float gap = ui.theme.px(10), height = (area.height - gap) / 2;
  const auto row = [&](float y, std::initializer_list<const char*> ids) {
    const float width =
        (area.width - gap * static_cast<float>(ids.size() - 1)) / static_cast<float>(ids.size());
    float x = area.x;
    for (const char* id : ids) {
      ImGui::SetCursorScreenPos({x, y});
      widgets::action_button(ui, id, width, height);
      x += width + gap;
    }
  };
  row(area.y, {"operate.next", "operate.scratch", "operate.drill", "operate.video", "operate.medium",
               "operate.stop"});
  row(area.y + height + gap, {"operate.digitise", "operate.clear", "operate.register", "operate.overlay",
                              "operate.undistort", "operate.bone", "operate.record"});
}

}  // namespace arthronaut::theatre_view
