#include "app/plan/plan_view.h"

#include <GLFW/glfw3.h>

#include <array>

#include "app/plan/tunnel_moves.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;

constexpr double kHandleReach_px = 22;
constexpr double kAimHandleBeyond_mm = 12;

std::string tunnel_name(BoneKind bone) { return bone == BoneKind::Femur ? "femoral" : "tibial"; }

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
  }
  return "";
}

std::optional<BoneKind> only_bone_of(scene::ViewDirection view) {
  if (view == scene::ViewDirection::Distal || view == scene::ViewDirection::Notch) return BoneKind::Femur;
  if (view == scene::ViewDirection::Plateau) return BoneKind::Tibia;
  return std::nullopt;
}

}  // namespace

PlanView::PlanView(std::function<void()> make_current) : pane_(std::move(make_current)) {}

mode::ModeTitle PlanView::title() const {
  return {"plan", "mode.plan", "Plan", "Place the tunnels", GLFW_KEY_F1};
}

void PlanView::case_opened(const mode::OpenCase& opened) {
  model_ = opened.model;
  history_.open(opened.model, opened.folder, opened.read_only);
  state_ = {};
  if (!model_->has_bone(BoneKind::Femur)) state_.bone = BoneKind::Tibia;
  look_from(scene::ViewDirection::Anterior);
}

void PlanView::look_from(scene::ViewDirection view) {
  state_.looked_from = view;
  state_.only = only_bone_of(view);
  if (state_.only && !model_->has_bone(*state_.only)) state_.only.reset();
  if (state_.only) state_.bone = *state_.only;
  pane_.look(scene::look_from(view, model_->knee().side, model_->bounds(state_.only), state_.aspect));
  state_.shown_revision = 0;
}

void PlanView::change(const std::string& what, bool continues, const std::optional<tunnels::Tunnel>& tunnel) {
  if (!tunnel) return;
  history_.apply({state_.bone, tunnel, what + " " + tunnel_name(state_.bone) + " tunnel", continues},
                 widgets::GraphicsWindow::now_s());
}

void PlanView::add_actions(widgets::Actions& actions) {
  add_view_actions(actions);
  add_tunnel_actions(actions);
  add_history_actions(actions);
  actions.add({"plan.bone",
               "Other bone",
               "Plan the tunnel of the other bone",
               GLFW_KEY_TAB,
               0,
               false,
               [this] {
                 const BoneKind other = state_.bone == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur;
                 return model_ != nullptr && model_->has_bone(other);
               },
               {},
               [this] {
                 state_.bone = state_.bone == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur;
                 if (state_.only) look_from(scene::ViewDirection::Anterior);
                 state_.shown_revision = 0;
               }});
}

// Each key makes a new tunnel of the one that is there.
void PlanView::add_tunnel_actions(widgets::Actions& actions) {
  const auto has_tunnel = [this] { return model_ != nullptr && model_->tunnel(state_.bone).has_value(); };
  const auto add = [&](const std::string& id, const std::string& label, const char* tooltip, int key,
                       int mods, const char* what, auto moved) {
    actions.add({id, label, tooltip, key, mods, true, has_tunnel, {}, [this, what, moved] {
                   change(what, true, moved(*model_->tunnel(state_.bone)));
                 }});
  };
  actions.add({"plan.place", "Place entry", "Then click where the tunnel is to begin on the bone", GLFW_KEY_P,
               0, false, [this] { return model_ != nullptr; }, [this] { return state_.places_entry; },
               [this] { state_.places_entry = !state_.places_entry; }});
  add("plan.wider", "Wider", "Half a millimetre more", GLFW_KEY_EQUAL, 0, "Change the diameter of the",
      [](const tunnels::Tunnel& t) { return with_diameter(t, t.diameter_mm + 0.5); });
  add("plan.narrower", "Narrower", "Half a millimetre less", GLFW_KEY_MINUS, 0, "Change the diameter of the",
      [](const tunnels::Tunnel& t) { return with_diameter(t, t.diameter_mm - 0.5); });
  struct Arrow {
    std::string word;
    int key;
    Eigen::Vector2d right_up;
  };
  const std::array<Arrow, 4> arrows{Arrow{"left", GLFW_KEY_LEFT, {-1, 0}},
                                    Arrow{"right", GLFW_KEY_RIGHT, {1, 0}}, Arrow{"up", GLFW_KEY_UP, {0, 1}},
                                    Arrow{"down", GLFW_KEY_DOWN, {0, -1}}};
  for (const Arrow& arrow : arrows) {
    add("plan.aim_" + arrow.word, "Aim " + arrow.word, "The far end of the tunnel moves that way by 1 degree",
        arrow.key, 0, "Aim the",
        [this, way = arrow.right_up](const tunnels::Tunnel& t) { return turned(t, pane_.camera(), way); });
    add("plan.slide_" + arrow.word, "Slide entry " + arrow.word,
        "The entry moves over the bone by half a millimetre", arrow.key, GLFW_MOD_SHIFT,
        "Move the entry of the", [this, way = arrow.right_up](const tunnels::Tunnel& t) {
          return with_entry_slid(t, pane_.camera(), 0.5 * way, model_->surface(state_.bone));
        });
  }
  actions.add({"plan.remove",
               "Remove tunnel",
               "Undo brings it back",
               GLFW_KEY_DELETE,
               0,
               false,
               has_tunnel,
               {},
               [this] {
                 history_.apply(
                     {state_.bone, std::nullopt, "Remove the " + tunnel_name(state_.bone) + " tunnel", false},
                     widgets::GraphicsWindow::now_s());
               }});
}

