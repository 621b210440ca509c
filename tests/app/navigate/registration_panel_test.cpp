// What the registration's panel says first, and what it leaves out.
#include <gtest/gtest.h>

#include "app/navigate/navigate_panels.h"
#include "tests/app/navigate/shown_operation.h"

namespace arthronaut::navigate {
namespace {

// What the panel tells tests of itself, in a window of 1280 x 720.
std::string drawn(const Shown& shown, const widgets::Rect& area,
                  const std::string& missing = "touch the bone with the probe",
                  const std::string& where_next = "") {
  ImGui::CreateContext();
  const float scale = widgets::scale_for(1280, 720);
  const widgets::Theme theme =
      widgets::build_theme(*ImGui::GetIO().Fonts, scale, widgets::afar_px({1280, 720, 0}, scale));
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().DisplaySize = {1280, 720};
  ImGui::NewFrame();
  ImGui::Begin("panel");
  widgets::Actions actions;
  widgets::WidgetLog log(true);
  const widgets::Ui ui{theme, actions, log, 0};
  const theatre::LiveState live = shown.whole();
  const NavigateDisplay display = display_of(&live, kNow_s);
  RegistrationWords words;
  words.state = {widgets::Severity::Good, "Confirmed", where_next};
  words.missing = missing;
  testing::internal::CaptureStdout();
  draw_registration(ui, area, {.live = &live, .display = display, .words = words});
  log.end_frame();
  std::string told = testing::internal::GetCapturedStdout();
  ImGui::End();
  ImGui::EndFrame();
  ImGui::DestroyContext();
  return told;
}

// However little room there is: why no picture comes stands there, nothing green beside it, and no order that
// needs pictures.
TEST(RegistrationPanel, Hazard3WhyNoPictureComesIsNeverLeftOut) {
  Shown shown;
  shown.live.captured_s = kNow_s - 20;
  shown.live.trouble = theatre::SourceTrouble::NoPicture;
  shown.live.trouble_words =
      "No picture comes: rtsp://tower.theatre3.hospital/scope sends 1280 x 720 now, and the camera is "
      "calibrated "
      "for 1920 x 1080; set it back, or calibrate it in Set up";
  for (const float height : {400.F, 160.F, 90.F}) {
    SCOPED_TRACE(height);
    const std::string told = drawn(shown, {0, 0, 330, height});
    EXPECT_NE(told.find("set it back, or calibrate it in Set up"), std::string::npos) << told;
    EXPECT_EQ(told.find("Confirmed"), std::string::npos) << told;
    EXPECT_EQ(told.find("touch the bone"), std::string::npos) << told;
  }
  shown.live = Shown().live;
  const std::string told = drawn(shown, {0, 0, 330, 400});
  EXPECT_NE(told.find("Confirmed"), std::string::npos) << told;
  EXPECT_NE(told.find("touch the bone"), std::string::npos) << told;
}

// Of several things that are missing the first ones stand in large letters where there is no room for all.
TEST(RegistrationPanel, WhatIsMissingIsReadFromAfarAsFarAsItFits) {
  const std::string first = "draw 90 mm more", rest = "; draw across the line that was drawn";
  const Shown shown;
  bool was_first_alone = false;
  for (float height = 90; height < 400; height += 10) {
    SCOPED_TRACE(height);
    const std::string told = drawn(shown, {0, 0, 330, height}, first + rest);
    EXPECT_NE(told.find("STATE advice " + first), std::string::npos) << told;
    was_first_alone |= told.find(rest) == std::string::npos;
  }
  EXPECT_TRUE(was_first_alone);
  EXPECT_NE(drawn(shown, {0, 0, 330, 400}, first + rest).find(rest), std::string::npos);
}

// Where to draw next is what helps: it stands there however little room there is, and before what is missing.
TEST(RegistrationPanel, WhereToDrawNextComesBeforeWhatIsMissing) {
  const std::string next = "Draw next nearer to the foot.", missing = "draw 90 mm more";
  const Shown shown;
  for (float height = 90; height < 400; height += 10) {
    SCOPED_TRACE(height);
    EXPECT_NE(drawn(shown, {0, 0, 330, height}, missing, next).find("STATE advice " + next),
              std::string::npos);
  }
  EXPECT_NE(drawn(shown, {0, 0, 330, 400}, missing, next).find("STATE advice " + next + " " + missing),
            std::string::npos);
}

}  // namespace
}  // namespace arthronaut::navigate
