// Keys for where the screen is shown: on two screens, as a picture, as a video, as a stream.
#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/window/workstation_window.h"

namespace arthronaut::window {

using widgets::GraphicsWindow;

namespace {

// Why nothing of the screen may be written into the case; empty where it may.
std::string refusal_to_keep(const open_case::CaseOpening* opened) {
  if (opened == nullptr) return "no case is open";
  return opened->is_read_only() ? "the case " + opened->read_only_reason() : "";
}

}  // namespace

void WorkstationWindow::add_screen_actions() {
  const auto refusal = [this] {
    const std::string words = refusal_to_keep(case_.get());
    return words.empty() && shows_start_
               ? "other patients may be named here, and a case's pictures go to the archive"
               : words;
  };
  const auto folder = [this] { return case_ != nullptr ? case_->folder() : std::filesystem::path(); };
  actions_.add(
      {"app.two_screens", "Two screens",
       "The window across two screens that stand side by side: in theatre the video has one of them",
       GLFW_KEY_F11, 0, false, [this] { return window_.covers_two() || GraphicsWindow::can_cover_two(); },
       [this] { return window_.covers_two(); }, [this] { window_.cover_two(!window_.covers_two()); }});
  actions_.add({"app.screenshot",
                "Screenshot",
                "What the screen shows as a picture in the case, with the patient's name if it shows it",
                GLFW_KEY_F12,
                0,
                false,
                {},
                {},
                [this, folder, refusal] { copies_.take_screenshot(folder(), refusal()); }});
  actions_.add({"app.record_screen",
                "Record screen",
                "What the screen shows as a video in the case, until the key is pressed again",
                GLFW_KEY_F12,
                GLFW_MOD_CONTROL,
                false,
                {},
                [this] { return copies_.is_recording(); },
                [this, folder] { copies_.toggle_recording(folder(), refusal_to_keep(case_.get())); }});
  actions_.add(
      {"app.send_screen",
       "Send screen",
       "What the screen shows as a stream to where theatre.json says, until the key is pressed again",
       GLFW_KEY_F12,
       GLFW_MOD_SHIFT,
       false,
       {},
       [this] { return copies_.is_streaming(); },
       [this] { copies_.toggle_stream(); }});
}

// The last two steps of a frame: draw -> swap, with a copy where one is wanted.
void WorkstationWindow::end_frame(double now_s) {
  const std::shared_ptr<widgets::ScreenPicture> copy = copies_.wanted(now_s);
  if (copy != nullptr) widgets::copy_screen_into(*copy, now_s);
  {
    const widgets::WidgetLog::Timed timed(log_, "draw_ms");
    window_.draw_frame();
  }
  {
    const widgets::WidgetLog::Timed timed(log_, "swap_ms");
    window_.show_frame(std::any_of(modes_.begin(), modes_.end(),
                                   [](const auto& mode) { return mode->pictures_are_late(); }));
  }
  log_.add("drawn_px", static_cast<double>(window_.drawn_px()));
  shown().on_screen();
  if (copy != nullptr) copies_.take(copy);
}

}  // namespace arthronaut::window