void PlanView::add_history_actions(widgets::Actions& actions) {
  actions.add({"plan.undo",
               "Undo",
               "Takes the last change of the plan back",
               GLFW_KEY_Z,
               GLFW_MOD_CONTROL,
               true,
               [this] { return history_.can_undo(); },
               {},
               [this] { history_.undo(); }});
  actions.add({"plan.redo",
               "Redo",
               "Does it again",
               GLFW_KEY_Y,
               GLFW_MOD_CONTROL,
               true,
               [this] { return history_.can_redo(); },
               {},
               [this] { history_.redo(); }});
}

void PlanView::add_view_actions(widgets::Actions& actions) {
  struct Side {
    const char *id, *label;
    int key;
    scene::ViewDirection view;
  };
  const std::array<Side, 7> sides{
      Side{"plan.anterior", "Anterior", GLFW_KEY_1, scene::ViewDirection::Anterior},
      Side{"plan.posterior", "Posterior", GLFW_KEY_2, scene::ViewDirection::Posterior},
      Side{"plan.medial", "Medial", GLFW_KEY_3, scene::ViewDirection::Medial},
      Side{"plan.lateral", "Lateral", GLFW_KEY_4, scene::ViewDirection::Lateral},
      Side{"plan.distal", "Distal", GLFW_KEY_5, scene::ViewDirection::Distal},
      Side{"plan.notch", "Notch", GLFW_KEY_6, scene::ViewDirection::Notch},
      Side{"plan.plateau", "Plateau", GLFW_KEY_7, scene::ViewDirection::Plateau}};
  for (const Side& side : sides)
    actions.add({side.id, side.label, std::string("Look from ") + side.label, side.key, 0, false,
                 [this, side] {
                   const auto only = only_bone_of(side.view);
                   return model_ != nullptr && (!only || model_->has_bone(*only));
                 },
                 [this, side] { return state_.looked_from == side.view; },
                 [this, side] { look_from(side.view); }});
  actions.add({"plan.see_through",
               "See through",
               "The bone turns translucent",
               GLFW_KEY_T,
               0,
               false,
               {},
               [this] { return state_.see_through; },
               [this] {
                 state_.see_through = !state_.see_through;
                 state_.shown_revision = 0;
               }});
}

void PlanView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  const open_case::PlanStatus& status = history_.status();
  widgets::Rect rest = area;
  const widgets::Rect panel = rest.cut_right(ui.theme.px(470), ui.theme.px(12));
  widgets::Rect views = rest.cut_top(ui.theme.px(44), ui.theme.px(10));
  ImGui::SetCursorScreenPos(views.min());
  for (const char* id : {"plan.anterior", "plan.posterior", "plan.medial", "plan.lateral", "plan.distal",
                         "plan.notch", "plan.plateau", "plan.see_through"}) {
    widgets::action_button(ui, id);
    ImGui::SameLine();
  }
  draw_bones(ui, rest);
  draw_plan_panel(ui, panel, *model_, state_.bone, status);
  ui.log.note_state("plan", name_of(status.save));
  ui.log.note_state("undo", status.undo_what);
  ui.log.note_state("redo", status.redo_what);
}

void PlanView::draw_bones(const widgets::Ui& ui, const widgets::Rect& area) {
  const open_case::PlanModel& model = *model_;
  state_.aspect = area.width / std::max(area.height, 1.F);
  if (state_.shown_revision == 0 || state_.shown_revision != model.revision()) {
    scene::SceneContent content;
    for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
      if (!model.has_bone(kind) || (state_.only && *state_.only != kind)) continue;
      content.bones.push_back({model.drawn_mesh(kind), scene::kBoneColor, state_.see_through ? 0.42 : 1.0});
      if (const auto tunnel = model.tunnel(kind))
        scene::add_planned_tunnel(content, *tunnel, model.drawn_length_mm(kind));
    }
    pane_.show(content);
    state_.shown_revision = model.revision();
  }
  const auto handle_at = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector2d size(area.width, area.height);
    const double reach = kHandleReach_px * ui.theme.scale;
    state_.dragged = Handle::None;
    const auto near = [&](const Eigen::Vector3d& point) {
      const auto at = scene::project(pane_.camera(), point, size);
      return at && (*at - pixel).norm() < reach;
    };
    if (state_.only && *state_.only != state_.bone) return false;
    if (const auto aim = aim_handle(); aim && near(*aim)) state_.dragged = Handle::Aim;
    if (const auto tunnel = model.tunnel(state_.bone); tunnel && near(tunnel->entry_mm))
      state_.dragged = Handle::Entry;
    return state_.dragged != Handle::None;
  };
  const widgets::PaneInput input = pane_.draw(ui, "plan.view", area, handle_at);
  draw_handles(ui, area);
  use_pane_input(input);
}

