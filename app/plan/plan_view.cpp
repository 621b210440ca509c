#include "app/plan/plan_view.h"

#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/case/case_opening.h"
#include "app/plan/tunnel_moves.h"
#include "app/scene/grid_lines.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;

constexpr double kAimHandleBeyond_mm = 12;
constexpr scene::Color kFootprintColor{0.25F, 0.85F, 0.65F};
constexpr scene::Color kBesideColor{0.62F, 0.70F, 0.76F};  // the bone's tunnel that is not worked on

const char* name_of(open_case::PlanStatus::Save save) {
  switch (save) {
    case open_case::PlanStatus::Save::Saved:
      return "saved";
    case open_case::PlanStatus::Save::NotYet:
      return "moving";
    case open_case::PlanStatus::Save::Failed:
      return "failed";
    case open_case::PlanStatus::Save::ReadOnly:
      return "read-only";
    case open_case::PlanStatus::Save::Conflict:
      return "conflict";
  }
  return "";
}

// From left to right in as many rows as the area is wide enough for; they are cut off it.
void draw_button_rows(const widgets::Ui& ui, widgets::Rect& area, std::initializer_list<const char*> ids) {
  const float height = ui.theme.px(44), gap = ui.theme.px(8);
  widgets::Rect row = area.cut_top(height, ui.theme.px(9));
  for (const char* id : ids) {
    const float width = widgets::action_button_width(ui, id);
    if (width > row.width && row.x > area.x) row = area.cut_top(height, ui.theme.px(9));
    ImGui::SetCursorScreenPos(row.cut_left(width, gap).min());
    widgets::action_button(ui, id, width);
  }
}

}  // namespace

PlanView::PlanView(std::function<void()> make_current, const std::function<void()>& wake,
                   std::function<void()> paint, std::function<std::vector<std::string>(bones::Side)> say_side)
    : paint_(std::move(paint)),
      say_side_(std::move(say_side)),
      bones_(std::move(make_current)),
      slices_(wake),
      volume_(wake),
      survey_(wake),
      isometry_(wake),
      export_(wake),
      defaults_(wake),
      tour_defaults_(wake),
      landmark_drawing_(wake) {}

mode::ModeTitle PlanView::title() const {
  return {"plan", "mode.plan", "Plan", "Place the tunnels", GLFW_KEY_F1};
}

void PlanView::case_opened(const mode::OpenCase& opened) {
  defaults_.cancel();
  tour_defaults_.cancel();
  model_ = opened.model;
  history_.open(opened.model, opened.folder, opened.read_only);
  case_folder_ = opened.folder;
  std::error_code error;
  tour_.case_opened(opened.read_only.empty() &&
                    std::filesystem::equivalent(opened.folder, open_case::built_in_case_folder(), error));
  state_ = {};
  version_field_.close();
  tunnel_meshes_.clear();
  work_on(key_in(model_->has_bone(BoneKind::Femur) ? BoneKind::Femur : BoneKind::Tibia));
  bones_.open(model_);
  slices_.open(model_->knee(), opened.folder, model_->joint_bounds(std::nullopt));
  volume_.open(model_->joint_bounds(std::nullopt));
  lateral_.open(model_);
  load_versions();
  load_bone_doubts();
  take_side_news();
}

bool PlanView::awaits_shape() const {
  return model_ != nullptr && std::ranges::any_of(model_->tunnels(), [this](const auto& one) {
           return !model_->proposal(one.first.bone);
         });
}

void PlanView::tick(double now_s) {
  history_.settle(now_s, state_.is_held);
  history_.look_at_disk(now_s);
  follow_plan();
  follow_defaults();
  if (const auto exported = export_.take_outcome())
    state_.hint = {exported->in_words(model_->revision()),
                   exported->was_stopped ||
                       (exported->is_written && exported->doubts.empty() && exported->wrong.empty()),
                   model_->revision()};  // beside another plan it would be of that
  if (volume_.is_on()) slices_.want();
  slices_.tick();
  if (model_ != nullptr && state_.page == PanelPage::Landmarks) landmark_drawing_.follow(model_->knee().side);
  volume_.follow(slices_.shared_volume());
  bones_.show_volume(volume_.item());
}

