// How the start looks.
#include <algorithm>
#include <array>
#include <cstring>

#include "app/start/import_questions.h"
#include "app/start/side_line.h"
#include "app/start/start_view.h"
#include "app/widgets/list_rows.h"

namespace arthronaut::start {

namespace {

using State = ImportWork::State;
using widgets::Severity;

}  // namespace

void StartView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  switch (state_.page) {
    case Page::Cases:
      cases_.draw(ui, area);
      break;
    case Page::Browse:
      draw_browser(ui, area);
      break;
    case Page::Import:
      draw_import(ui, area);
      break;
    case Page::Pacs:
      pacs_.draw(ui, area);
      break;
  }
  state_.scrolls_to_selected = false;
  constexpr std::array<const char*, 7> kStates{"idle",   "looking", "choosing", "running",
                                               "asking", "saving",  "done"};
  constexpr std::array<const char*, 4> kPages{"cases", "browse", "import", "pacs"};
  ui.log.note_state("start", kPages[static_cast<std::size_t>(state_.page)]);
  ui.log.note_state("import", kStates[static_cast<std::size_t>(work_.state())]);
  ui.log.note_state("import_failure", work_.failure());
  if (state_.page != Page::Browse) ui.log.note_state("selected", std::to_string(state_.selected));
}

bool StartView::draw_page_row(const widgets::Ui& ui, const std::string& name, std::size_t row, float height) {
  const widgets::RowPress press = widgets::draw_row(ui, {.name = name,
                                                         .number = row,
                                                         .height = height,
                                                         .is_selected = row == state_.selected,
                                                         .scrolls_here = state_.scrolls_to_selected});
  if (press != widgets::RowPress::None) {
    state_.selected = row;
    take_selected_volume();
  }
  return press == widgets::RowPress::Twice;
}

void StartView::draw_browser(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  widgets::draw_buttons(
      ui, rest.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
      {"start.accept", "start.up", "start.home", "start.type_path", "start.import_folder", "start.back"});
  if (const auto found = browser_.draw(ui, rest, state_.browse_title, "Import this folder")) take(*found);
}

void StartView::draw_import(const widgets::Ui& ui, const widgets::Rect& area) {
  switch (work_.state()) {
    case State::Looking:
      widgets::text_centered(ui, area, ui.theme.title, widgets::kText,
                             "Looking through the folder: " +
                                 widgets::fixed(100 * work_.looked_fraction(), 0) + " %\nEsc stops.");
      return;
    case State::Running:
    case State::Saving: {
      const std::string stage(work_.state() == State::Saving ? "Writing the case"
                                                             : importing::in_words(work_.progress().stage));
      widgets::Rect rest = area;
      const widgets::Rect words = rest.cut_top(area.height / 2);
      widgets::text_centered(ui, words, ui.theme.title, widgets::kText, stage);
      const float width = area.width / 2, height = ui.theme.px(24);
      const ImVec2 at(area.x + area.width / 4, area.y + area.height / 2 + ui.theme.px(20));
      ImDrawList& draw = *ImGui::GetWindowDrawList();
      draw.AddRectFilled(at, {at.x + width, at.y + height}, widgets::kPanelEdge, ui.theme.px(6));
      const auto done = static_cast<float>(work_.state() == State::Saving ? 1.0 : work_.done_fraction());
      draw.AddRectFilled(at, {at.x + width * done, at.y + height}, widgets::kAccent, ui.theme.px(6));
      widgets::draw_buttons(ui, {at.x, at.y + ui.theme.px(60), width, ui.theme.px(56)}, {"start.back"});
      return;
    }
    case State::Asking:
      return draw_result(ui, area);
    default:
      return draw_sources(ui, area);
  }
}

void StartView::draw_answers(const widgets::Ui& ui, const widgets::Rect& bar) {
  switch (question()) {
    case importing::FailureReason::ShowsBothKnees:
      return widgets::draw_buttons(
          ui, bar, {"start.import", "start.paint", "start.tick", "start.right", "start.left", "start.back"});
    case importing::FailureReason::NeedsUnit:
      return widgets::draw_buttons(
          ui, bar, {"start.unit_m", "start.unit_cm", "start.unit_in", "start.tick", "start.back"});
    case importing::FailureReason::NeedsLabels:
      return widgets::draw_buttons(ui, bar, {"start.import", "start.femur", "start.tibia", "start.back"});
    default:
      break;
  }
  if (selects_mesh())
    widgets::draw_buttons(ui, bar,
                          {"start.import", "start.tick", "start.femur", "start.tibia", "start.back"});
  else if (planned_of_selected() != nullptr)
    widgets::draw_buttons(ui, bar,
                          {"start.compare", "start.import", "start.paint", "start.tick", "start.back"});
  else
    widgets::draw_buttons(ui, bar, {"start.import", "start.paint", "start.tick", "start.back"});
}

