#include "app/navigate/theatre_layout.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "app/navigate/finish_words.h"
#include "app/navigate/live_words.h"
#include "app/navigate/operation_rail.h"
#include "app/widgets/afar_text.h"

namespace arthronaut::navigate {
namespace {

using widgets::Rect;

struct Shape {
  const char* name;
  int width, height;
  double diagonal_mm = 0;  // 0: as a 27-inch one
};
constexpr std::array<Shape, 12> kShapes{Shape{"16:9", 1920, 1080},
                                        {"16:9 of 24 inches", 1920, 1080, 610},
                                        {"16:9 small", 1280, 720},
                                        {"16:10", 1920, 1200},
                                        {"4:3", 1600, 1200},
                                        {"5:4 of 19 inches", 1280, 1024, 483},
                                        {"4:3 of 15 inches", 1024, 768, 381},
                                        {"4K", 3840, 2160},
                                        {"4K of 55 inches", 3840, 2160, 1397},
                                        {"two of 16:9", 3840, 1080},
                                        {"two of 4:3", 3200, 1200},
                                        {"two of 4K", 7680, 2160}};

// The theme as a window of this shape has it.
struct Screen {
  explicit Screen(const Shape& shape) {
    ImGui::CreateContext();
    const widgets::Screen screen{shape.width, shape.height, shape.diagonal_mm};
    const float scale = widgets::scale_for(shape.width, shape.height);
    theme = widgets::build_theme(*ImGui::GetIO().Fonts, scale, widgets::afar_px(screen, scale));
    const float margin = 12 * scale;
    area = Rect{0, 0, static_cast<float>(shape.width), static_cast<float>(shape.height)}.inset(margin);
  }
  ~Screen() { ImGui::DestroyContext(); }
  [[nodiscard]] TheatreLayout layout(bool guides, bool is_whole = true) const {
    return theatre_layout(
        area, {theme.scale, theme.afar->FontSize, theme.number->FontSize, guides, true, is_whole, !is_whole});
  }
  widgets::Theme theme;
  Rect area;
};

bool overlap(const Rect& a, const Rect& b) {
  constexpr float kRounding_px = 0.5F;
  return a.width > 0 && b.width > 0 && a.height > 0 && b.height > 0 && a.x + a.width > b.x + kRounding_px &&
         b.x + b.width > a.x + kRounding_px && a.y + a.height > b.y + kRounding_px &&
         b.y + b.height > a.y + kRounding_px;
}

// Everything that can be asked of the surgeon.
std::vector<std::string> all_words() {
  std::vector<std::string> words{
      "choose the tunnel femur AM (1); V: PL (2)",
      "press when the tunnel femur PL is drilled",
      "then the tunnel femur PL (2), or take the world marker out",
      "resume the operation that was left",
      "the pictures look like saline: end them, and take saline next",
      "start the simulated operation",
      "take the guide (simulation)",
      "the pictures have ended: start the simulated operation",
      words_of(operation::NextAction::VerifyByTouch) + ", 3 to go",
      words_of(operation::NextAction::VerifyByTouch) + ", 3 to go. Wait: the probe moves",
      words_without_pictures(theatre::SourceTrouble::NoPicture, operation::NextAction::VerifyByTouch,
                             Eigen::Vector2i(1280, 720)),
      "no picture comes; take the femur's marker out, then press: your word alone",
      "calibrate camera and tools in Set up",
      "wait: the case's last operation is looked for"};
  for (const auto way_out : {operation::WayOut::StrokesAnew, operation::WayOut::MarkerPlacedAnew})
    words.push_back(place_anew_words(way_out));
  operation::OperationState state;
  for (const auto due :
       {operation::ControlPointDue::CheckBeforeDrilling, operation::ControlPointDue::CheckAfterLoss,
        operation::ControlPointDue::CheckLooks, operation::ControlPointDue::CannotCheckLooks,
        operation::ControlPointDue::CannotCheckLoss}) {
    state.control_point_due = due;
    words.push_back(words_of_checking(state));
    words.push_back(words_of_verifying(state));
  }
  operation::RegistrationState denied;
  denied.in_force.standing = operation::Standing::Stands;
  state.registration = std::make_shared<const operation::RegistrationState>(denied);
  words.push_back(words_of_registering_anew(state));
  for (int i = 0; i <= static_cast<int>(operation::NextAction::Finish); ++i)
    words.push_back(words_of(static_cast<operation::NextAction>(i)));
  for (int i = 0; i <= static_cast<int>(Repeat::NothingNow); ++i)
    words.push_back(words_of(static_cast<Repeat>(i), operation::Step::Calibrate));
  const FinishedBone unverified{
      bones::BoneKind::Femur, {{bones::BoneKind::Femur, true, operation::AchievedTunnel(), false}}, true};
  for (int i = 0; i <= static_cast<int>(FinishAction::Nothing); ++i)
    for (const std::vector<FinishedBone>& finished : {std::vector<FinishedBone>(), {unverified}})
      words.push_back(words_of(static_cast<FinishAction>(i), finished, bones::BoneKind::Femur));
  return words;
}

TEST(TheatreLayout, NothingOverlapsOrLeavesTheWindow) {
  for (const Shape& shape : kShapes)
    for (const bool guides : {false, true})
      for (const bool is_whole : {false, true}) {
        SCOPED_TRACE(std::string(shape.name) + (guides ? ", guides" : ", registers"));
        const Screen screen(shape);
        const TheatreLayout l = screen.layout(guides, is_whole);
        const std::array parts{l.video,  l.header, l.rail,   l.words,  l.main,
                               l.target, l.scene,  l.states, l.buttons};
        for (std::size_t i = 0; i < parts.size(); ++i) {
          if (parts[i].width <= 0) continue;
          EXPECT_GE(parts[i].x, screen.area.x - 0.5F) << i;
          EXPECT_GE(parts[i].y, screen.area.y - 0.5F) << i;
          EXPECT_LE(parts[i].x + parts[i].width, screen.area.x + screen.area.width + 0.5F) << i;
          EXPECT_LE(parts[i].y + parts[i].height, screen.area.y + screen.area.height + 0.5F) << i;
          for (std::size_t k = i + 1; k < parts.size(); ++k)
            EXPECT_FALSE(overlap(parts[i], parts[k])) << i << " and " << k;
        }
        EXPECT_FALSE(overlap(l.block, l.video)) << "what asks or warns never lies over the picture";
      }
}

// The picture is what the surgeon works by: on a wide screen it is as high as the screen, nowhere less than
// nine tenths of the largest square beside a column that can be read.
TEST(TheatreLayout, ThePictureIsAsLargeAsItCanBe) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const Screen screen(shape);
    const Rect video = screen.layout(true).video;
    EXPECT_FLOAT_EQ(video.width, video.height);
    const float column = kColumnLetters * 0.53F * screen.theme.afar->FontSize;
    EXPECT_GE(video.width, 0.9F * std::min(screen.area.height, screen.area.width - column));
    const bool is_wide = std::string(shape.name) == "16:9";
    EXPECT_GT(video.width, is_wide ? 0.95F * screen.area.height : 0);
  }
}

