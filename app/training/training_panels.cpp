// The pages of training: exercises with their best scores and how they went over time, the strip under the
// theatre's screen, the score.
#include <algorithm>

#include "app/training/contact_words.h"
#include "app/training/training_view.h"
#include "navigation/training/exercise_step.h"
#include "planning/cases/case.h"
#include "planning/files/format.h"
#include "planning/files/local_time.h"

namespace arthronaut::training_mode {

namespace {

using files::format;
using training::Exercise;
using training::Level;
using training::Score;

constexpr Level kLevels[] = {Level::Easy, Level::Medium, Level::Hard};

void put(ImFont* font, float x, float y, ImU32 color, const std::string& words, float width = 0) {
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, {x, y}, color, words.c_str(), nullptr, width);
}

float height_of(ImFont* font, const std::string& words, float width) {
  return font->CalcTextSizeA(font->FontSize, 1e9F, width, words.c_str()).y;
}

widgets::Severity severity_of(const training::ScorePart& part) {
  if (part.points >= part.most_points) return widgets::Severity::Good;
  return part.points > 0 ? widgets::Severity::Caution : widgets::Severity::Bad;
}

// Points over the runs, oldest first: 0 to 100, a mark a run.
void draw_points(const widgets::Ui& ui, const widgets::Rect& plot, const std::vector<const Score*>& runs) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto y_of = [&](double points) {
    return plot.y + plot.height * static_cast<float>(1 - points / 100);
  };
  for (const double line : {0.0, 25.0, 50.0, 75.0, 100.0}) {
    draw.AddLine({plot.x, y_of(line)}, {plot.x + plot.width, y_of(line)}, widgets::kPanelEdge);
    put(ui.theme.body, plot.x - ui.theme.px(50), y_of(line) - ui.theme.body->FontSize / 2,
        widgets::kQuietText, format("%.0f", line));
  }
  const auto at = [&](std::size_t i) -> ImVec2 {
    const float share = runs.size() > 1 ? static_cast<float>(i) / static_cast<float>(runs.size() - 1) : 0.5F;
    return {plot.x + plot.width * (0.03F + 0.94F * share), y_of(runs[i]->points)};
  };
  for (std::size_t i = 1; i < runs.size(); ++i)
    draw.AddLine(at(i - 1), at(i), widgets::kQuietText, ui.theme.px(1.5F));
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const float radius = ui.theme.px(7);
    // By an earlier rule its points say nothing beside those of now: a ring.
    if (is_by_earlier_rule(*runs[i]))
      draw.AddCircle(at(i), radius, widgets::kQuietText, 0, ui.theme.px(2));
    else
      draw.AddCircleFilled(at(i), radius, widgets::kAccent);
    if (std::abs(at(i).x - mouse.x) + std::abs(at(i).y - mouse.y) < 3 * radius)
      ImGui::SetTooltip("%s: %.0f points%s",
                        files::local_time_in_words(runs[i]->when_utc).substr(0, 16).c_str(), runs[i]->points,
                        is_by_earlier_rule(*runs[i]) ? ", by an earlier rule" : "");
  }
}

// What the simulator knows and no theatre does, which is why it stands here, and not in the theatre's own
// picture. Returns where the next word begins.
float draw_contact(const widgets::Ui& ui, float x, float y, const ContactWords& contact) {
  ImFont* const font = ui.theme.strong;
  const float sign = font->FontSize * 0.4F;
  widgets::draw_sign(*ImGui::GetWindowDrawList(), {x + sign, y + font->FontSize / 2}, sign, contact.severity);
  put(font, x + ui.theme.px(30), y, widgets::color_of(contact.severity), contact.text);
  ui.log.note_state("train_contact", contact.text);
  // As wide as the longest of the words, so that what stands beside it does not jump.
  const std::string longest = "DRAWING IN THE AIR, 00 mm off the bone";
  return x + ui.theme.px(60) + font->CalcTextSizeA(font->FontSize, 1e9F, 0, longest.c_str()).x;
}

}  // namespace

