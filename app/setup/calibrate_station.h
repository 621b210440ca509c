// Step 2 of the operation: pictures of a checkerboard, the lens turned in between, become the case's
// camera.json.
#pragma once

#include <functional>
#include <memory>

#include "app/setup/calibrate_display.h"
#include "app/setup/setup_panels.h"
#include "navigation/sources/background_end.h"

namespace arthronaut::setup {

class CalibrateStation : public JobStation<CalibrateJob> {
 public:
  // wake: ends the window's wait for input; called from other threads. ending: takes what is stopped.
  CalibrateStation(std::function<void()> wake, sources::BackgroundEnd& ending)
      : wake_(std::move(wake)), ending_(ending) {}

  void open(const std::filesystem::path& case_folder) override;
  void start(const FeedSource& source) override;
  void stop() override;
  void release_source() override;
  void add_actions(widgets::Actions& actions) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  [[nodiscard]] std::vector<const char*> buttons() const override;
  [[nodiscard]] Then take_next_step() override;
  [[nodiscard]] bool is_busy() const override;
  [[nodiscard]] bool awaits_text() const override { return form_.wants_focus; }
  [[nodiscard]] std::string next_step() const override { return display_.next_text; }
  [[nodiscard]] Row adopted() const override { return adopted_; }

 private:
  void read_adopted();
  void set_square(double square_mm);
  void calibrate();
  void adopt();
  void draw_pictures(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_result(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_form(const widgets::Ui& ui, const widgets::Rect& area);

  // What camera.json says beside the numbers, and the board.
  struct Form {
    double square_mm = 1.5;
    std::string scope_name, head_name;
    bool wants_focus = false;
  };

  std::filesystem::path case_folder_;
  std::function<void()> wake_;
  sources::BackgroundEnd& ending_;
  Form form_;
  bool takes_by_itself_ = true;
  CalibrateDisplay display_;  // of this frame
  std::shared_ptr<const calibration::CalibrationSummary> adopted_result_;
  std::shared_ptr<const calibration::CalibrationSummary> seen_result_;  // since then on the screen:
  double seen_since_s_ = 0;
  Row adopted_;
  std::string kept_because_;  // see open_case::camera_is_kept()
  widgets::VideoTexture picture_, residuals_;
};

}  // namespace arthronaut::setup
