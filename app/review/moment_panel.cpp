#include <algorithm>

#include "app/guidance_severity/guidance_severity.h"
#include "app/review/ct_beside.h"
#include "app/review/review_panels.h"
#include "navigation/recording/drilled_by_word.h"

namespace arthronaut::review {

namespace {

void draw_score(const widgets::Ui& ui, const training::Score& score) {
  ImGui::Separator();
  widgets::text_in(ui.theme.title, widgets::kText,
                   score.is_done ? "Score: " + widgets::fixed(score.points, 0) + " of 100"
                                 : std::string("Stopped before it was done"));
  if (is_by_earlier_rule(score)) widgets::text_in(ui.theme.body, widgets::kQuietText, "By an earlier rule");
  for (const training::ScorePart& part : score.parts)
    widgets::status_row(ui,
                        part.points >= part.most_points ? widgets::Severity::Good
                        : part.points > 0               ? widgets::Severity::Caution
                                                        : widgets::Severity::Bad,
                        widgets::fixed(part.points, 0) + " of " + widgets::fixed(part.most_points, 0),
                        part.reason);
}

// The whole of what the list and the time line have room for in part: what happened here, or last before.
void draw_last_moment(const widgets::Ui& ui, const ReviewScreen& screen) {
  std::string words = last_moment_in_words(screen.review.moments, screen.timeline(), screen.playback.frame);
  for (const recording::SessionMark& mark : screen.marks)
    if (screen.timeline().at_index(mark.frame) == screen.playback.frame && !mark.note.empty())
      words += (words.empty() ? "Mark: " : "\nMark: ") + mark.note;
  ui.log.note_state("review_last_moment", words);
  if (!words.empty()) widgets::text_in(ui.theme.body, widgets::kText, words);
}

void draw_difference(const widgets::Ui& ui, const char* name, const operation::TunnelDifference& d) {
  widgets::text_in(ui.theme.strong, widgets::kText, name);
  widgets::text_in(ui.theme.body, widgets::kText,
                   "offset of the entry " + widgets::fixed(d.entry_mm, 1) + " mm, of the axis " +
                       widgets::fixed(d.axis_to_entry_mm, 1) + " mm, angle " +
                       widgets::fixed(d.angle_deg, 1) + "\u00B0");
}

void draw_achieved(const widgets::Ui& ui, const ReviewScreen& screen) {
  const SessionReview& review = screen.review;
  widgets::text_in(ui.theme.title, widgets::kText, "Planned and achieved");
  if (!review.achieved_problem.empty())
    return widgets::status_row(ui, widgets::Severity::Bad, "Not readable", review.achieved_problem);
  const auto by_word = recording::drilled_by_word(review.session->events, review.session->header.bone);
  for (const recording::DrilledByWord& said : by_word)
    widgets::status_row(ui, widgets::Severity::Caution, "By word alone",
                        said.tunnel + ": no pose shows where it runs");
  if (review.drilled.empty() && by_word.empty())
    return widgets::text_in(ui.theme.body, widgets::kQuietText, "No tunnel was recorded as drilled.");
  for (const DrilledTunnel& drilled : review.drilled) {
    const operation::AchievedTunnel& achieved = drilled.achieved;
    if (achieved.planned.bundle != norms::Bundle::Whole)
      widgets::text_in(ui.theme.strong, widgets::kText, tunnels::name_of(achieved.planned.key()) + " tunnel");
    draw_difference(ui, "As navigation measured it", operation::compare(achieved.planned, achieved.measured));
    if (achieved.truth)
      draw_difference(ui, "As it truly is (simulated)",
                      operation::compare(achieved.planned, *achieved.truth));
    if (screen.ct != nullptr && screen.ct->contains(achieved.planned.key())) {
      const CtWords ct = ct_in_words(screen.ct->at(achieved.planned.key()), achieved.planned);
      widgets::text_in(ui.theme.strong, widgets::kText, "As a CT after the operation shows it (P)");
      if (ct.severity == widgets::Severity::Quiet)
        widgets::text_in(ui.theme.body, widgets::kText, ct.text);
      else
        widgets::status_row(ui, ct.severity, "CT", ct.text);
      ui.log.note_state("moment_ct", ct.text);
    }
    widgets::text_in(
        ui.theme.body, widgets::kQuietText,
        achieved.depth_mm ? "Depth " + widgets::fixed(*achieved.depth_mm, 1) + " mm" : "Depth not known");
  }
}

// What the surgeon saw, and what today's program says of the same picture.
void draw_today(const widgets::Ui& ui, const ReviewScreen& screen) {
  ImGui::Separator();
  widgets::text_in(ui.theme.strong, widgets::kText, "Today's program on the same picture");
  const recording::RecordedFrame& then = screen.frame();
  const TodayFrame* const now = screen.today->find(then.index);
  if (now == nullptr) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, "This frame was not tracked again.");
  } else if (now->state != guidance::GuidanceState::Valid) {
    widgets::text_in(ui.theme.body, widgets::kText, std::string(guidance::to_text(now->state)));
  } else {
    std::string text = "offset of the axis " + widgets::fixed(static_cast<double>(now->offset_mm), 2) +
                       " mm, angle " + widgets::fixed(static_cast<double>(now->angle_deg), 2) + "\u00B0";
    if (then.guidance.is_valid())
      text += "; then " + widgets::fixed(then.guidance.offset_mm, 2) + " mm, " +
              widgets::fixed(then.guidance.angle_deg, 2) + "\u00B0";
    widgets::text_in(ui.theme.body, widgets::kText, text);
  }
  const auto& differing = screen.today->differing_frames;
  if (std::binary_search(differing.begin(), differing.end(), then.index))
    widgets::status_row(ui, widgets::Severity::Caution, "Differs", "beyond the tolerance in this frame");
  widgets::text_in(ui.theme.body, widgets::kQuietText, today_words(*screen.today));
}

