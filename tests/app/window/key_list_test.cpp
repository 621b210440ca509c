#include "app/window/key_list.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "app/widgets/theme.h"

namespace arthronaut::window {
namespace {

// What a key does is read whole: on a screen full of keys the letters become smaller, and no sentence is cut.
TEST(KeyList, ShowsEveryExplanationWhole) {
  ImGui::CreateContext();
  const widgets::Theme theme = widgets::build_theme(*ImGui::GetIO().Fonts, 1, 40);
  constexpr float kRoom_px = 720, kHeight_px = 1000;
  for (const std::size_t count : {1U, 2U, 50U, 75U, 100U}) {
    std::vector<std::string> explanations;
    for (std::size_t i = 0; i < count; ++i)
      explanations.push_back(i % 3 != 0
                                 ? "Step back: Goes back a step"
                                 : "Tunnel AM: The tunnel of the anteromedial bundle is drilled; "
                                   "while a source runs it is offered, and guides once it is taken over");
    const KeyListLayout layout = key_list_layout(theme.body, explanations, kRoom_px, kHeight_px);
    ASSERT_EQ(layout.words.size(), count);
    std::array<std::size_t, 2> lines{};
    for (std::size_t i = 0; i < count; ++i) {
      std::string joined = layout.words[i];
      std::ranges::replace(joined, '\n', ' ');
      EXPECT_EQ(joined, explanations[i]);
      const ImVec2 size = theme.body->CalcTextSizeA(layout.letters_px, 1e9F, 0, layout.words[i].c_str());
      EXPECT_LE(size.x, kRoom_px + 1);
      lines[i < layout.first_on_the_right ? 0 : 1] +=
          1 + static_cast<std::size_t>(std::ranges::count(layout.words[i], '\n'));
    }
    for (const std::size_t column : lines)
      EXPECT_LE(static_cast<float>(column) * layout.line_px, kHeight_px + 1) << count;
    EXPECT_GE(layout.line_px, layout.letters_px) << "no line runs into the next";
    EXPECT_LE(layout.letters_px, theme.body->FontSize);
    EXPECT_GE(layout.letters_px, 0.6F * theme.body->FontSize) << count;
  }
  ImGui::DestroyContext();
}

// What moves a tool in an exercise is no action: the list has it all the same.
TEST(KeyList, HasTheKeysThatAreHeldDown) {
  widgets::Actions actions;
  actions.add({"train.run.done", "Done", "Ends the exercise", GLFW_KEY_ENTER, 0, false, {}, {}, [] {}});
  actions.add({"navigate.touch", "Touch", "Elsewhere", GLFW_KEY_T, 0, false, {}, {}, [] {}});
  const std::vector<KeyRow> rows =
      key_rows(actions, {"train."}, {{"A D W S", "The tool left, right, up and down"}});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].use, KeyUse::Heading);
  EXPECT_EQ(rows[1].key, "A D W S");
  EXPECT_EQ(rows[2].words, "Done: Ends the exercise");
}

// One key means several things, each at its moment: the one that it means now is found first, and what cannot
// be done stands apart.
TEST(KeyList, ShowsWhatAKeyDoesNowBeforeWhatItCannot) {
  widgets::Actions actions;
  const auto add = [&](const char* id, const char* label, bool can_run) {
    actions.add({id, label, "Words", GLFW_KEY_ENTER, 0, false, [can_run] { return can_run; }, {}, [] {}});
  };
  add("start.save", "Keep it", false);
  add("start.accept", "Make the case", false);
  add("app.quit", "Quit", true);
  add("start.open", "Open", true);
  std::vector<std::string> words;
  for (const KeyRow& row : key_rows(actions, {"start.", "app."}, {})) words.push_back(row.words);
  EXPECT_EQ(words,
            (std::vector<std::string>{"On this screen, now", "Open: Words", "Everywhere", "Quit: Words",
                                      "Not possible now", "Keep it (Enter), Make the case (Enter)"}));
}

}  // namespace
}  // namespace arthronaut::window
