// Step 4 of the operation: the probe's tip by pivoting, a guide's axis by turning; into the case's
// tools.json.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "app/setup/setup_panels.h"
#include "app/setup/tool_display.h"
#include "navigation/sources/background_end.h"

namespace arthronaut::setup {

class ToolStation : public JobStation<ToolJob> {
 public:
  // wake: ends the window's wait for input; called from other threads. ending: takes what is stopped.
  ToolStation(std::function<void()> wake, sources::BackgroundEnd& ending)
      : wake_(std::move(wake)), ending_(ending) {}

  void open(const std::filesystem::path& case_folder) override;
  void show() override;
  void start(const FeedSource& source) override;
  void stop() override;
  void release_source() override;
  void add_actions(widgets::Actions& actions) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] std::vector<const char*> buttons() const override;
  [[nodiscard]] Then take_next_step() override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] std::string next_step() const override { return display_.next_text; }
  [[nodiscard]] Row adopted() const override { return adopted_; }

 private:
  void read_adopted();
  void adopt();
  [[nodiscard]] bool is_of_camera_before() const;
  void take_built_in();
  [[nodiscard]] ToolChoice choice() const;
  // The next one that nobody measured, of those that the source that runs can show.
  [[nodiscard]] std::optional<std::size_t> next_unmeasured() const;
  void draw_picture_with_markers(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_motion(const widgets::Ui& ui, const widgets::Rect& area);

  std::filesystem::path case_folder_;
  std::function<void()> wake_;
  sources::BackgroundEnd& ending_;
  std::vector<ToolChoice> choices_;
  std::vector<bool> is_measured_;  // of each choice
  bool has_file_ = false;          // the case's tools.json
  std::size_t chosen_ = 0;
  double refractive_index_;
  ToolDisplay display_;  // of this frame
  std::shared_ptr<const ToolResult> adopted_result_;
  std::optional<double> usable_since_s_;  // a result that may be adopted stands on the screen
  Row adopted_;
  provenance::Origin found_origin_ = provenance::Origin::Measured;  // of what this run finds
  std::string kept_because_;                                        // see open_case::tools_are_kept()
  // Of the camera.json that this run measures through: through another one its result is another.
  std::string camera_sha256_;
  widgets::VideoTexture picture_;
};

}  // namespace arthronaut::setup
