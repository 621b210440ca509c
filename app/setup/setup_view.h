// Setting-up mode: the camera is calibrated, the tools are calibrated, the fluid is checked. Made to be
// worked by Space alone, as the theatre is: it does the next sensible step.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/mode/mode.h"
#include "app/previews/source_previews.h"
#include "app/setup/setup_sources.h"
#include "app/setup/source_choice.h"
#include "app/setup/station.h"
#include "navigation/sources/background_end.h"

namespace arthronaut::setup {

class SetupView : public mode::Mode {
 public:
  // wake: ends the window's wait for input; called from other threads.
  // go_on: called when the last part of setting up is done and the next step is wished.
  // turns: shared with whatever else opens cameras.
  // streams: the addresses of streams that were used in this room, and where a new one is noted.
  struct Streams {
    std::function<std::vector<std::string>()> known = [] { return std::vector<std::string>(); };
    std::function<void(const std::string& address)> note = [](const std::string&) {};
  };
  SetupView(const std::function<void()>& wake, std::function<void()> go_on, const sources::DeviceTurns& turns,
            Streams streams);
  ~SetupView() override;

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] bool works_read_only() const override { return false; }  // what it finds goes into the case
  // Nothing of the case is read before enter().
  void case_opened(const mode::OpenCase& opened) override;
  void enter() override;  // sees anew what sources there are; the case's own files when it was opened
  void leave() override;  // cameras and files are let go, what was taken stays
  void add_actions(widgets::Actions& actions) override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] bool awaits_text() const override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] bool has_running_work() const override;
  [[nodiscard]] std::optional<sources::SourceKind> source_kind() const override;
  [[nodiscard]] bool pictures_are_of_now() const override { return step().station->is_of_now(); }

 private:
  struct Step {
    Purpose purpose;
    const char* action;  // that shows it
    const char* prefix;  // of its own actions
    std::unique_ptr<Station> station;
    SourceChoice source = {};
    sources::SourceKind started_kind = sources::SourceKind::Recording;  // of what runs
    std::string unproved_stream = {};  // address of what runs, until a picture came from it
  };

  struct Typed {  // sources that the user names by their path or address
    std::vector<std::filesystem::path> paths;
    std::string text;
    bool is_open = false, wants_focus = false;
  };

  [[nodiscard]] Step& step() { return steps_[shown_]; }
  [[nodiscard]] const Step& step() const { return steps_[shown_]; }
  void show(std::size_t index);
  void find_sources();
  void choose_source();
  void take_typed_path();
  void start();
  void note_stream();
  void take_next_step();
  void draw_heading(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_path_field(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_controls(const widgets::Ui& ui, const widgets::Rect& area);
  // All that is on offer, with what each shows: setup_gallery.cpp.
  void show_gallery();
  void close_gallery();
  void draw_gallery(const widgets::Ui& ui, const widgets::Rect& area);
  [[nodiscard]] std::string next_step() const;

  std::function<void()> go_on_;
  sources::DeviceTurns turns_;
  Streams streams_;
  sources::BackgroundEnd ending_;  // what the stations have stopped
  std::filesystem::path case_folder_;
  bool is_read_ = false;   // the stations know the case
  bool is_shown_ = false;  // this mode is at the front
  Typed typed_;
  bool shows_gallery_ = false;
  previews::SourcePreviews previews_;
  std::vector<Step> steps_;
  std::size_t shown_ = 0;
};

}  // namespace arthronaut::setup