void StartView::draw_refusal(const widgets::Ui& ui) {
  const importing::Failure& refusal = work_.refusal();
  switch (refusal.reason) {
    case importing::FailureReason::ShowsBothKnees:
      return widgets::status_row(
          ui, Severity::Caution, "Both knees",
          "The images show both. Which one is it to be? Press R or L, then Enter" +
              std::string(!state_.side                         ? ""
                          : *state_.side == bones::Side::Right ? "  \u2013  the right one"
                                                               : "  \u2013  the left one"));
    case importing::FailureReason::IsNoCt:
      return widgets::status_row(
          ui, Severity::Caution, "No CT",
          "In an MR no grey value is bone alone. Press P: the images are taken, you paint a few "
          "strokes, and the bones grow from them");
    case importing::FailureReason::NeedsUnit:
      if (const ImportSource* mesh = work_.refused_source())
        widgets::status_row(ui, Severity::Caution, "Unit?", unit_question(mesh->title, refusal));
      return;
    case importing::FailureReason::NeedsLabels:
      widgets::status_row(ui, Severity::Caution, "Which labels?",
                          "The map does not say which labels are the bones. These are likely by their size "
                          "and place: press F or T for another, then Enter, and look at what was made");
      for (const bones::BoneKind bone : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
        widgets::status_row(ui, Severity::Quiet, bone == bones::BoneKind::Femur ? "Femur" : "Tibia",
                            chosen_label(refusal.labels, state_.labels, bone));
      return;
    case importing::FailureReason::Other:
      if (!refusal.words.empty()) widgets::status_row(ui, Severity::Bad, "Refused", refusal.words);
      return;
  }
}

namespace {

// Of the selected one all that is known against it, each on a line; of the others what is first, and how much
// more there is.
std::string wrong_in_words(const ImportSource& source, bool is_selected) {
  if (!source.can_be_imported()) return "Cannot be imported: " + source.refusal;
  if (source.warnings.empty()) return "";
  std::string words = source.warnings.front();
  if (!is_selected) {
    if (source.warnings.size() > 1)
      words += "  (and " + std::to_string(source.warnings.size() - 1) + " more)";
    return words;
  }
  for (std::size_t i = 1; i < source.warnings.size(); ++i) words += "\n" + source.warnings[i];
  return words;
}

}  // namespace

void StartView::draw_sources(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(88));
  const ImportSources& found = work_.sources();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  widgets::draw_text(draw, ui.theme.title, head.x, head.y, widgets::kText,
                     found.sources.empty() ? "Nothing to import was found"
                                           : "What was found. Take one, then make the bones");
  widgets::draw_text(draw, ui.theme.body, head.x, head.y + ui.theme.px(46), widgets::kAccent,
                     widgets::fitting(ui.theme.body, found.root.string(), head.width));
  const widgets::Rect buttons = rest.cut_bottom(ui.theme.px(56), ui.theme.px(12));
  draw_answers(ui, buttons);
  widgets::begin_panel(ui, "start.sources", rest);
  draw_refusal(ui);
  if (const library::PlannedCase* const planned = planned_of_selected()) {
    widgets::status_row(ui, Severity::Quiet, "Operated?", offer_in_words(*planned));
    ui.log.note_state("planned_case", planned->folder.filename().string());
  }
  const float picture = ui.theme.px(116);
  for (std::size_t i = 0; i < found.sources.size(); ++i) {
    const ImportSource& source = found.sources[i];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float wrap = width - picture - ui.theme.px(50);
    const std::string wrong = wrong_in_words(source, i == state_.selected);
    const float wrong_px = ui.theme.body->CalcTextSizeA(ui.theme.body->FontSize, 1e9F, wrap, wrong.c_str()).y;
    const float height = std::max(ui.theme.px(132), ui.theme.px(66 + 10) + wrong_px);
    if (draw_page_row(ui, "start.source." + std::to_string(i), i, height)) ui.actions.run("start.tick");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (const images::Thumbnail* made = work_.thumbnail(i); made != nullptr && made->width > 0) {
      auto& texture = thumbnails_[i];
      if (texture == nullptr) {
        texture = std::make_unique<widgets::GreyTexture>();
        texture->upload(made->width, made->height, made->grey);
      }
      const widgets::Rect into =
          widgets::fitted({at.x + ui.theme.px(8), at.y + ui.theme.px(8), picture, picture},
                          static_cast<float>(made->width) / static_cast<float>(made->height));
      list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture->texture())),
                    into.min(), into.max());
    }
    const bool is_ticked = std::find(state_.ticked.begin(), state_.ticked.end(), i) != state_.ticked.end();
    if (is_ticked) ui.log.note_state("taken", source.title);
    const float x = at.x + picture + ui.theme.px(30);
    const Severity sign = !source.can_be_imported()  ? Severity::Bad
                          : !source.warnings.empty() ? Severity::Caution
                          : is_ticked                ? Severity::Good
                                                     : Severity::Quiet;
    widgets::draw_sign(list, {x + ui.theme.px(10), at.y + ui.theme.px(24)}, ui.theme.px(9), sign);
    std::string title = source.title;
    if (source.bone) title += "  \u2013  the " + std::string(bones::to_text(*source.bone));
    if (is_ticked) title += "  \u2013  taken";
    widgets::draw_text(list, ui.theme.strong, x + ui.theme.px(30), at.y + ui.theme.px(10), widgets::kText,
                       widgets::fitting(ui.theme.strong, title, wrap));
    widgets::draw_text(list, ui.theme.body, x + ui.theme.px(30), at.y + ui.theme.px(38), widgets::kQuietText,
                       source.detail);
    if (i == state_.selected) ui.log.note_state("source_warnings", wrong);
    if (!wrong.empty())
      widgets::draw_text(list, ui.theme.body, x + ui.theme.px(30), at.y + ui.theme.px(66),
                         source.can_be_imported() ? widgets::kCaution : widgets::kBad, wrong, wrap);
  }
  for (const std::string& left : found.left_out) widgets::status_row(ui, Severity::Quiet, "Left out", left);
  widgets::end_panel();
}

