// What the theatre screen asks, and what it tells the tests.
#include "app/navigate/navigate_view.h"

namespace arthronaut::navigate {

void NavigateView::draw_questions(const widgets::Ui& ui, const widgets::Rect& video) {
  const operation::OperationState& state = *live_->operation;
  if (const LeftBehind* const left = left_behind())
    draw_card(ui, video, resume_card(*left, bones_.plan_of(choices_.bone), std::chrono::system_clock::now()));
  else if (state.has_source && !is_of_source_before(*live_) && state.time_out == operation::TimeOut::Due &&
           choices_.cameras.empty())
    draw_card(ui, video, time_out_card(state, patient_));
  if (!choices_.cameras.empty()) draw_cameras(ui, video);
  if (const auto depth_mm = depth_.draw(ui, video)) ask(operation::ReadDepthStop{*depth_mm});
}

void NavigateView::note_states(const widgets::Ui& ui, const NavigateScreen& screen) {
  const operation::Standing standing = registration().in_force.standing;
  ui.log.note_state("guidance", screen.display.guidance_is_valid ? "valid" : screen.display.headline);
  ui.log.note_state("detail", screen.display.detail);
  ui.log.note_state("overlay", screen.overlay_opacity > 0.99F ? "full"
                               : screen.overlay_opacity > 0   ? "faded"
                                                              : "off");
  ui.log.note_state("view", choices_.undistorts ? "undistorted" : "as it came");
  ui.log.note_state("next", screen.next_step);
  ui.log.note_state("calibration", screen.has_source() ? screen.live->operation->source->calibration : "");
  ui.log.note_state("notice", notice_);
  ui.log.note_state("layout", screen.layout == NavigateLayout::Register ? "register" : "guide");
  ui.log.note_state("registration", standing == operation::Standing::None     ? "none"
                                    : standing == operation::Standing::Stands ? "reliable"
                                                                              : "unreliable");
  ui.log.note_state("standing", to_text(standing));
  ui.log.note_state("step", to_text(live_->operation->step));
  ui.log.note_state("plan", live_->operation->plan_was_edited ? "edited" : "in force");
  ui.log.note_state("registrations", std::to_string(registration().history->size()));
  ui.log.note_state("strokes", std::to_string(words_.strokes.size()));
  ui.log.note_state("recording", live_->keeps_video ? "on" : "off");
  ui.log.note_state("journal", live_->record_trouble.empty() ? live_->session_folder.filename().string()
                                                             : live_->record_trouble);
  const operation::OperationState& state = *live_->operation;
  ui.log.note_state("resume", resume_.is_looking()       ? "looking"
                              : left_behind() != nullptr ? left_behind()->found.operation.session
                                                         : "none");
  ui.log.note_state("resumed", state.resumed != nullptr ? state.resumed->session : "none");
  ui.log.note_state("touches", std::to_string(registration().touches.count()));
  ui.log.note_state("time_out", state.time_out == operation::TimeOut::Due         ? "due"
                                : state.time_out == operation::TimeOut::Confirmed ? "confirmed"
                                                                                  : "not asked");
  ui.log.note_state("depth_stop", state.depth_stop_mm ? widgets::fixed(*state.depth_stop_mm, 1) : "none");
  ui.log.note_state("picture", !screen.display.has_picture ? "none"
                               : screen.display.is_live    ? "live"
                                                           : "old");
}

void NavigateView::draw_cameras(const widgets::Ui& ui, const widgets::Rect& area) const {
  const float row = ui.theme.px(56);
  widgets::Rect box = widgets::Rect{area.x, area.center().y, area.width, 0}.inset(0);
  box.height = row * (static_cast<float>(choices_.cameras.size()) + 1.5F);
  box.y = area.center().y - box.height / 2;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(box.min(), box.max(), IM_COL32(10, 12, 15, 240));
  widgets::text_centered(ui, box.cut_top(row), ui.theme.title, widgets::kText, "Which camera?");
  for (std::size_t i = 0; i < choices_.cameras.size(); ++i) {
    const widgets::Rect line = box.cut_top(row);
    const bool is_selected = i == choices_.camera;
    if (is_selected) draw.AddRectFilled(line.min(), line.max(), IM_COL32(28, 74, 104, 255));
    widgets::text_centered(
        ui, line, ui.theme.strong, is_selected ? widgets::kText : widgets::kQuietText,
        choices_.cameras[i].name + "  (/dev/video" + std::to_string(choices_.cameras[i].index) + ")");
  }
  widgets::text_centered(ui, box, ui.theme.body, widgets::kQuietText,
                         "K: the next one    Space: open it    Esc: none");
}

}  // namespace arthronaut::navigate
