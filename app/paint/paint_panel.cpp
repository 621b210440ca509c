// How the painting screen looks.
#include <algorithm>
#include <cmath>

#include "app/paint/paint_view.h"
#include "planning/painting/label_edits.h"

namespace arthronaut::paint {

namespace {

using painting::Layer;
using State = BoneMaking::State;
using widgets::Severity;

// Red, green, blue, alpha, the last byte first. Blue, orange, and a grey violet for what is no bone: told
// apart by colour-blind eyes, and by their names beside the brush.
constexpr std::uint32_t rgba(std::uint32_t red, std::uint32_t green, std::uint32_t blue,
                             std::uint32_t alpha) {
  return red | green << 8U | blue << 16U | alpha << 24U;
}
std::vector<std::uint32_t> colors(std::uint32_t alpha) {
  return {0, rgba(86, 180, 233, alpha), rgba(240, 160, 30, alpha), rgba(204, 121, 200, alpha)};
}
constexpr std::uint32_t kBoneAlpha = 70, kPreviewAlpha = 110, kStrokeAlpha = 200;

void buttons(const widgets::Ui& ui, const widgets::Rect& bar, std::initializer_list<const char*> ids) {
  ImGui::SetCursorScreenPos(bar.min());
  for (const char* id : ids) {
    widgets::action_button(ui, id, 0, bar.height);
    ImGui::SameLine(0, ui.theme.px(6));
  }
}

void draw_bar(const widgets::Ui& ui, double fraction) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ui.theme.px(14);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto done = static_cast<float>(std::clamp(fraction, 0.0, 1.0));
  draw.AddRectFilled(at, {at.x + width, at.y + height}, widgets::kPanelEdge, ui.theme.px(5));
  draw.AddRectFilled(at, {at.x + width * done, at.y + height}, widgets::kAccent, ui.theme.px(5));
  ImGui::Dummy({width, height + ui.theme.px(6)});
}

}  // namespace

void PaintView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  note_states(ui);
  if (!is_ready()) {
    const std::string words =
        !store_.failure().empty()
            ? "The images cannot be shown: " + store_.failure()
            : "Loading the images: " + widgets::fixed(100 * store_.loaded_fraction(), 0) + " %";
    widgets::text_centered(ui, area, ui.theme.title, widgets::kQuietText, words);
    return;
  }
  widgets::Rect rest = area;
  const widgets::Rect panel = rest.cut_right(ui.theme.px(470), ui.theme.px(12));
  buttons(ui, rest.cut_top(ui.theme.px(44), ui.theme.px(8)),
          {"paint.femur", "paint.tibia", "paint.surroundings", "paint.eraser", "paint.strokes", "paint.bones",
           "paint.smaller", "paint.larger", "paint.ball"});
  buttons(ui, rest.cut_top(ui.theme.px(44), ui.theme.px(8)),
          {"paint.grow", "paint.threshold", "paint.part", "paint.island", "paint.holes", "paint.gaps",
           "paint.cortex", "paint.between", "paint.smooth"});
  buttons(
      ui, rest.cut_top(ui.theme.px(44), ui.theme.px(10)),
      {"paint.window", "paint.fit", "paint.hide", "paint.undo", "paint.redo", "paint.make", "paint.leave"});
  const float gap = ui.theme.px(6);
  widgets::Rect left = rest.cut_left((rest.width - gap) / 2, gap);
  const widgets::Rect axial = left.cut_top((left.height - gap) / 2, gap);
  const widgets::Rect coronal = rest.cut_top((rest.height - gap) / 2, gap);
  draw_slices(ui, {axial, coronal, left});
  draw_keyed_pane(ui, {axial, coronal, left});
  draw_model(ui, rest);
  draw_panel(ui, panel);
}

plan::SliceLabels PaintView::labels_shown() {
  if (painting_->revision() != look_.drawn_revision) {
    look_.drawn_revision = painting_->revision();
    ++look_.labels_revision;
  }
  plan::SliceLabels shown;
  shown.revision = look_.labels_revision;
  if (look_.hides_labels) return shown;
  const bool has_grown = previewing_.kind == Preview::Growth && !previewing_.grown.empty();
  if (has_grown)
    shown.layers.push_back({.labels = previewing_.grown, .colors = colors(kPreviewAlpha)});
  else
    shown.layers.push_back({.labels = painting_->labels(Layer::Bones), .colors = colors(kBoneAlpha)});
  if (previewing_.kind == Preview::Threshold)
    shown.layers.push_back({.threshold = static_cast<float>(previewing_.threshold),
                            .colors = {0, colors(kPreviewAlpha)[brushing_.label]}});
  // The strokes stand over the bones that were grown from them, so that more can be painted.
  if (brushing_.layer == Layer::Strokes || has_grown)
    shown.layers.push_back({.labels = painting_->labels(Layer::Strokes), .colors = colors(kStrokeAlpha)});
  return shown;
}

