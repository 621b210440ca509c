// Setting-up mode: the camera is calibrated, the tools are calibrated, the fluid is checked. Made to be
// worked by Space alone, as the theatre is: it does the next sensible step.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/setup/setup_sources.h"
#include "app/setup/station.h"
#include "navigation/sources/background_end.h"

namespace arthronaut::setup {

class SetupView {
 public:
  // wake: ends the window's wait for input; called from other threads.
  // go_on: called when the last part of setting up is done and the next step is wished.
  // turns: shared with whatever else opens cameras.
  SetupView(const std::function<void()>& wake, std::function<void()> go_on,
            const sources::DeviceTurns& turns);
  ~SetupView();

  // Another case; ends what runs. Nothing of it is read before enter().
  void open(const std::filesystem::path& case_folder);
  // This mode comes to the front: sees anew what the case and the machine have.
  void enter();
  // Another mode comes to the front: cameras and files are let go, what was taken stays.
  void leave();
  void add_actions(widgets::Actions& actions);
  // The prefixes of the ids of the actions that work now.
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const;
  void draw(const widgets::Ui& ui, const widgets::Rect& area);
  // A text field was opened in this frame and has not the keyboard yet.
  [[nodiscard]] bool awaits_text() const;
  [[nodiscard]] bool is_busy() const;  // the screen must be drawn again soon

 private:
  struct Step {
    Purpose purpose;
    const char* action;  // that shows it
    const char* prefix;  // of its own actions
    std::unique_ptr<Station> station;
    std::size_t source = 0;
    std::vector<FeedSource> sources = {};
  };

  struct Typed {  // sources that the user names by their path
    std::vector<std::filesystem::path> paths;
    std::string text;
    bool is_open = false, wants_focus = false, refused = false;
  };

  [[nodiscard]] Step& step() { return steps_[shown_]; }
  [[nodiscard]] const Step& step() const { return steps_[shown_]; }
  void show(std::size_t index);
  void find_sources();
  void choose_source();
  void take_typed_path();
  void start();
  void take_next_step();
  void draw_heading(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_path_field(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_controls(const widgets::Ui& ui, const widgets::Rect& area);
  [[nodiscard]] std::string next_step() const;

  std::function<void()> go_on_;
  sources::DeviceTurns turns_;
  sources::BackgroundEnd ending_;  // what the stations have stopped
  std::filesystem::path case_folder_;
  bool is_read_ = false;  // the stations know the case
  Typed typed_;
  std::vector<Step> steps_;
  std::size_t shown_ = 0;
};

}  // namespace arthronaut::setup