// The side, the patient's name and what is to be said now, none over another.
TEST(TheatreLayout, TheHeaderHasRoomForItsThreeLines) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const Screen screen(shape);
    const widgets::Theme& theme = screen.theme;
    EXPECT_GE(screen.layout(true).header.height,
              theme.title->FontSize + theme.strong->FontSize + theme.body->FontSize);
  }
}

TEST(TheatreLayout, AcrossTwoScreensNothingLiesOnTheSeam) {
  for (const Shape& shape : kShapes) {
    if (std::string(shape.name).rfind("two", 0) != 0) continue;
    for (const bool guides : {false, true}) {
      SCOPED_TRACE(std::string(shape.name) + (guides ? ", guides" : ", registers"));
      const Screen screen(shape);
      const TheatreLayout l = screen.layout(guides);
      const float seam = static_cast<float>(shape.width) / 2;
      EXPECT_LT(l.video.x + l.video.width, seam);
      EXPECT_NEAR(l.video.x + l.video.width / 2, seam / 2, 12 * screen.theme.scale)
          << "in the middle of its screen";
      for (const Rect& part : {l.header, l.rail, l.words, l.block, l.main, l.scene, l.states})
        EXPECT_GT(part.x, seam);
    }
  }
}

// A second screen has room: what is aimed by, or where the bone is touched, is as high as the screen, or as
// wide as the column leaves it that is read beside it; what is read stays where it is.
TEST(TheatreLayout, AcrossTwoScreensTheTargetIsAsLargeAsTheColumnLeavesIt) {
  for (const Shape& shape : kShapes) {
    if (!std::string(shape.name).starts_with("two")) continue;
    SCOPED_TRACE(shape.name);
    const Screen screen(shape);
    const TheatreLayout guides = screen.layout(true), registers = screen.layout(false);
    const float column = kColumnLetters * 0.53F * screen.theme.afar->FontSize;
    EXPECT_FLOAT_EQ(guides.target.width, guides.target.height);
    EXPECT_TRUE(guides.target.height > 0.97F * screen.area.height || guides.words.width < 1.01F * column);
    EXPECT_FLOAT_EQ(guides.words.x, registers.words.x);
    EXPECT_FLOAT_EQ(guides.words.y, registers.words.y);
    EXPECT_GE(guides.words.width, column - 1);
    EXPECT_FLOAT_EQ(registers.scene.width, guides.target.width);
    EXPECT_GT(guides.scene.width, 0.3F * guides.words.width);
    EXPECT_GT(guides.scene.height, 4 * screen.theme.afar->FontSize);
  }
}