void PlanView::look_from(scene::ViewDirection view) {
  bones_.look_from(view);
  state_.shows_lateral = false;
  if (bones_.only() && *bones_.only() != state_.key.bone) work_on_bone(*bones_.only());
  state_.shown_revision = 0;
}

void PlanView::change(const std::string& what, bool continues, const std::optional<tunnels::Tunnel>& tunnel) {
  if (!tunnel) return;
  history_.apply({state_.key, tunnel, what + " " + adjective(state_.key) + " tunnel", continues},
                 widgets::GraphicsWindow::now_s());
}

void PlanView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  const open_case::PlanStatus& status = history_.status();
  widgets::Rect rest = area;
  const widgets::Rect panel = rest.cut_right(ui.theme.px(470), ui.theme.px(12));
  const auto row = [&](std::initializer_list<const char*> ids) { draw_button_rows(ui, rest, ids); };
  row({"plan.anterior", "plan.posterior", "plan.medial", "plan.lateral", "plan.distal", "plan.notch",
       "plan.plateau", "plan.see_through"});
  if (volume_.is_on())
    row({"plan.grid", "plan.map", "plan.isometry", "plan.aims", "plan.xray", "plan.volume",
         "plan.volume_less", "plan.volume_more", "plan.slices", "plan.paint"});
  else
    row({"plan.grid", "plan.map", "plan.isometry", "plan.aims", "plan.xray", "plan.volume", "plan.slices",
         "plan.paint"});
  if (state_.shows_slices)
    row({"plan.along", "plan.window", "plan.fit", "plan.cross_to_entry", "plan.cross_to_thinnest",
         "plan.distance", "plan.angle", "plan.unmeasure"});
  follow_tour();
  const std::optional<TourCard> card = tour_.card();
  if (card) draw_tour(ui, rest.cut_top(ui.theme.px(88), ui.theme.px(10)), *card);
  ui.log.note_state("tour", card ? std::to_string(card->number) + " " + card->title : "");
  ui.log.note_state("asks_side", state_.asks_side ? "asks" : "");
  if (state_.asks_side) draw_side(ui, rest.cut_top(ui.theme.px(116), ui.theme.px(10)));
  if (history_.is_in_conflict()) draw_conflict(ui, rest.cut_top(ui.theme.px(96), ui.theme.px(10)));
  if (state_.shows_slices) {
    const float gap = ui.theme.px(6);
    widgets::Rect left = rest.cut_left((rest.width - gap) / 2, gap);
    const widgets::Rect bones = left.cut_top((left.height - gap) / 2, gap);
    const widgets::Rect axial = rest.cut_top((rest.height - gap) / 2, gap);
    draw_bones(ui, bones);
    draw_slices(ui, {axial, left, rest});
    if (slices_.volume() != nullptr) draw_keyed_pane(ui, {bones, axial, left, rest});
  } else {
    draw_bones(ui, rest);
  }
  std::size_t doubt_count = 0;
  for (const auto& [bone, doubts] : bone_doubts_)
    doubt_count += plan_review::doubts_but_side(bone_doubts_, bone).size();
  const StepState step{
      .key = state_.key,
      .places_entry = state_.placing == Placing::Entry,
      .shows_landmarks = state_.page == PanelPage::Landmarks,
      .is_read_only = status.save == open_case::PlanStatus::Save::ReadOnly,
      .is_in_conflict = history_.is_in_conflict(),
      .makes_default = defaults_.is_running(),
      .is_unsaved = status.save == open_case::PlanStatus::Save::Failed,
      .can_enter_elsewhere = std::ranges::any_of(
          state_.made, [this](const MadeTunnel& one) { return one.key == state_.key && can_be_moved(one); }),
      .side_doubt = plan_review::side_doubt(bone_doubts_),
      .bone_doubts = doubt_count};
  const NextStep next = next_step(*model_, step);
  const PanelClick clicked =
      draw_plan_panel(ui, panel,
                      {*model_, history_, state_.key, state_.page, state_.landmark, versions_,
                       chosen_version(), version_field_, landmark_drawing_, bone_doubts_, next});
  if (clicked.step) history_.go_to(*clicked.step);
  if (clicked.landmark) select_landmark(*clicked.landmark);
  if (clicked.version) take_version(*clicked.version);
  if (clicked.named) name_version(*clicked.named);
  if (clicked.words) say_of_version(clicked.words->number, clicked.words->words);
  ui.log.note_state("landmark", state_.page == PanelPage::Landmarks ? landmark() : "");
  ui.log.note_state("landmarks", confirmed_in_words(landmark_rows(*model_, state_.key.bone)));
  ui.log.note_state("plan_next", next.text);
  ui.log.note_state("plan", name_of(status.save));
  ui.log.note_state("theirs", history_.theirs_in_words());
  ui.log.note_state("undo", status.undo_what);
  ui.log.note_state("redo", status.redo_what);
  ui.log.note_state("placing", state_.placing == Placing::Entry      ? "entry"
                               : state_.placing == Placing::Landmark ? "landmark"
                                                                     : "nothing");
  ui.log.note_state("hint", state_.hint.text);
  ui.log.note_state("keyed_pane", std::to_string(state_.keyed_pane));
  ui.log.note_state("version_row", state_.page == PanelPage::Steps && !versions_.empty()
                                       ? std::to_string(versions_[chosen_version()].version.number)
                                       : "");
  ui.log.note_state("volume", volume_.in_words(slices_.reason()));
  const auto& from = bones_.looked_from();
  ui.log.note_state("view_direction", state_.shows_lateral         ? "the radiograph"
                                      : !from                      ? "a landmark"
                                      : bones_.is_seen_from(*from) ? scene::to_text(*from)
                                                                   : "turned by hand");
  ui.log.note_state("tunnel", tunnels::name_of(state_.key));
  const auto tunnel = model_->tunnel(state_.key);
  ui.log.note_state("diameter_mm", tunnel ? widgets::fixed(tunnel->diameter_mm, 2) : "");
}

