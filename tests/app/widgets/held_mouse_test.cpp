// What counts of the mouse's way: in frames as slow as they may be.
#include "app/widgets/held_mouse.h"

#include <gtest/gtest.h>

namespace arthronaut::widgets {
namespace {

class HeldMouse : public ::testing::Test {
 protected:
  HeldMouse() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {400, 300};
    io.IniFilename = nullptr;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  ~HeldMouse() override { ImGui::DestroyContext(); }

  // One frame: the way that counts while the item is held, else none.
  static ImVec2 way_in_frame(float x, float y, bool is_down) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 0.5F;
    io.MousePos = {x, y};
    io.MouseDown[ImGuiMouseButton_Left] = is_down;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({400, 300});
    ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::SetCursorScreenPos({20, 20});
    ImGui::InvisibleButton("view", {300, 200});
    const ImVec2 way = ImGui::IsItemActive() ? held_mouse_way_px() : ImVec2(0, 0);
    ImGui::End();
    ImGui::EndFrame();
    return way;
  }
};

TEST_F(HeldMouse, TheWayBeforeThePressIsNoneOfIt) {
  (void)way_in_frame(50, 50, false);
  (void)way_in_frame(50, 50, false);
  const ImVec2 pressed = way_in_frame(250, 150, true);
  ASSERT_TRUE(ImGui::GetIO().MouseDown[0]);
  EXPECT_EQ(pressed.x, 0);
  EXPECT_EQ(pressed.y, 0);
  const ImVec2 dragged = way_in_frame(256, 147, true);
  EXPECT_EQ(dragged.x, 6);
  EXPECT_EQ(dragged.y, -3);
}

}  // namespace
}  // namespace arthronaut::widgets
