#include "app/widgets/list_rows.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <optional>

namespace arthronaut::widgets {
namespace {

class ListRows : public ::testing::Test {
 protected:
  // Every letter of ImGui's own font is as wide as the next.
  ListRows() : font_(fonts_.AddFontDefault()) { fonts_.Build(); }
  [[nodiscard]] float letters(int count) const {
    return (static_cast<float>(count) + 0.5F) * font_->CalcTextSizeA(font_->FontSize, 1e9F, 0, "0").x;
  }
  ImFontAtlas fonts_;
  ImFont* font_;
};

// Of a path the end tells which it is; no letter of several bytes is cut apart.
TEST_F(ListRows, APathIsCutAtItsBeginning) {
  EXPECT_EQ(fitting_end(font_, "/home/a/Knee 2", letters(20)), "/home/a/Knee 2");
  EXPECT_EQ(fitting_end(font_, "/home/a/Knee 2", letters(7)), "\u2026Knee 2");
  const std::string cut = fitting_end(font_, "M\u00FCller \u00E4\u00F6\u00FC", letters(3));
  EXPECT_EQ(cut, "\u2026\u00F6\u00FC");
  EXPECT_EQ(fitting_end(font_, "abc", 0), "\u2026");
}

// A list of twenty rows of 20 pixels, of which five are in sight; how far it is scrolled after some frames.
class ScrolledList {
 public:
  ScrolledList() {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {400, 400};
    io.IniFilename = nullptr;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  ~ScrolledList() { ImGui::DestroyContext(context_); }
  ScrolledList(const ScrolledList&) = delete;
  ScrolledList& operator=(const ScrolledList&) = delete;

  float scroll_after_drawing(std::size_t row, std::optional<float> hand = std::nullopt) {
    float scroll = 0;
    for (int frame = 0; frame < 3; ++frame) {
      ImGui::NewFrame();
      ImGui::SetNextWindowSize({200, 300});
      ImGui::Begin("window");
      ImGui::BeginChild("list", {100, 100});
      if (hand && frame == 0) ImGui::SetScrollY(*hand);
      for (std::size_t i = 0; i < 20; ++i) {
        const float top = ImGui::GetCursorScreenPos().y;
        ImGui::Dummy({50, 20});
        if (i == row) bring_into_sight(i, top, 20);
      }
      scroll = ImGui::GetScrollY();
      ImGui::EndChild();
      ImGui::End();
      ImGui::EndFrame();
    }
    return scroll;
  }

 private:
  ImGuiContext* context_ = ImGui::CreateContext();
};

// Another row comes into sight; one that is in sight leaves the list where it is, and so does a hand's.
TEST(ScrolledRows, TheListFollowsTheRowAndOtherwiseTheHand) {
  ScrolledList list;
  EXPECT_EQ(list.scroll_after_drawing(0), 0);
  const float at_ten = list.scroll_after_drawing(10);
  EXPECT_GT(at_ten, 100);
  EXPECT_LT(at_ten, 300);
  EXPECT_EQ(list.scroll_after_drawing(9), at_ten) << "in sight already";
  EXPECT_EQ(list.scroll_after_drawing(9, 0.F), 0) << "as the hand left it";
  EXPECT_EQ(list.scroll_after_drawing(9), 0);
}

}  // namespace
}  // namespace arthronaut::widgets
