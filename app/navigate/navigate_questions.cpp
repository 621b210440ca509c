// What the theatre screen asks, and what it tells the tests.
#include "app/navigate/navigate_view.h"

namespace arthronaut::navigate {

void NavigateView::draw_questions(const widgets::Ui& ui, const widgets::Rect& video) {
  const operation::OperationState& state = *live_->operation;
  if (const LeftBehind* const left = left_behind()) {
    // With the tunnel that was guided to: resuming it is to choose it.
    const auto& was = left->found.operation.plan;
    const auto plan = was ? bones_.planned(was->tunnel.key()) : bones_.plan_of(choices_.bone);
    draw_card(ui, video, resume_card(*left, plan, std::chrono::system_clock::now()));
  } else if (state.has_source && !is_of_source_before(*live_) && state.time_out == operation::TimeOut::Due &&
             !cameras_.is_open())
    draw_card(ui, video, time_out_card(state, patient_));
  if (const auto pictures = cameras_.draw(ui, video)) start_live(*pictures);
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
  const auto& guiding = live_->operation->plan;
  ui.log.note_state("tunnel", guiding ? tunnels::name_of(guiding->tunnel.key()) : "none");
  ui.log.note_state("drilled", std::to_string(choices_.drilled.size()));
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
  ui.log.note_state("cameras", !cameras_.is_open() ? "none"
                               : cameras_.chosen() ? cameras_.chosen()->name
                                                   : "address");
  ui.log.note_state("depth_stop", state.depth_stop_mm ? widgets::fixed(*state.depth_stop_mm, 1) : "none");
  ui.log.note_state("picture", !screen.display.has_picture ? "none"
                               : screen.display.is_live    ? "live"
                                                           : "old");
}

}  // namespace arthronaut::navigate