void PlanView::show_content() {
  scene::SceneContent content;
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    if (!model_->has_bone(kind) || !bones_.shows(kind)) continue;
    for (const tunnels::TunnelKey& key : model_->knee().plan.of(kind)) {
      const tunnels::Tunnel tunnel = *model_->tunnel(key);
      const bool is_beside = kind == state_.key.bone && key != state_.key;
      scene::add_planned_tunnel(content, tunnel, model_->drawn_length_mm(key),
                                is_beside ? kBesideColor : scene::kPlanColor);
      if (key == state_.key && state_.shows_aims && state_.survey != nullptr)
        add_aims(content, *state_.survey, tunnel, model_->drawn_length_mm(key));
    }
    if (!state_.shows_grid) continue;
    const std::vector<norms::Bundle> bundles = bundles_shown(kind);
    for (const norms::Bundle bundle : bundles) {
      const norms::ExpectedFootprint* footprint = model_->footprint({kind, bundle});
      if (footprint == nullptr) continue;
      content.lines.push_back({footprint->outline_mm, 0.9, true, kFootprintColor, true});
      content.lines.push_back({footprint->spread_mm, 0.4, true, kFootprintColor, true});
    }
    // In the views that face them: edge-on a grid is a line through the bone.
    const std::optional<scene::ViewDirection> view = bones_.looked_from();
    const bool is_sagittal = view == scene::ViewDirection::Medial || view == scene::ViewDirection::Lateral ||
                             view == scene::ViewDirection::Notch;
    const auto add_grid = [&](const auto& grid) {
      std::vector<scene::NormEllipse> norms;
      for (const norms::Bundle bundle : bundles) norms.push_back(scene::norm_ellipse(grid, bundle));
      scene::add_grid(content, scene::grid_lines(grid), norms);
    };
    if (const auto& quadrant = model_->surroundings(kind).quadrant; quadrant && is_sagittal)
      add_grid(*quadrant);
    if (const auto& plateau = model_->surroundings(kind).plateau;
        plateau && view == scene::ViewDirection::Plateau)
      add_grid(*plateau);
  }
  if (state_.isometry != nullptr && bones_.shows(BoneKind::Femur)) content.bones = state_.isometry->items;
  bones_.set_content(std::move(content));
  state_.shown_revision = model_->revision();
}

