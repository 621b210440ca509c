// What the theatre screen asks, and what it tells the tests.
#include "app/navigate/navigate_view.h"
#include "app/navigate/plan_words.h"
#include "app/navigate/tracking_words.h"
#include "navigation/camera/medium.h"

namespace arthronaut::navigate {

namespace {

// "DDDDNo...": done, now, open, closed. For tests.
std::string rail_in_letters(const Rail& rail) {
  std::string letters;
  for (const RailStep& step : rail) letters += ".oND"[static_cast<std::size_t>(step.state)];
  return letters;
}

}  // namespace

std::string NavigateView::notice() const {
  const std::string of_record = record_notice(*live_, bones_.keeps_video());
  if (!of_record.empty()) return of_record;  // what was refused is less than what is not kept
  // Before there are pictures it stands in large letters beside the step, and once is enough.
  const bool is_read_there = live_->phase == theatre::LiveState::Phase::NoSource && !cameras_.is_open() &&
                             !choices_.shows_menu &&
                             layout(theatre::LiveOperation::now_s()) == NavigateLayout::Guide;
  return is_read_there ? "" : notice_;
}

Question NavigateView::question() {
  if (cameras_.is_open()) return Question::None;
  if (left_behind() != nullptr) return Question::Resume;
  const operation::OperationState& state = *live_->operation;
  const bool is_finished = finishes(finished_bones(), choices_.bone);
  if (state.has_source && !is_of_source_before(*live_) && state.time_out == operation::TimeOut::Due &&
      state.next_action == operation::NextAction::ConfirmTimeOut && !choices_.looked_at && !is_finished &&
      !waits_for_take_over(state))
    return Question::TimeOut;
  const bool looks_at_finish =
      choices_.looked_at.value_or(operation::Step::Finish) == operation::Step::Finish;
  return is_finished && looks_at_finish && !depth_.is_open() ? Question::Finish : Question::None;
}

// What would be in force after resuming, is, or will be when an operation begins.
std::optional<operation::PlannedTunnel> NavigateView::plan_in_question() {
  if (const LeftBehind* const left = left_behind()) return left->found.operation.plan;
  if (const auto& in_force = live_->operation->plan) return in_force;
  return bones_.plan_of(choices_.bone);
}

void NavigateView::judge_plans() {
  judged_.judge(*model_, plan_in_question());
  judged_edited_.judge(*model_, live_->operation->edited_plan);
}

std::string NavigateView::words_of_edited_plan() const {
  return waits_for_take_over(*live_->operation)
             ? words_of_edited(live_->operation->edited_plan, judged_edited_.verdict())
             : "";
}

std::string NavigateView::words_of_verdict() const {
  const plan_review::TunnelVerdict& verdict = judged_.verdict();
  return verdict.is_fine() ? ""
                           : (verdict.is_wrong() ? "the plan is wrong: " : "check the plan: ") +
                                 in_plain_words(verdict).in_short();
}

bool NavigateView::draw_questions(const widgets::Ui& ui, const TheatreLayout& layout) {
  const widgets::Rect& area = layout.block;
  switch (choices_.asked) {
    case Question::None:
      break;
    case Question::Resume: {
      // With the tunnel that was guided to: resuming it is to choose it.
      const LeftBehind& left = *left_behind();
      const auto& was = left.found.operation.plan;
      const auto plan = was ? bones_.planned(was->tunnel.key()) : bones_.plan_of(choices_.bone);
      draw_card(ui, area, resume_card(left, plan, judged_.verdict(), std::chrono::system_clock::now()));
      break;
    }
    case Question::TimeOut:
      // The states' line stays beside it: nobody confirms what a dead picture is of without seeing that it
      // is.
      draw_card(ui, area, time_out_card(*live_->operation, patient_, judged_.verdict()));
      break;
    case Question::Finish:
      draw_card(ui, area, {"navigate.finish", "Finish", finish_list(finished_bones()).lines, ""});
      break;
  }
  const bool asks = choices_.asked != Question::None || cameras_.is_open() || depth_.is_open();
  if (const auto pictures = cameras_.draw(ui, area)) start_live(*pictures);
  if (const auto depth_mm = depth_.draw(ui, area)) ask(operation::ReadDepthStop{*depth_mm});
  return asks;
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
  ui.log.note_state("missing", screen.missing);
  ui.log.note_state("medium",
                    screen.has_source()
                        ? camera::medium_to_text(screen.live->operation->source->pipeline.refractive_index)
                        : "");
  ui.log.note_state("calibration", screen.has_source() ? screen.live->operation->source->calibration : "");
  ui.log.note_state("notice", notice_);
  ui.log.note_state("layout", screen.layout == NavigateLayout::Register ? "register" : "guide");
  ui.log.note_state("registration", standing == operation::Standing::None     ? "none"
                                    : standing == operation::Standing::Stands ? "reliable"
                                                                              : "unreliable");
  ui.log.note_state("standing", to_text(standing));
  ui.log.note_state("step", to_text(step_of_now(screen.rail)));
  ui.log.note_state("back_at", screen.looked_at ? to_text(*screen.looked_at) : "");
  ui.log.note_state("bone", bones::to_text(choices_.bone));
  ui.log.note_state("rail", rail_in_letters(screen.rail));
  ui.log.note_state("pedal", screen.pedal_acts ? "acts" : "waits");
  ui.log.note_state("menu", choices_.shows_menu ? "open" : "closed");
  ui.log.note_state("markers_out", std::to_string(drilled_[shown_kind()].markers_out_count()));
  ui.log.note_state("finish", finish_list(finished_bones()).is_done ? "done" : "open");
  const auto& guiding = live_->operation->plan;
  ui.log.note_state("tunnel", guiding ? tunnels::name_of(guiding->tunnel.key()) : "none");
  ui.log.note_state("drilled", std::to_string(drilled_[shown_kind()].count()));
  ui.log.note_state("plan_verdict", std::string(to_text(judged_.verdict().worst())));
  ui.log.note_state("plan", live_->operation->plan_was_edited ? "edited" : "in force");
  ui.log.note_state("registrations", std::to_string(registration().history->size()));
  ui.log.note_state("strokes", std::to_string(words_.strokes.size()));
  ui.log.note_state("draws", live_->operation->draws ? "yes" : "no");
  ui.log.note_state("recording", live_->keeps_video ? "on" : "off");
  ui.log.note_state("pictures", std::string(recording::to_option(bones_.pictures_as())));
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
  ui.log.note_state("sharing", screen.sharing.empty() ? "none" : screen.sharing);
  ui.log.note_state("depth_field", depth_.is_open() ? "open" : "closed");
  ui.log.note_state("depth_stop", state.depth_stop_mm ? widgets::fixed(*state.depth_stop_mm, 1) : "none");
  ui.log.note_state("picture", !screen.display.has_picture ? "none"
                               : screen.display.is_live    ? "live"
                                                           : "old");
}

}  // namespace arthronaut::navigate