// A bullseye that shows nothing gives its room to the bone.
TEST(TheatreLayout, WhereNothingIsAimedByTheBoneStandsInItsPlace) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const Screen screen(shape);
    TheatreLayoutOptions options{screen.theme.scale, screen.theme.afar->FontSize,
                                 screen.theme.number->FontSize};
    const TheatreLayout aims = theatre_layout(screen.area, options);
    options.has_target = false;
    const TheatreLayout does_not = theatre_layout(screen.area, options);
    if (!aims.scene_is_in_block && !std::string(shape.name).starts_with("two")) continue;
    EXPECT_EQ(does_not.target.width, 0);
    EXPECT_GE(does_not.scene.height, aims.target.height);
    EXPECT_GE(does_not.scene.width, aims.target.width);
  }
}

// Where the numbers stand beside it on one screen: three fifths of the room's height at the least, both ways,
// or as wide as they leave it.
TEST(TheatreLayout, BesideTheNumbersTheTargetIsAsLargeAsTheyAllow) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const Screen screen(shape);
    const TheatreLayout l = screen.layout(true);
    const bool stands_under_it = l.main.y > l.target.y;
    if (stands_under_it || std::string(shape.name).starts_with("two")) continue;
    const bool is_as_wide_as_it_can_be = l.main.width < 7.5F * screen.theme.afar->FontSize;
    EXPECT_TRUE(std::min(l.target.width, l.target.height) > 0.6F * l.block.height || is_as_wide_as_it_can_be);
  }
}

// The 3D view under the target shows a bone, and not a stripe of one.
TEST(TheatreLayout, UnderTheTargetTheSceneHasAThirdOfTheRoom) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const TheatreLayout l = Screen(shape).layout(true);
    if (!l.scene_is_in_block || std::string(shape.name).starts_with("two")) continue;
    EXPECT_GT(l.scene.height, 0.32F * l.block.height);
  }
}

// Every instruction stands in letters for afar, whole, on every screen; so do the numbers.
TEST(TheatreLayout, WhatGuidesIsReadFromAfar) {
  for (const Shape& shape : kShapes) {
    SCOPED_TRACE(shape.name);
    const Screen screen(shape);
    const widgets::Theme& theme = screen.theme;
    const TheatreLayout l = screen.layout(true);
    // As draw_words() leaves it.
    const float width = l.words.width - theme.px(20), height = l.words.height - theme.title->FontSize;
    for (const std::string& words : all_words())
      EXPECT_EQ(widgets::font_that_fits(theme, width, height, words), theme.afar) << words;
    // Offset with two directions, angle, what remains for a drill: three numbers and two lines.
    const float number = theme.afar->FontSize + theme.number->FontSize;
    EXPECT_GE(l.main.height, 3 * number + 2 * theme.afar->FontSize + theme.px(32));
    for (const char* word : {"12.3 posterior", "Remaining", "Stop: exit", "Exit near", "Registration"}) {
      const ImVec2 size = theme.afar->CalcTextSizeA(theme.afar->FontSize, 1e9F, 0, word);
      EXPECT_LE(size.x, l.main.width - theme.px(28)) << word;
    }
  }
}

}  // namespace
}  // namespace arthronaut::navigate