// Of a drill with a marker of its own; nobody saw how deep another one was. As Navigate said it then: with
// its guide or without, beyond the plan "Too deep" and never a length with a minus sign, and beside the plan,
// or where nobody knows whether it is, no length but that to where it leaves the bone, once that warns.
void draw_drill(const widgets::Ui& ui, const guidance::DrillDepth& drill, const tools::ToolSet& tools) {
  // Of several it is said which, as Navigate said it.
  if (const std::string name = guidance_severity::drill_name(tools, drill); !name.empty())
    widgets::text_in(ui.theme.strong, widgets::kText, name);
  if (const std::string_view doubt = guidance_severity::drill_doubt(drill); !doubt.empty()) {
    const widgets::Severity severity = guidance_severity::severity_of_drill(drill);
    const guidance_severity::DrillText text = guidance_severity::drill_text(drill);
    const bool warns = drill.is_beside_plan() && severity != widgets::Severity::Quiet;
    return widgets::status_row(ui, warns ? severity : widgets::Severity::Caution, "Drill",
                               std::string(doubt) + (warns ? "; " + text.name + " " + text.mm + " mm" : ""));
  }
  const ImVec2 cursor = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(104);
  widgets::Rect right{cursor.x, cursor.y, width, height};
  const widgets::Rect left = right.cut_left(width / 2);
  widgets::number_block(ui, left, "Drill depth", widgets::fixed(drill.depth_mm, 1), "mm",
                        widgets::Severity::Quiet);
  const guidance_severity::DrillText text = guidance_severity::drill_text(drill);
  widgets::number_block(ui, right, text.name, text.mm, "mm", guidance_severity::severity_of_drill(drill));
  ImGui::Dummy({width, height});
}

}  // namespace

void draw_moment(const widgets::Ui& ui, const widgets::Rect& area, const ReviewScreen& screen) {
  const SessionReview& review = screen.review;
  const recording::RecordedFrame& at = screen.frame();
  widgets::begin_panel(ui, "review.moment", area, "At this moment");
  if (at.guidance.is_valid()) {
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(104);
    widgets::Rect row{cursor.x, cursor.y, width, height};
    constexpr float kForOffset = 0.58F;  // its name is the longer one, also beside a scroll bar
    const widgets::Rect left = row.cut_left(kForOffset * width);
    widgets::number_block(ui, left, "Offset of the axis", widgets::fixed(at.guidance.offset_mm, 1), "mm",
                          guidance_severity::severity_of_offset(at.guidance));
    widgets::number_block(ui, row, "Angle", widgets::fixed(at.guidance.angle_deg, 1) + "\u00B0", "",
                          guidance_severity::severity_of_angle(at.guidance));
    ImGui::Dummy({width, height});
  } else {
    widgets::status_row(ui, widgets::Severity::Quiet, "No guidance", screen.no_guidance_words());
  }
  if (at.guidance.drill) draw_drill(ui, *at.guidance.drill, review.session->options.tools);
  const RegistrationRow registration = registration_row(review, at.index);
  widgets::status_row(ui, registration.severity, "Registration", registration.text);
  ui.log.note_state("review_registration", registration.text);
  draw_last_moment(ui, screen);
  if (screen.today != nullptr) draw_today(ui, screen);
  if (screen.score != nullptr) draw_score(ui, *screen.score);
  ImGui::Separator();
  draw_achieved(ui, screen);
  for (const std::string& problem : review.problems)
    widgets::status_row(ui, widgets::Severity::Caution, "Not whole", problem);
  widgets::end_panel();
}

}  // namespace arthronaut::review