void TrainingView::draw_list(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect buttons = rest.cut_bottom(ui.theme.px(56), ui.theme.px(12));
  const widgets::Rect left = rest.cut_left(rest.width * 0.5F, ui.theme.px(12));
  widgets::begin_panel(ui, "train.list", left, "Exercises on the simulator");
  const float row = ui.theme.px(96), width = ImGui::GetContentRegionAvail().x;
  for (std::size_t i = 0; i < training::exercises().size(); ++i) {
    const Exercise& exercise = training::exercises()[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const std::string id = "train.exercise." + std::to_string(i);
    if (ImGui::InvisibleButton(id.c_str(), {width, row})) chosen_ = i;
    ui.log.note(id, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (i == chosen_) {
      draw.AddRectFilled(at, {at.x + width, at.y + row - ui.theme.px(6)}, widgets::kPanelEdge,
                         ui.theme.px(6));
      draw.AddRectFilled(at, {at.x + ui.theme.px(5), at.y + row - ui.theme.px(6)}, widgets::kAccent);
    }
    put(ui.theme.title, at.x + ui.theme.px(18), at.y + ui.theme.px(8), widgets::kText,
        std::string(exercise.title));
    float x = at.x + ui.theme.px(18);
    for (const Level level : kLevels) {
      const Score* best = training::best_of(scores_, exercise.id, level);
      const std::string words =
          std::string(to_text(level)) +
          (best != nullptr
               ? format(is_by_earlier_rule(*best) ? "  earlier rule %.0f" : "  best %.0f", best->points)
               : std::string("  not done"));
      const bool is_chosen = i == chosen_ && level == level_;
      put(is_chosen ? ui.theme.strong : ui.theme.body, x, at.y + ui.theme.px(54),
          is_chosen ? widgets::kAccent : widgets::kQuietText, (is_chosen ? "> " : "  ") + words);
      x += width / 3.2F;
    }
  }
  widgets::end_panel();

  const widgets::Rect above = rest.cut_top(rest.height * 0.6F, ui.theme.px(12));
  widgets::begin_panel(ui, "train.what", above, chosen().title);
  widgets::text_in(ui.theme.body, widgets::kText, chosen().what);
  ImGui::Spacing();
  int number = 0;
  for (const std::string_view step : chosen().steps)
    widgets::text_in(ui.theme.body, widgets::kText, format("%d  ", ++number) + std::string(step));
  ImGui::Spacing();
  const bool is_easy = level_ == training::Level::Easy;
  widgets::text_in(ui.theme.strong, is_easy ? widgets::kQuietText : widgets::kCaution,
                   "At this level: " + training::words_of_faults(chosen(), level_));
  ImGui::Spacing();
  const bool is_board = chosen().goal == training::Goal::Calibrate;
  widgets::text_in(
      ui.theme.body, widgets::kQuietText,
      is_board
          ? "Keys: A D W S Q E move the board, J L I K tilt it, U O roll it, Shift the scope "
            "instead, Z X turn the lens, Space takes the picture, Enter says done. Mouse: left "
            "button the board, right its tilt and with the wheel the lens, wheel nearer and away."
          : "Keys: A D W S Q E move the tool, J L I K U O its handle, Shift the scope instead, B "
            "finely, Z X the lens, F the drill, G takes the other tool, Space is the pedal, Enter says done. "
            "Mouse: left button the tool, right its handle, middle the scope, wheel nearer and "
            "away.");
  const std::string pad = HandDevices::pad_name();
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   pad.empty() ? "No gamepad is connected." : "Also by " + pad + ": sticks and triggers.");
  const std::string refusal = this->refusal();
  ui.log.note_state("train_refusal", refusal);
  if (!refusal.empty()) widgets::text_in(ui.theme.strong, widgets::kCaution, "Cannot start: " + refusal);
  widgets::end_panel();
  draw_history(ui, rest);

  widgets::Rect bar = buttons;
  for (const char* id : {"train.list.start", "train.list.easier", "train.list.harder", "train.list.previous",
                         "train.list.next"}) {
    const widgets::Rect place = bar.cut_left(ui.theme.px(240), ui.theme.px(12));
    ImGui::SetCursorScreenPos(place.min());
    widgets::action_button(ui, id, place.width, place.height);
  }
}

void TrainingView::draw_history(const widgets::Ui& ui, const widgets::Rect& area) const {
  std::vector<const Score*> runs;
  std::size_t others = 0;  // of `arthronaut train --keep`: they say nothing of how well this hand does
  for (const Score& score : scores_) {
    // What was stopped says nothing of how well anybody does.
    if (score.exercise != chosen().id || score.level != level_ || !score.is_done) continue;
    if (score.trainee == training::kByHand)
      runs.push_back(&score);
    else
      ++others;
  }
  ui.log.note_state("train_runs", std::to_string(runs.size()));
  widgets::begin_panel(ui, "train.history", area,
                       "Points over time, " + std::string(to_text(level_)) + ": " +
                           std::to_string(runs.size()) + (runs.size() == 1 ? " run" : " runs") +
                           (others > 0 ? ", " + std::to_string(others) + " not by hand left out" : ""));
  if (runs.empty())
    widgets::text_in(ui.theme.body, widgets::kQuietText, "Not done at this level yet.");
  else {
    const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    widgets::Rect plot{at.x + ui.theme.px(60), at.y + ui.theme.px(14), room.x - ui.theme.px(80),
                       room.y - ui.theme.px(50)};
    draw_points(ui, plot, runs);
    put(ui.theme.body, plot.x, plot.y + plot.height + ui.theme.px(6), widgets::kQuietText,
        files::local_day(runs.front()->when_utc));
    if (runs.size() > 1)
      put(ui.theme.body, plot.x + plot.width - ui.theme.px(130), plot.y + plot.height + ui.theme.px(6),
          widgets::kQuietText, files::local_day(runs.back()->when_utc));
  }
  widgets::end_panel();
}

void TrainingView::draw_strip(const widgets::Ui& ui, const widgets::Rect& area) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel, ui.theme.px(6));
  const theatre::LiveStatePtr live = theatre_.live();
  // Until the theatre has worked its first picture in there is nothing to be done.
  const auto truth = run_ && run_->is_prepared ? run_->watch->log()->newest() : std::nullopt;
  std::string words = std::string(chosen().title) + ", " + std::string(to_text(level_)) + "   ";
  if (!truth)
    words += "finding a place for the scope ...";
  else {
    words += format("%.0f s   in hand: %s", truth->time_s,
                    truth->hand.held == simulator::Held::Probe ? "probe" : "guide");
    const camera::Calibration& scope = run_->source.pipeline.calibration;
    const camera::CameraModel lens(scope, scope.lens_angle_rad(truth->hand.mark_angle_deg),
                                   run_->source.pipeline.refractive_index);
    const auto bone = opened_->model->shared_surface(run_->setup.exercise.bone);
    const std::string lost = bone != nullptr ? training::way_back_into_view(truth->hand, lens, *bone) : "";
    ui.log.note_state("train_lost", lost);
    words += (lost.empty() ? "" : ", " + lost) + "   ";
    if (truth->hand.held == simulator::Held::Guide && run_->setup.exercise.goal == training::Goal::Drill)
      words += format("depth stop %.0f mm, planned %.0f mm   ", truth->hand.drilled_depth_mm,
                      run_->setup.plan_length_mm);
    words += training::ways_of_keys(truth->hand, opened_->model->axes(run_->setup.exercise.bone));
  }
  const auto first = truth ? run_->watch->log()->at(0) : std::nullopt;
  const bool has_moved = first && (truth->hand.probe_tip_mm - first->hand.probe_tip_mm).norm() +
                                          (truth->hand.guide_point_mm - first->hand.guide_point_mm).norm() >
                                      2;
  // Of a probe whose tip is not known no stroke is taken, on the bone or off it.
  const bool draws = live->operation->draws && live->operation->frame.tip_is_valid;
  const float first_y = area.y + ui.theme.px(10);
  const float end_x = truth ? draw_contact(ui, area.x + ui.theme.px(14), first_y,
                                           contact_words(truth->hand, draws, has_moved))
                            : area.x + ui.theme.px(14);
  put(ui.theme.strong, end_x, first_y, widgets::kText, words);
  put(ui.theme.body, area.x + ui.theme.px(14), area.y + ui.theme.px(46), widgets::kQuietText,
      "Tool: A D W S, Q nearer, E away   Handle: J L I K, U nearer, O away   Held: B finely, Shift the "
      "scope "
      "instead   Z X lens   F drill   G other tool   Space pedal   Enter done   hold Esc stop");
  ui.log.note("train.strip", area.min(), area.max());
  ui.log.note_state("train_hand",
                    truth ? (truth->hand.held == simulator::Held::Probe ? "probe" : "guide") : "");
  ui.log.note_state("train_rate", format("%.1f", live->frames_per_second));
  ui.log.note_state("train_time", truth ? format("%.1f", truth->time_s) : "");
  if (first) ui.log.note_state("train_moved", has_moved ? "yes" : "no");
}