std::optional<Eigen::Vector3d> PlanView::aim_handle() const {
  const auto tunnel = model_->tunnel(state_.bone);
  if (!tunnel) return std::nullopt;
  return tunnel->entry_mm + (model_->drawn_length_mm(state_.bone) + kAimHandleBeyond_mm) * tunnel->direction;
}

void PlanView::use_pane_input(const widgets::PaneInput& input) {
  if (!model_->has_bone(state_.bone)) return;
  const scene::SceneRay ray = scene::ray_through(pane_.camera(), input.mouse_px, input.size_px);
  if (input.handle_pressed) state_.has_dragged = false;
  const auto tunnel = model_->tunnel(state_.bone);
  if (tunnel && input.handle_dragged && state_.dragged == Handle::Entry) {
    change("Drag the entry of the", state_.has_dragged,
           with_entry_at(*tunnel, ray, model_->surface(state_.bone)));
    state_.has_dragged = true;
  }
  if (tunnel && input.handle_dragged && state_.dragged == Handle::Aim) {
    change("Drag the aim of the", state_.has_dragged, aimed(*tunnel, pane_.camera(), ray, *aim_handle()));
    state_.has_dragged = true;
  }
  if (input.was_clicked && state_.places_entry) {
    change("Place the entry of the", false,
           tunnel ? with_entry_at(*tunnel, ray, model_->surface(state_.bone))
                  : first_tunnel(state_.bone, ray, model_->surface(state_.bone)));
    state_.places_entry = false;
  }
}

void PlanView::draw_handles(const widgets::Ui& ui, const widgets::Rect& area) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(area.min(), area.max(), true);
  const Eigen::Vector2d size(area.width, area.height);
  const auto on_screen = [&](const Eigen::Vector3d& point) -> std::optional<ImVec2> {
    const auto at = scene::project(pane_.camera(), point, size);
    if (!at) return std::nullopt;
    return ImVec2(area.x + static_cast<float>(at->x()), area.y + static_cast<float>(at->y()));
  };
  const auto tunnel = model_->tunnel(state_.bone);
  const bool is_shown = tunnel && (!state_.only || *state_.only == state_.bone);
  const float radius = ui.theme.px(13), line = ui.theme.px(3);
  const auto label = [&](const ImVec2& at, const char* text) {
    const ImVec2 place(at.x + radius * 1.4F, at.y - ui.theme.body->FontSize / 2);
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {place.x + 1, place.y + 1}, widgets::kBackground,
                 text);
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, place, widgets::kText, text);
  };
  if (is_shown) {
    // Entry: a ring with a dot. Aim: a diamond. The shapes differ, not only the places.
    if (const auto at = on_screen(tunnel->entry_mm)) {
      draw.AddCircle(*at, radius, widgets::kText, 32, line);
      draw.AddCircleFilled(*at, radius * 0.3F, widgets::kText);
      label(*at, "Entry");
      ui.log.note("plan.entry_handle", {at->x - radius, at->y - radius}, {at->x + radius, at->y + radius});
    }
    if (const auto at = on_screen(*aim_handle())) {
      draw.AddQuadFilled({at->x, at->y - radius}, {at->x + radius, at->y}, {at->x, at->y + radius},
                         {at->x - radius, at->y}, widgets::color_of(scene::kPlanColor));
      draw.AddQuad({at->x, at->y - radius}, {at->x + radius, at->y}, {at->x, at->y + radius},
                   {at->x - radius, at->y}, widgets::kText, line * 0.7F);
      label(*at, "Aim");
      ui.log.note("plan.aim_handle", {at->x - radius, at->y - radius}, {at->x + radius, at->y + radius});
    }
  }
  if (state_.places_entry)
    draw.AddText(
        ui.theme.title, ui.theme.title->FontSize, {area.x + ui.theme.px(20), area.y + ui.theme.px(16)},
        widgets::kAccent,
        ("Click on the " + std::string(bones::to_text(state_.bone)) + ": the tunnel begins there").c_str());
  draw.PopClipRect();
}

}  // namespace arthronaut::plan