void PaintView::draw_slices(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas) {
  const plan::SliceLabels labels = labels_shown();
  constexpr std::array<const char*, 3> kNames{"paint.axial_slice", "paint.coronal_slice",
                                              "paint.sagittal_slice"};
  for (std::size_t i = 0; i < panes_.size(); ++i) {
    plan::SliceContent content;
    content.volume = &painting_->volume();
    content.revision = look_.judged;
    content.cross_mm = look_.cross_mm;
    content.window = look_.window;
    content.labels = &labels;
    if (can_edit()) content.brush_mm = brushing_.brush.radius_mm;
    content.shows_brush_at_cross = keys_.is_down && i == keys_.pane;
    // The new surfaces over the images: that is where they are judged.
    if (is_judging())
      for (const importing::ImportedBone& made : making_.result().bones)
        content.meshes.push_back({&made.bone.mesh, widgets::kText, 1.5F});
    follow(i, panes_[i].draw(ui, kNames[i], areas[i], content));
  }
}

void PaintView::draw_model(const widgets::Ui& ui, const widgets::Rect& area) {
  if (is_judging()) {
    model_.draw(ui, "paint.model", area);
    widgets::caption(ui, area, widgets::kText, "The surfaces, from the front; drag to turn");
    return;
  }
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), widgets::kPanel);
  draw.AddRect(area.min(), area.max(), widgets::kPanelEdge);
  widgets::text_centered(
      ui, area.inset(ui.theme.px(20)), ui.theme.body, widgets::kQuietText,
      "Left drag paints   |   wheel goes through the slices\nCtrl + wheel zooms   |   Shift + drag shifts\n"
      "Ctrl + click: the other slices come here\n"
      "Shift + wheel: size of the brush   |   right drag: grey values\n\n"
      "By keys, in the framed slice: Alt + arrows move the cross-hair,\n"
      "Space lowers and lifts the brush there, Shift + Page up and down scroll\n\n"
      "The bones' surfaces are shown here when they are made");
}

void PaintView::draw_work(const widgets::Ui& ui) {
  if (making_.state() == State::Making || making_.state() == State::Saving) {
    const bool saves = making_.state() == State::Saving;
    widgets::text_in(
        ui.theme.strong, widgets::kText,
        saves ? "Writing the bones" : std::string(importing::in_words(making_.progress().stage)) + " ...");
    draw_bar(ui, saves ? 1 : making_.done_fraction());
    if (!saves) widgets::action_button(ui, "paint.stop", ImGui::GetContentRegionAvail().x);
  } else if (job_.is_running()) {
    widgets::text_in(ui.theme.strong, widgets::kText,
                     job_.is_cancelled() ? "Stopping" : job_.what() + " ...  (Esc stops)");
    draw_bar(ui, job_.fraction());
  }
}

void PaintView::draw_quality(const widgets::Ui& ui) {
  bool is_doubted = false;
  for (const importing::BoneQuality& quality : making_.qualities())
    is_doubted = is_doubted || !quality.doubts.empty() || !importing::surface_doubts(quality).empty();
  widgets::text_in(ui.theme.strong, is_doubted ? widgets::kCaution : widgets::kText,
                   is_doubted ? "Look before you rely on these surfaces"
                              : "The white outlines are the surfaces: do they follow the bones?");
  for (const importing::BoneQuality& quality : making_.qualities()) {
    const bool is_femur = quality.kind == bones::BoneKind::Femur;
    widgets::text_in(ui.theme.strong, widgets::kAccent, is_femur ? "Femur" : "Tibia");
    for (const importing::QualityLine& line : importing::quality_lines(quality))
      widgets::status_row(ui, severity_of(line.verdict), line.name, line.text);
  }
}

std::string PaintView::next_step_here() const {
  return next_step(*painting_, previewing_.kind, job_.is_running(), store_.is_of_case(*painting_),
                   making_.state() == State::Making || making_.state() == State::Saving);
}

void PaintView::draw_steps(const widgets::Ui& ui) {
  widgets::text_in(ui.theme.strong, widgets::kQuietText, "Steps");
  // The newest first; a click goes there.
  const std::size_t count = painting_->step_count();
  constexpr std::size_t kShown = 40;
  for (std::size_t n = 0; n < std::min(count, kShown); ++n) {
    const std::size_t step = count - 1 - n;
    const bool is_done = step < painting_->position();
    ImGui::PushID(static_cast<int>(step));
    ImGui::PushStyleColor(ImGuiCol_Text, is_done ? widgets::kText : widgets::kQuietText);
    if (ImGui::Selectable(painting_->step_name(step).c_str(), step + 1 == painting_->position()) &&
        can_edit() && !job_.is_running())
      painting_->go_to(step + 1);
    ImGui::PopStyleColor();
    ImGui::PopID();
  }
  if (count == 0) widgets::text_in(ui.theme.body, widgets::kQuietText, "Nothing was painted yet");
}