void TrainingView::draw_score(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect buttons = rest.cut_bottom(ui.theme.px(56), ui.theme.px(12));
  widgets::Rect left = rest.cut_left(rest.width * 0.62F, ui.theme.px(12));
  const Score& score = *score_;
  const Exercise* const exercise = training::find_exercise(score.exercise);
  ui.log.note_state("train_points", format("%.0f", score.points));
  ui.log.note_state("train_done", score.is_done ? "yes" : "no");
  widgets::begin_panel(ui, "train.parts", left,
                       std::string(exercise->title) + ", " + std::string(to_text(score.level)));
  const float width = ImGui::GetContentRegionAvail().x;
  for (const training::ScorePart& part : score.parts) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float text_x = ui.theme.px(230), sign = ui.theme.body->FontSize * 0.4F;
    widgets::draw_sign(*ImGui::GetWindowDrawList(), {at.x + sign, at.y + ui.theme.body->FontSize / 2}, sign,
                       severity_of(part));
    put(ui.theme.strong, at.x + ui.theme.px(40), at.y, widgets::kText,
        format("%.0f of %.0f", part.points, part.most_points));
    put(ui.theme.body, at.x + text_x, at.y, widgets::kText, part.reason, width - text_x);
    ImGui::Dummy({width, height_of(ui.theme.body, part.reason, width - text_x) + ui.theme.px(10)});
  }
  widgets::end_panel();

  const widgets::Rect top = rest.cut_top(ui.theme.px(190), ui.theme.px(12));
  widgets::begin_panel(ui, "train.points", top, score.is_done ? "Points" : "Stopped before it was done");
  widgets::text_in(ui.theme.number, score.is_done ? widgets::kText : widgets::kCaution,
                   score.is_done ? format("%.0f of 100", score.points) : "Not counted");
  const Score* best = training::best_of(scores_, score.exercise, score.level);
  if (best != nullptr)
    widgets::text_in(ui.theme.body, widgets::kQuietText, format("Best so far: %.0f", best->points));
  widgets::end_panel();
  const widgets::Rect middle = rest.cut_top(rest.height * 0.48F, ui.theme.px(12));
  widgets::begin_panel(ui, "train.better", middle, "To do better");
  for (const std::string& advice : score.better) {
    widgets::text_in(ui.theme.body, widgets::kText, advice);
    ImGui::Spacing();
  }
  if (score.better.empty()) widgets::text_in(ui.theme.body, widgets::kGood, "Nothing: all points.");
  if (!score.session.empty())
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "Recorded: F3, Review, " + std::to_string(cases::session_number(score.session)) + ".");
  else if (exercise->goal == training::Goal::Calibrate)
    widgets::text_in(ui.theme.body, widgets::kQuietText,
                     "Calibrating is no operation: the score is kept, no session and no camera is.");
  widgets::end_panel();
  draw_history(ui, rest);

  widgets::Rect bar = buttons;
  for (const char* id : {"train.score.list", "train.score.again"}) {
    const widgets::Rect place = bar.cut_left(ui.theme.px(260), ui.theme.px(12));
    ImGui::SetCursorScreenPos(place.min());
    widgets::action_button(ui, id, place.width, place.height);
  }
}

}  // namespace arthronaut::training_mode
