// Which knee it is, asked of the one who plans: where what the bones were made from speaks against the side
// of the case, or where somebody sees that it is wrong.
#include <GLFW/glfw3.h>

#include <cctype>

#include "app/plan/plan_view.h"
#include "app/widgets/wrapped_text.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan {

namespace {

using bones::Side;

std::string knee_word(Side side) { return std::string(bones::to_text(side)) + " knee"; }

}  // namespace

std::string side_question(Side of_case, const std::string& doubt) {
  const Side other = of_case == Side::Left ? Side::Right : Side::Left;
  return (doubt.empty() ? "" : "Look: " + doubt + ". ") + "As a " + knee_word(other) +
         " its landmarks and its plan are others: what there is now is put aside, and is back when you say " +
         std::string(bones::to_text(of_case)) + " again.";
}

void PlanView::say_side(Side side) {
  state_.asks_side = false;
  if (const std::string unsaved = history_.save_now(); !unsaved.empty()) {
    state_.hint = {"The side stays as it is while the plan is not saved: " + unsaved};
    return;
  }
  try {  // a case on the disk
    side_news_.clear();
    side_news_of_ = case_folder_;
    for (const std::string& line : say_side_(side)) side_news_ += (side_news_.empty() ? "" : "; ") + line;
  } catch (const std::runtime_error& error) {
    state_.hint = {error.what()};
    return;
  }
  // Of another side the case is opened anew, and that takes the news.
  load_bone_doubts();
  if (model_->knee().side == side) take_side_news();
}

void PlanView::take_side_news() {
  if (side_news_of_ != case_folder_) side_news_.clear();  // of a case that did not open again
  if (side_news_.empty()) return;
  side_news_[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(side_news_[0])));
  state_.hint = {side_news_ + ".", true, model_->revision()};
  side_news_.clear();
}

void PlanView::add_side_actions(widgets::Actions& actions) {
  actions.add({"plan.side", "Which knee...",
               "Says whether the case is a left or a right knee: it was imported as the wrong one, or "
               "something speaks against its side and you have looked",
               GLFW_KEY_J, 0, false,
               [this] { return model_ != nullptr && !history_.is_read_only() && !defaults_.is_running(); },
               [this] { return state_.asks_side; },
               [this] {
                 state_.asks_side = !state_.asks_side;
                 state_.placing = Placing::Nothing;
                 state_.hint = {};
               }});
  struct Answer {
    const char *id, *label;
    int key;
    Side side;
  };
  const auto asks = [this] { return model_ != nullptr && state_.asks_side; };
  for (const Answer& answer : {Answer{"plan.left_knee", "Left knee", GLFW_KEY_8, Side::Left},
                               Answer{"plan.right_knee", "Right knee", GLFW_KEY_9, Side::Right}})
    actions.add({answer.id, answer.label, "It is a " + knee_word(answer.side), answer.key, 0, false, asks,
                 [this, side = answer.side] { return model_->knee().side == side; },
                 [this, side = answer.side] { say_side(side); }});
}

void PlanView::draw_side(const widgets::Ui& ui, const widgets::Rect& area) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  draw.AddRect(area.min(), area.max(), widgets::kCaution, ui.theme.px(6), 0, ui.theme.px(2));
  const float height = ui.theme.px(44), width = ui.theme.px(180), left = area.x + ui.theme.px(16),
              room = area.width - 2 * width - ui.theme.px(52), top = area.y + ui.theme.px(8),
              font = ui.theme.strong->FontSize, middle = area.y + area.height / 2;
  const Side side = model_->knee().side;
  const std::string head = "The case is a " + knee_word(side) + ". Is it?";
  const std::string words = side_question(side, plan_review::side_doubt(bone_doubts_));
  draw.PushClipRect(area.min(), area.max(), true);
  draw.AddText(ui.theme.strong, font, {left, top}, widgets::kText, head.c_str());
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {left, top + font}, widgets::kText,
               widgets::wrapped(ui.theme.body, words, room).c_str());
  draw.PopClipRect();
  ImGui::SetCursorScreenPos({area.x + area.width - 2 * width - ui.theme.px(20), middle - height / 2});
  widgets::action_button(ui, "plan.left_knee", width, height);
  ImGui::SetCursorScreenPos({area.x + area.width - width - ui.theme.px(10), middle - height / 2});
  widgets::action_button(ui, "plan.right_knee", width, height);
}

}  // namespace arthronaut::plan