void PlanView::draw_bones(const widgets::Ui& ui, const widgets::Rect& area) {
  if (state_.shows_lateral) {
    const bool on_landmarks = state_.page == PanelPage::Landmarks;
    lateral_.draw(ui, area, {state_.key.bone, on_landmarks, on_landmarks ? landmark() : ""});
    widgets::Rect rest = area;
    rest.cut_top(ui.theme.px(130));  // below its caption, which has a line for each bundle
    return draw_hint(ui, rest, {});
  }
  if (auto survey = wanted_survey(); survey != state_.survey) {
    state_.survey = std::move(survey);
    state_.shown_revision = 0;
  }
  follow_isometry();
  if (state_.shown_revision != model_->revision()) show_content();
  std::vector<PaneMark> shown = marks();
  // A click places, also where a handle is: one that took it would be another landmark, or nothing. Of a case
  // that may only be looked at nothing is dragged.
  if (state_.placing != Placing::Nothing || history_.is_read_only())
    for (PaneMark& mark : shown) mark.can_be_dragged = false;
  const PaneEvent event = bones_.draw(ui, area, shown);
  draw_aiming_cross(ui, area);
  say_isometry_at(ui, event.hover);
  follow(event);
  draw_hint(ui, draw_survey_legend(ui, area), bones_.handles_on_screen(area, shown));
}

// What is said of a norm where the mouse stands on it.
void PlanView::add_norm_marks(std::vector<PaneMark>& marks) const {
  const BoneKind kind = state_.key.bone;
  for (const norms::Bundle bundle : bundles_shown(kind)) {
    const norms::ExpectedFootprint* footprint = model_->footprint({kind, bundle});
    if (footprint == nullptr) continue;
    const bool is_whole = bundle == norms::Bundle::Whole;
    const auto& surroundings = model_->surroundings(kind);
    marks.push_back(
        {PaneMark::Shape::Cross, is_whole ? "footprint" : "footprint_" + std::string(norms::to_text(bundle)),
         "", footprint->center_mm, widgets::color_of(kFootprintColor), false,
         "Green: the expected footprint" +
             std::string(is_whole                                ? ""
                         : bundle == norms::Bundle::Anteromedial ? " of the AM bundle"
                                                                 : " of the PL bundle") +
             ", and where its centre lies in two knees of three: " + norms::cited(footprint->norm) +
             ".\nYellow, in the grid: " +
             (surroundings.quadrant ? scene::norm_ellipse(*surroundings.quadrant, bundle)
                                    : scene::norm_ellipse(*surroundings.plateau, bundle))
                 .words,
         // Over the map of lengths the mouse asks that.
         is_isometry_wanted() ? std::vector<Eigen::Vector3d>{} : footprint->outline_mm});
  }
}

std::optional<Eigen::Vector3d> PlanView::aim_handle() const {
  const auto tunnel = model_->tunnel(state_.key);
  if (!tunnel || state_.held_aim_mm) return state_.held_aim_mm;
  return tunnel->entry_mm + (model_->drawn_length_mm(state_.key) + kAimHandleBeyond_mm) * tunnel->direction;
}

