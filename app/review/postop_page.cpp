#include "app/review/postop_page.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "app/review/slice_letters.h"
#include "app/widgets/list_rows.h"
#include "navigation/worker/freed_memory.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/postop/achieved_file.h"

namespace arthronaut::review {

namespace {

constexpr int kSlice_px = 420;

}  // namespace

PostopPage::PostopPage(std::function<void()> make_current, std::function<void()> wake)
    : wake_(std::move(wake)), pane_(std::move(make_current)) {}

void PostopPage::open(const open_case::PlanModel* model, const std::filesystem::path& case_folder,
                      const std::string& read_only) {
  model_ = model;
  case_folder_ = case_folder;
  read_only_ = read_only;
  stop();
  letting_go_.take(std::move(run_));
  shown_ = {};
  better_kept_.clear();
  places_are_of_ = 0;
  which_.clear();
  problem_.clear();
  field_ = {};
  leave_browser();
  scene_is_stale_ = true;
  try {  // a broken file must not hide the case: its reason is shown
    if (std::filesystem::exists(achieved_file(case_folder_)))
      shown_.comparisons = postop::read_achieved_file(achieved_file(case_folder_));
  } catch (const InvalidInput& error) {
    problem_ = error.what();
  } catch (const IoError& error) {
    problem_ = error.what();
  }
  if (!shown_.comparisons.empty()) chosen_ = shown_.comparisons.begin()->first;
}

void PostopPage::compare_with(const std::filesystem::path& source, const std::string& series) {
  if (is_running() || model_ == nullptr) return;
  problem_.clear();
  shown_.other_patient.clear();
  shown_.not_its_bones.clear();
  better_kept_.clear();
  which_.clear();
  leave_browser();
  source_ = source;
  run_ = std::make_unique<PostopRun>(case_folder_, source, series, read_only_.empty(), wake_);
}

void PostopPage::stop() {
  if (is_running()) run_->stop();
}

void PostopPage::choose_next() {
  if (shown_.comparisons.empty()) return;
  const auto next = shown_.comparisons.upper_bound(chosen_);
  chosen_ = next == shown_.comparisons.end() ? shown_.comparisons.begin()->first : next->first;
  scene_is_stale_ = true;
}

void PostopPage::replace_kept() {
  if (!may_replace_kept()) return;
  try {  // the disk may refuse: what is kept stays
    postop::write_achieved_file(achieved_file(case_folder_), shown_.answer->comparisons,
                                shown_.answer->places);
    better_kept_.clear();
  } catch (const IoError& error) {
    better_kept_ = error.what();
  }
}

void PostopPage::ask_for_path() { field_ = {true, true, field_.text}; }

void PostopPage::browse() {
  search_.is_open = true;
  search_.folders.enter();
}

const postop::Comparison* PostopPage::chosen() const {
  const auto found = shown_.comparisons.find(chosen_);
  return found == shown_.comparisons.end() ? nullptr : &found->second;
}

std::map<tunnels::TunnelKey, tunnels::Tunnel> PostopPage::planned() const {
  std::map<tunnels::TunnelKey, tunnels::Tunnel> planned;
  for (const auto& [key, comparison] : shown_.comparisons)
    if (const auto tunnel = model_->tunnel(key); tunnel && model_->plan_fit(key).is_valid())
      planned.emplace(key, *tunnel);
  return planned;
}

const Places& PostopPage::places() {
  if (std::exchange(places_are_of_, model_->revision()) == model_->revision()) return places_;
  places_.clear();
  for (const auto& [key, plan] : planned())
    if (const auto& found = shown_.comparisons.at(key).tunnel; found.is_found && model_->has_bone(key.bone))
      places_.emplace(key, postop::place_of(found, plan, model_->surroundings(key.bone),
                                            plan_review::state_of_grid(model_->knee(), key.bone)));
  return places_;
}

void PostopPage::take_ended() {
  // What it says last it says before it has ended: asked for first, an answer might come in between and be
  // lost.
  if (run_ == nullptr || !run_->has_ended()) return;
  problem_ = run_->error();
  PostopProgress progress = run_->progress();
  run_.reset();
  worker::give_freed_memory_back();
  if (!problem_.empty()) return;
  which_ = std::move(progress.which);
  auto answer = std::move(progress.answer);
  if (answer == nullptr) return;  // stopped, or it asks: what was there stays
  if (!take_answer(std::move(answer), shown_)) return;
  better_kept_ = std::move(progress.better_kept);
  places_are_of_ = 0;
  if (!shown_.comparisons.empty() && !shown_.comparisons.contains(chosen_))
    chosen_ = shown_.comparisons.begin()->first;
  scene_is_stale_ = true;
}

void PostopPage::show_scene() {
  const bones::BoneKind bone = chosen_.bone;
  scene::SceneContent content;
  content.bones.push_back({model_->drawn_mesh(bone), scene::kBoneColor, 1.0});
  for (const auto& [key, comparison] : shown_.comparisons) {
    if (key.bone != bone) continue;
    if (const auto tunnel = model_->tunnel(key))
      scene::add_planned_tunnel(content, *tunnel, model_->drawn_length_mm(key));
    if (comparison.tunnel.is_found)
      scene::add_achieved_tunnel(content, comparison.tunnel.tunnel, comparison.tunnel.length_mm);
  }
  pane_.show(content);
}

void PostopPage::look_at_chosen() {
  if (const auto tunnel = model_->tunnel(chosen_))
    pane_.look(scene::orbited(
        scene::look_along(tunnel->direction.normalized(), tunnel->entry_mm, 190, {0, 0, 1}), {60, -40}, 600));
}

// A plan that was edited meanwhile leaves the user's view as it is.
void PostopPage::follow_plan(const widgets::Ui& ui) {
  const bool looks_anew = std::exchange(scene_is_stale_, false);
  const bool is_edited = std::exchange(scene_is_of_, model_->revision()) != model_->revision();
  if (looks_anew || is_edited) {
    show_scene();
    const auto tunnel = model_->tunnel(chosen_);
    scene_words_ = tunnel ? files::format("%.2f %.2f %.2f along %.3f %.3f %.3f", tunnel->entry_mm.x(),
                                          tunnel->entry_mm.y(), tunnel->entry_mm.z(), tunnel->direction.x(),
                                          tunnel->direction.y(), tunnel->direction.z())
                          : "no plan";
  }
  if (looks_anew) look_at_chosen();
  ui.log.note_state("postop_planned", scene_words_);
}

void PostopPage::draw(const widgets::Ui& ui, widgets::Rect area) {
  take_ended();
  ui.log.note_state("postop", is_running() && run_->is_stopping()                              ? "stopping"
                              : is_running()                                                   ? "running"
                              : search_.is_open                                                ? "browses"
                              : !which_.empty()                                                ? "asks"
                              : !problem_.empty()                                              ? "failed"
                              : !shown_.other_patient.empty() || !shown_.not_its_bones.empty() ? "refused"
                              : !better_kept_.empty()                                          ? "better kept"
                              : shown_.answer != nullptr                                       ? "compared"
                              : shown_.comparisons.empty()                                     ? "none"
                                                                                               : "kept");
  const float gap = ui.theme.px(12);
  // A reason takes two lines, and none of it is cut.
  const bool says_why = !problem_.empty() || !shown_.other_patient.empty() || !shown_.not_its_bones.empty() ||
                        !better_kept_.empty();
  draw_head(ui, area.cut_top(ui.theme.px(says_why ? 236 : 176), gap));
  if (search_.is_open) return draw_browser(ui, area);
  if (!which_.empty()) return draw_question(ui, area);
  if (shown_.comparisons.empty() || !model_->has_bone(chosen_.bone)) {
    widgets::text_centered(ui, area, ui.theme.title, widgets::kQuietText,
                           is_running()
                               ? (run_->is_stopping() ? "Stopping ..." : run_->progress().what)
                               : "Drop the folder of the CT after the operation here, or press O to look "
                                 "for it.");
    return;
  }
  follow_plan(ui);
  draw_table(ui, area.cut_right(ui.theme.px(520), gap));
  const widgets::Rect scene = area.cut_left((area.width - gap) / 2, gap);
  pane_.draw(ui, "review.postop_view", scene);
  std::string name = tunnels::name_of(chosen_);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  widgets::caption(ui, scene, widgets::kText, name + ". Blue: planned. Banded: achieved");
  draw_slice(ui, area.cut_top((area.height - gap) / 2, gap), 0);
  draw_slice(ui, area, 1);
}

void PostopPage::draw_head(const widgets::Ui& ui, widgets::Rect area) {
  widgets::begin_panel(ui, "review.postop_head", area, "Planned against achieved");
  for (const char* action :
       {"review.find_ct", "review.postop", "review.postop_stop", "review.postop_next", "review.achieved"}) {
    widgets::action_button(ui, action);
    ImGui::SameLine();
  }
  if (may_replace_kept()) widgets::action_button(ui, "review.postop_replace");
  ImGui::NewLine();
  if (field_.is_open) {
    if (field_.takes_focus) ImGui::SetKeyboardFocusHere();
    field_.takes_focus = false;
    ImGui::SetNextItemWidth(-1);
    const bool is_entered =
        ImGui::InputTextWithHint("##postop", "Folder or file of the CT; Enter compares, Esc does not",
                                 &field_.text, ImGuiInputTextFlags_EnterReturnsTrue);
    ui.log.note("review.postop_path", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    if (is_entered) {
      field_.is_open = false;
      compare_with(field_.text);
    } else if (ImGui::IsItemDeactivated()) {
      field_.is_open = false;
    }
  } else if (is_running()) {
    const PostopProgress progress = run_->progress();
    ImGui::ProgressBar(static_cast<float>(progress.share), {-1, 0},
                       run_->is_stopping() ? "Stopping ..." : progress.what.c_str());
  } else if (!problem_.empty()) {
    widgets::status_row(ui, widgets::Severity::Bad, "Not compared", problem_);
  } else if (!shown_.other_patient.empty()) {
    widgets::status_row(
        ui, widgets::Severity::Bad, "Another patient",
        "these images say that they are of " + shown_.other_patient + "; nothing of them is kept or shown");
  } else if (!shown_.not_its_bones.empty()) {
    widgets::status_row(ui, widgets::Severity::Bad, "Not the plan's bones",
                        "they are not surely in these images (" + shown_.not_its_bones +
                            "); nothing of them is kept or shown");
  } else if (!better_kept_.empty()) {
    widgets::status_row(ui, widgets::Severity::Caution, "Kept from before", better_kept_);
  } else if (!read_only_.empty() && shown_.answer != nullptr) {
    widgets::status_row(ui, widgets::Severity::Caution, "Not kept", read_only_);
  } else if (shown_.answer != nullptr) {
    widgets::text_in(ui.theme.body, widgets::kQuietText, "Of " + source_.string());
  }
  widgets::end_panel();
}

void PostopPage::draw_browser(const widgets::Ui& ui, widgets::Rect area) {
  widgets::draw_buttons(ui, area.cut_bottom(ui.theme.px(56), ui.theme.px(12)),
                        {"review.folder_open", "review.folder_up", "review.folder_home", "review.folder_take",
                         "review.folder_back"});
  if (const auto found =
          search_.folders.draw(ui, area, "Where is the CT after the operation?", "Compare this folder"))
    compare_with(*found);
}

void PostopPage::draw_question(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "review.postop_question", area,
                       "Several CTs are there: which one is to be compared?");
  std::string chosen;
  for (std::size_t i = 0; i < which_.size(); ++i) {
    const images::ImageSeries& series = which_[i];
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Button(images::title_of(series).c_str(), {-1, 0})) chosen = series.uid;
    ImGui::PopID();
    ui.log.note("review.postop_series_" + std::to_string(i), ImGui::GetItemRectMin(),
                ImGui::GetItemRectMax());
    widgets::text_in(ui.theme.body, widgets::kQuietText, images::detail_of(series));
    for (const std::string& warning : series.warnings)
      widgets::text_in(ui.theme.body, widgets::kCaution, "- " + warning);
  }
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   "The finest slices stand first. A sharp (bone) kernel tells a tunnel's wall best.");
  widgets::end_panel();
  if (!chosen.empty()) compare_with(std::filesystem::path(source_), chosen);
}