void PaintView::draw_panel(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  if (is_judging()) {
    // However long the list: how it is decided stays on the screen.
    const widgets::Rect buttons = rest.cut_bottom(ui.theme.px(104), ui.theme.px(8));
    widgets::begin_panel(ui, "paint.panel", rest, "Paint the bones");
    if (!making_.failure().empty()) widgets::status_row(ui, Severity::Bad, "Not taken", making_.failure());
    draw_quality(ui);
    widgets::end_panel();
    ImGui::SetCursorScreenPos(buttons.min());
    widgets::action_button(ui, "paint.accept", buttons.width, ui.theme.px(52));
    ImGui::SetCursorScreenPos({buttons.x, buttons.y + ui.theme.px(60)});
    widgets::action_button(ui, "paint.put_aside", buttons.width, ui.theme.px(44));
    return;
  }
  widgets::begin_panel(ui, "paint.panel", rest, "Paint the bones");
  widgets::text_in(ui.theme.strong, widgets::kAccent, next_step_here());
  ImGui::Dummy({0, ui.theme.px(6)});
  draw_work(ui);
  if (previewing_.kind != Preview::None) {
    if (previewing_.kind == Preview::Threshold)
      widgets::text_in(
          ui.theme.strong, widgets::kText,
          "Threshold " + widgets::fixed(previewing_.threshold, 0) + " HU, as " + label_name(brushing_.label));
    const float width = (ImGui::GetContentRegionAvail().x - ui.theme.px(8)) / 2;
    widgets::action_button(ui, "paint.take", width);
    ImGui::SameLine(0, ui.theme.px(8));
    widgets::action_button(ui, is_working() ? "paint.stop" : "paint.put_aside", width);
  }
  const std::string brush = label_name(brushing_.label) + " on " +
                            (brushing_.layer == Layer::Strokes ? "strokes" : "bones") + ", " +
                            (brushing_.brush.is_ball ? "ball" : "disc") + " of " +
                            widgets::fixed(2 * brushing_.brush.radius_mm, 1) + " mm" +
                            (keys_.is_down ? ", down: Space lifts it" : "");
  widgets::status_row(ui, Severity::Quiet, "Brush", brush);
  if (!hint_.empty()) widgets::status_row(ui, Severity::Caution, "Not done", hint_);
  if (!making_.failure().empty()) widgets::status_row(ui, Severity::Bad, "No surfaces", making_.failure());
  const bool is_saved = store_.is_saved(*painting_);
  widgets::status_row(ui,
                      !store_.failure().empty() ? Severity::Bad
                      : is_read_only_           ? Severity::Caution
                      : is_saved                ? Severity::Good
                                                : Severity::Quiet,
                      "Case",
                      !store_.failure().empty() ? "not saved: " + store_.failure()
                      : is_read_only_           ? "read-only: nothing can be painted"
                      : is_saved                ? "what is painted is saved"
                                                : "saving");
  ImGui::Dummy({0, ui.theme.px(6)});
  draw_steps(ui);
  widgets::end_panel();
}

void PaintView::note_states(const widgets::Ui& ui) const {
  ui.log.note_state("painting", is_ready() ? "ready" : store_.is_loading() ? "loading" : "none");
  if (!is_ready()) return;
  constexpr std::array<const char*, 5> kMaking{"idle", "making", "judging", "saving", "done"};
  ui.log.note_state("making", kMaking[static_cast<std::size_t>(making_.state())]);
  ui.log.note_state("paint_brush", label_name(brushing_.label) + " on " +
                                       (brushing_.layer == Layer::Strokes ? "strokes" : "bones"));
  ui.log.note_state("brush_mm", widgets::fixed(brushing_.brush.radius_mm, 2));
  ui.log.note_state("paint_undo",
                    painting_->can_undo() ? painting_->step_name(painting_->position() - 1) : "");
  ui.log.note_state("paint_redo", painting_->can_redo() ? painting_->step_name(painting_->position()) : "");
  ui.log.note_state("paint_preview", previewing_.kind == Preview::None        ? "none"
                                     : previewing_.kind == Preview::Threshold ? "threshold"
                                     : job_.is_running() || previewing_.grown.empty() ||
                                             previewing_.of_revision != painting_->revision()
                                         ? "growing"
                                         : "grown");
  ui.log.note_state("paint_threshold", widgets::fixed(previewing_.threshold, 0));
  ui.log.note_state("paint_work", job_.is_running() ? job_.what() : "");
  ui.log.note_state("paint_hint", !hint_.empty() ? hint_ : making_.failure());
  ui.log.note_state("paint_saved", store_.is_saved(*painting_) ? "yes" : "no");
  ui.log.note_state("paint_next", next_step_here());
  ui.log.note_state("paint_keyed_pane", std::to_string(keys_.pane));
  ui.log.note_state("paint_cross", widgets::fixed(look_.cross_mm.x(), 1) + " " +
                                       widgets::fixed(look_.cross_mm.y(), 1) + " " +
                                       widgets::fixed(look_.cross_mm.z(), 1));
}

}  // namespace arthronaut::paint