std::optional<SliceMark> PlanView::thinnest_wall() const {
  if (!model_->tunnel(state_.key)) return std::nullopt;
  const tunnels::TunnelGeometry& measured = model_->measured(state_.key);
  const auto& checks = model_->checks(state_.key);
  const auto wall = std::ranges::find(checks, "Wall", &tunnels::PlanCheck::name);
  if (!measured.enters_bone || wall == checks.end()) return std::nullopt;
  return SliceMark{widgets::fixed(measured.wall_mm, 1) + " mm", measured.thinnest_mm,
                   widgets::color_of(severity_of(wall->verdict))};
}

std::vector<PaneMark> PlanView::marks() const {
  std::vector<PaneMark> marks;
  if (!bones_.shows(state_.key.bone) || !model_->has_bone(state_.key.bone)) return marks;
  if (state_.page == PanelPage::Landmarks) {
    add_landmark_marks(marks);
    return marks;
  }
  if (state_.shows_grid) add_norm_marks(marks);
  add_map_marks(marks);
  add_isometry_marks(marks);
  const auto tunnel = model_->tunnel(state_.key);
  if (!tunnel) return marks;
  const tunnels::TunnelGeometry& measured = model_->measured(state_.key);
  if (measured.enters_bone) {
    if (const auto wall = thinnest_wall())
      marks.push_back({PaneMark::Shape::Pin, "thinnest", wall->word, wall->point_mm, wall->color, false,
                       "Here the wall of the tunnel is thinnest"});
    marks.push_back({PaneMark::Shape::Pin, "exit", "Exit", measured.exit_mm, widgets::kText, false,
                     "Here the drill leaves the bone"});
  }
  if (const auto key = other_bundle(state_.key))
    if (const auto beside = model_->tunnel(*key))
      marks.push_back({PaneMark::Shape::Ring, "other_entry", entry_label(*key), beside->entry_mm,
                       widgets::kQuietText, false, "The other bundle's entry: press B to work on it"});
  marks.push_back({PaneMark::Shape::Ring, "entry", entry_label(state_.key), tunnel->entry_mm, widgets::kText,
                   true, "The entry: drag it over the bone"});
  marks.push_back({PaneMark::Shape::Diamond, "aim", "Aim", *aim_handle(),
                   widgets::color_of(scene::kPlanColor), true,
                   "The aim: drag it to turn the tunnel about its entry"});
  return marks;
}

void PlanView::follow(const PaneEvent& event) {
  if (!model_->has_bone(state_.key.bone)) return;
  if (!event.pressed.empty()) state_.has_dragged = false;
  state_.is_held = !event.dragged.empty();
  const auto tunnel = model_->tunnel(state_.key);
  if (tunnel && event.dragged == "entry") {
    const auto to = dragged_over(bones_.visible(), state_.key.bone, tunnel->entry_mm, event.drag_ray,
                                 bones_.is_see_through());
    if (to) change("Drag the entry of the", state_.has_dragged, with_entry_at(*tunnel, *to));
    state_.has_dragged = state_.has_dragged || to.has_value();
  }
  if (tunnel && event.dragged == "aim") {
    state_.held_aim_mm = moved_in_view(bones_.camera(), event.drag_ray, *aim_handle());
    if (state_.held_aim_mm)
      change("Drag the aim of the", state_.has_dragged, aimed_at(*tunnel, *state_.held_aim_mm));
    state_.has_dragged = true;
  } else {
    state_.held_aim_mm.reset();
  }
  if (state_.page == PanelPage::Landmarks) follow_landmark(event);
  if (!event.click) return;
  if (state_.placing == Placing::Landmark)
    place_landmark(*event.click);
  else if (state_.placing == Placing::Entry)
    place_entry(*event.click);
  else if (const auto met = first_visible(bones_.visible(), *event.click))
    slices_.set_cross(met->point_mm);
}

}  // namespace arthronaut::plan