void PostopPage::draw_table(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "review.postop_table", area, "");
  const PostopStanding standing = standing_of(shown_, is_running(), !problem_.empty());
  const bool is_earlier = is_of_earlier_images(standing);
  const std::string words = in_words(standing);
  ui.log.note_state("postop_standing", words);
  if (!words.empty())
    widgets::text_in(ui.theme.strong, is_earlier ? widgets::kCaution : widgets::kQuietText, words);
  std::map<tunnels::TunnelKey, double> lengths;
  for (const auto& [key, tunnel] : planned()) lengths[key] = model_->measured(key).length_mm;
  for (const AchievedRow& row : achieved_rows(shown_.comparisons, planned(), lengths, places())) {
    const bool is_good = row.severity == widgets::Severity::Good;
    widgets::status_row(ui, is_good && is_earlier ? widgets::Severity::Caution : row.severity, row.tunnel,
                        row.verdict);
    for (const auto& [name, value] :
         {std::pair("Offset of the entry", &row.offset), std::pair("Grid", &row.grid),
          std::pair("Angle", &row.angle), std::pair("Diameter", &row.diameter),
          std::pair("Length", &row.length), std::pair("Least wall", &row.wall)})
      if (!value->empty() && row.severity != widgets::Severity::Bad)
        widgets::text_in(ui.theme.body, widgets::kText, std::string(name) + ": " + *value);
    for (const std::string& reason : row.reasons)
      widgets::text_in(ui.theme.body, widgets::kCaution, "- " + reason);
    ui.log.note_state("postop_" + row.tunnel, row.verdict + "; " + row.offset);
    ImGui::Separator();
  }
  if (const postop::Comparison* comparison = chosen()) {
    widgets::text_in(ui.theme.strong, widgets::kText, "How far it may be off");
    const Eigen::Vector3d voxel_mm =
        shown_.answer != nullptr ? shown_.answer->images.spacing_mm() : Eigen::Vector3d::Zero().eval();
    const auto place = places().find(chosen_);
    for (const std::string& line :
         error_budget(*comparison, place != places().end() ? &place->second : nullptr, voxel_mm))
      widgets::text_in(ui.theme.body, widgets::kQuietText, line);
  }
  widgets::end_panel();
}