void StartView::draw_result(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::Rect rest = area;
  const widgets::Rect head = rest.cut_top(ui.theme.px(64));
  const std::vector<std::string> doubts = work_.doubts();
  widgets::draw_text(*ImGui::GetWindowDrawList(), ui.theme.title, head.x, head.y, widgets::kText,
                     !state_.side       ? "Which knee is it? Nothing says so"
                     : !has_sure_side() ? "Which knee is it? Press R or L before the case is made"
                     : work_.result().bones.empty()
                         ? "The images are read. Make the case, then paint its bones"
                     : doubts.empty() ? "The bones are made"
                                      : "The bones are made, but look before you rely on them");
  const widgets::Rect buttons = rest.cut_bottom(ui.theme.px(56), ui.theme.px(12));
  if (work_.can_swap_axes())
    widgets::draw_buttons(ui, buttons,
                          {"start.save", "start.swap_axes", "start.right", "start.left", "start.back"});
  else
    widgets::draw_buttons(ui, buttons, {"start.save", "start.right", "start.left", "start.back"});
  const widgets::Rect made = rest.cut_right(made_.wanted_share() * rest.width, ui.theme.px(12));
  if (const auto clicked = made_.draw(ui, made, state_.side)) say_side(*clicked);
  widgets::begin_panel(ui, "start.result", rest);
  widgets::text_in(ui.theme.strong, widgets::kQuietText,
                   "Name of the case (no patient's name: it stands in exports)");
  std::array<char, 128> name{};
  std::strncpy(name.data(), state_.name.c_str(), name.size() - 1);
  ImGui::SetNextItemWidth(ui.theme.px(520));
  if (ImGui::InputText("##name", name.data(), name.size())) state_.name = name.data();
  ui.log.note("start.name", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  ImGui::Dummy({0, ui.theme.px(6)});
  if (!work_.failure().empty()) widgets::status_row(ui, Severity::Bad, "Not written", work_.failure());
  // Of what was fetched from a PACS, or lies on a disc, nothing else on this page says whose it is.
  if (const std::string whose = work_.result().identity.in_words(); !whose.empty()) {
    widgets::status_row(ui, Severity::Quiet, "Patient", whose);
    ui.log.note_state("import_patient", whose);
  }
  const SideLine side = side_line(work_.result(), state_.side, state_.side_was_said);
  widgets::status_row(ui, side.severity, "Side", side.text);
  ui.log.note_state("import_side",
                    std::string(side.severity == Severity::Good ? "good: " : "look: ") + side.text);
  for (const std::string& doubt : doubts) widgets::status_row(ui, Severity::Caution, "Look", doubt);
  if (work_.can_swap_axes())
    widgets::status_row(
        ui, Severity::Caution, "Axes?",
        "Many programs write meshes in RAS without saying so. Press X: the mesh is read in the "
        "other axes, and made again");
  for (const std::string& line : work_.result().lines) widgets::status_row(ui, Severity::Quiet, "", line);
  for (const importing::ImportedBone& bone : work_.result().bones)
    for (const std::string& line : bone.lines)
      widgets::status_row(ui, Severity::Quiet, bone.bone.kind == bones::BoneKind::Femur ? "Femur" : "Tibia",
                          line);
  widgets::end_panel();
}

}  // namespace arthronaut::start