void PostopPage::draw_slice(const widgets::Ui& ui, const widgets::Rect& area, int quarter_turns) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(area.min(), area.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  const auto plan = model_->tunnel(chosen_);
  const postop::Comparison* const comparison = chosen();
  if (!plan || comparison == nullptr) return;
  const widgets::Rect at = widgets::fitted(area, 1);
  const double length_mm = model_->drawn_length_mm(chosen_);
  const Eigen::Vector2i size{kSlice_px, kSlice_px};
  const scene::SlicePlane plane = plane_along(*plan, length_mm, quarter_turns, (length_mm + 24) / kSlice_px);
  Slice& slice = slices_.at(static_cast<std::size_t>(quarter_turns));
  if (no_picture_words(shown_, *comparison).empty()) {
    const geometry::RigidTransform postop_from_plan = comparison->bone.plan_from_postop.inverse();
    scene::SlicePlane in_images = plane;
    in_images.center_mm = postop_from_plan * plane.center_mm;
    in_images.right = postop_from_plan.rotation * plane.right;
    in_images.down = postop_from_plan.rotation * plane.down;
    if (slice.texture.texture() == 0 || slice.plane != in_images) {
      scene::reslice(shown_.answer->images, in_images, size, scene::kBoneWindow, slice.grey);
      slice.texture.upload(kSlice_px, kSlice_px, slice.grey);
      slice.plane = in_images;
    }
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(slice.texture.texture())),
                  at.min(), at.max());
  }
  // The lines alone must not look like a picture of which nothing is to be seen.
  const std::string lacking = no_picture_words(shown_, *comparison);
  ui.log.note_state("postop_picture_" + std::to_string(quarter_turns), lacking.empty() ? "shown" : lacking);
  const float scale = at.width / kSlice_px;
  const auto on_screen = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector2d pixel = plane.pixel_of(point, size);
    return ImVec2{at.x + (static_cast<float>(pixel.x()) + 0.5F) * scale,
                  at.y + (static_cast<float>(pixel.y()) + 0.5F) * scale};
  };
  draw.PushClipRect(at.min(), at.max(), true);
  for (const auto& [a, b] :
       scene::outline_of(*model_->drawn_mesh(chosen_.bone), plane.center_mm, plane.normal()))
    draw.AddLine(on_screen(a), on_screen(b), IM_COL32(222, 209, 186, 200), ui.theme.px(1.5F));
  // The wall of a tunnel as the plane sees it: its axis laid into the plane, a radius to either side.
  const auto draw_tunnel = [&](const tunnels::Tunnel& tunnel, double of_length_mm, ImU32 color) {
    const Eigen::Vector3d ahead = tunnel.direction.normalized();
    const Eigen::Vector3d across = plane.normal().cross(ahead).normalized() * tunnel.diameter_mm / 2;
    const Eigen::Vector3d exit = tunnel.entry_mm + of_length_mm * ahead;
    for (const double side : {-1.0, 1.0})
      draw.AddLine(on_screen(tunnel.entry_mm + side * across), on_screen(exit + side * across), color,
                   ui.theme.px(2.5F));
    draw.AddLine(on_screen(tunnel.entry_mm - across), on_screen(tunnel.entry_mm + across), color,
                 ui.theme.px(2.5F));
    draw.AddLine(on_screen(tunnel.entry_mm), on_screen(exit), color, ui.theme.px(1));
  };
  draw_tunnel(*plan, length_mm, IM_COL32(86, 180, 233, 255));
  if (comparison->tunnel.is_found)
    draw_tunnel(comparison->tunnel.tunnel, comparison->tunnel.length_mm, IM_COL32(230, 159, 0, 255));
  draw.PopClipRect();
  draw_side_letters(ui, at, plane);
  if (!lacking.empty()) {
    widgets::Rect below = area;
    widgets::text_centered(ui, below.cut_bottom(area.height / 3), ui.theme.strong, widgets::kCaution,
                           lacking);
  }
  widgets::caption(ui, area, widgets::kText,
                   quarter_turns == 0 ? "Along the planned axis" : "The same, turned by 90\u00B0");
  ui.log.note("review.postop_slice_" + std::to_string(quarter_turns), area.min(), area.max());
}

}  // namespace arthronaut::review
