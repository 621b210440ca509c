// What can be done in plan mode: buttons, keys and the list of keys are these.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "app/plan/plan_view.h"
#include "app/plan/tunnel_moves.h"
#include "planning/tunnels/aim.h"
#include "planning/tunnels/diameter_range.h"

namespace arthronaut::plan {

using bones::BoneKind;

void PlanView::add_actions(widgets::Actions& actions) {
  add_view_actions(actions);
  add_landmark_actions(actions);
  add_default_actions(actions);
  add_placing_actions(actions);
  add_tunnel_actions(actions);
  add_bundle_actions(actions);
  add_survey_actions(actions);
  add_slice_actions(actions);
  add_pane_actions(actions);
  add_measuring_actions(actions);
  add_volume_actions(actions);
  add_history_actions(actions);
  add_version_actions(actions);
  add_side_actions(actions);
  add_tour_actions(actions);
  actions.add({"plan.bone",
               "Other bone",
               "Plan the tunnel of the other bone",
               GLFW_KEY_TAB,
               0,
               false,
               [this] {
                 const BoneKind other =
                     state_.key.bone == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur;
                 return model_ != nullptr && model_->has_bone(other);
               },
               {},
               [this] {
                 work_on_bone(state_.key.bone == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur);
                 if (bones_.only()) look_from(scene::ViewDirection::Anterior);
                 if (state_.page == PanelPage::Landmarks) look_at_landmarks();
               }});
}

// A key that does nothing says why.
void PlanView::widen(double by_mm) {
  const tunnels::Tunnel now = *model_->tunnel(state_.key);
  const tunnels::Tunnel wider = with_diameter(now, now.diameter_mm + by_mm);
  if (wider.diameter_mm == now.diameter_mm)
    state_.hint = {"A tunnel is planned " + widgets::fixed(tunnels::kLeastDiameter_mm, 0) + " to " +
                       widgets::fixed(tunnels::kGreatestDiameter_mm, 0) + " mm wide: this one is " +
                       widgets::fixed(now.diameter_mm, 1) + " mm.",
                   false, model_->revision()};
  else
    change("Change the diameter of the", true, wider);
}

// Each key makes a new tunnel of the one that is there.
void PlanView::add_tunnel_actions(widgets::Actions& actions) {
  // Not where the landmarks are gone through: there nothing shows the numbers, nor the handles, of a tunnel.
  const auto can_change = [this] {
    return model_ != nullptr && state_.page != PanelPage::Landmarks &&
           model_->tunnel(state_.key).has_value() && !history_.is_read_only();
  };
  const auto add = [&](const std::string& id, const std::string& label, const char* tooltip, int key,
                       int mods, const char* what, auto moved) {
    actions.add({id, label, tooltip, key, mods, true, can_change, {}, [this, what, moved] {
                   change(what, true, moved(*model_->tunnel(state_.key)));
                 }});
  };
  actions.add(
      {"plan.wider", "Wider", "Half a millimetre more", GLFW_KEY_EQUAL, 0, true, can_change, {}, [this] {
         widen(0.5);
       }});
  actions.add({"plan.narrower",
               "Narrower",
               "Half a millimetre less",
               GLFW_KEY_MINUS,
               0,
               true,
               can_change,
               {},
               [this] { widen(-0.5); }});
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
        [this, way = arrow.right_up](const tunnels::Tunnel& t) { return turned(t, bones_.camera(), way); });
    add("plan.slide_" + arrow.word, "Slide entry " + arrow.word,
        "The entry moves over the bone by half a millimetre", arrow.key, GLFW_MOD_SHIFT,
        "Move the entry of the", [this, way = arrow.right_up](const tunnels::Tunnel& t) {
          return with_entry_slid(t, bones_.camera(), 0.5 * way, model_->surface(state_.key.bone));
        });
  }
  actions.add({"plan.remove",
               "Remove tunnel",
               "Undo brings it back",
               GLFW_KEY_DELETE,
               0,
               false,
               can_change,
               {},
               [this] {
                 history_.apply(
                     {state_.key, std::nullopt, "Remove the " + adjective(state_.key) + " tunnel", false},
                     widgets::GraphicsWindow::now_s());
               }});
}

void PlanView::step(bool back) {
  history_.settle_now();
  if (back ? !history_.can_undo() : !history_.can_redo()) return;
  const std::size_t step = back ? history_.position() - 1 : history_.position();
  std::string what = history_.step_name(step);
  what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
  back ? history_.undo() : history_.redo();
  const auto bones = history_.bones_of(step);
  if (!bones.empty() && !bones.contains(state_.key.bone)) work_on_bone(*bones.begin());
  state_.hint = {(back ? "Took back: " : "Did again: ") + what, true, model_->revision()};
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
               [this] { step(true); }});
  actions.add({"plan.redo",
               "Redo",
               "Does it again",
               GLFW_KEY_Y,
               GLFW_MOD_CONTROL,
               true,
               [this] { return history_.can_redo(); },
               {},
               [this] { step(false); }});
  const auto in_conflict = [this] { return history_.is_in_conflict(); };
  actions.add({"plan.take_theirs",
               "Take theirs",
               "The plan that the other program saved; undo brings this one back",
               GLFW_KEY_F7,
               0,
               false,
               in_conflict,
               {},
               [this] { history_.take_theirs(); }});
  actions.add({"plan.keep_ours",
               "Keep this one",
               "Writes this plan over the one that the other program saved",
               GLFW_KEY_F8,
               0,
               false,
               in_conflict,
               {},
               [this] { history_.keep_ours(); },
               {"write over the other program's plan"}});
}

bool PlanView::can_stop_placing() const {
  const bool can_stop_export =
      export_.is_running() && !export_.is_stopping() && slices_.tool() == MeasuringTool::None;
  return can_stop_export || defaults_.is_running() || state_.placing != Placing::Nothing ||
         state_.asks_side || !state_.hint.text.empty();
}

// Where the eye sees the bone that is planned; anything else is said and changes nothing.
void PlanView::place_entry(const scene::SceneRay& ray) {
  const auto met = first_visible(bones_.visible(), ray);
  const std::string planned(bones::to_text(state_.key.bone));
  if (!met) {
    state_.hint = {"That is beside the bone. Click on the " + planned + ", or press Esc."};
    return;
  }
  if (met->is_section) {
    state_.hint = {"There the bone is cut open. Click on its surface, or press Esc."};
    return;
  }
  if (met->bone != state_.key.bone) {
    state_.hint = {"That is the " + std::string(bones::to_text(met->bone)) + ". Click on the " + planned +
                   ", or press Tab to plan the other bone."};
    return;
  }
  put_entry_there(met->point_mm);
}

void PlanView::put_entry_there(const Eigen::Vector3d& point_mm) {
  const auto tunnel = model_->tunnel(state_.key);
  change("Place the entry of the", false,
         tunnel ? with_entry_at(*tunnel, point_mm)
                : for_graft(tunnels::first_tunnel(state_.key.bone, point_mm, model_->axes(state_.key.bone),
                                                  model_->surface(state_.key.bone)),
                            state_.key.bundle));
  state_.placing = Placing::Nothing;
  state_.hint = {};
}

void PlanView::add_placing_actions(widgets::Actions& actions) {
  actions.add({"plan.place", "Place entry", "Then click where the tunnel is to begin on the bone", GLFW_KEY_P,
               0, false,
               // On the page of the landmarks P places these.
               [this] {
                 return model_ != nullptr && state_.page != PanelPage::Landmarks && !history_.is_read_only();
               },
               [this] { return state_.placing == Placing::Entry; },
               [this] {
                 state_.placing = state_.placing == Placing::Entry ? Placing::Nothing : Placing::Entry;
                 state_.shows_lateral = false;  // in the radiograph nothing is placed
                 state_.hint = {};
               }});
  actions.add(
      {"plan.stop_placing",
       "Cancel",
       "Leaves the placing, the question for the side, or a default plan or an export that is being made, "
       "without a change",
       GLFW_KEY_ESCAPE,
       0,
       false,
       [this] { return can_stop_placing(); },
       {},
       [this] {
         // What is in front first: the export goes on beside it.
         if (state_.placing == Placing::Nothing && !defaults_.is_running() && state_.hint.text.empty())
           export_.stop();
         state_.placing = Placing::Nothing;
         state_.asks_side = false;
         state_.hint = {};
         leave_defaults("it was left");
       }});
}

void PlanView::add_view_actions(widgets::Actions& actions) {
  struct Side {
    const char *id, *label;
    int key;
    scene::ViewDirection view;
    std::optional<BoneKind> of = {};  // the bone that it is of
  };
  const std::array<Side, 7> sides{
      Side{"plan.anterior", "Anterior", GLFW_KEY_1, scene::ViewDirection::Anterior},
      Side{"plan.posterior", "Posterior", GLFW_KEY_2, scene::ViewDirection::Posterior},
      Side{"plan.medial", "Medial", GLFW_KEY_3, scene::ViewDirection::Medial},
      Side{"plan.lateral", "Lateral", GLFW_KEY_4, scene::ViewDirection::Lateral},
      Side{"plan.distal", "Distal", GLFW_KEY_5, scene::ViewDirection::Distal, BoneKind::Femur},
      Side{"plan.notch", "Notch", GLFW_KEY_6, scene::ViewDirection::Notch, BoneKind::Femur},
      Side{"plan.plateau", "Plateau", GLFW_KEY_7, scene::ViewDirection::Plateau, BoneKind::Tibia}};
  for (const Side& side : sides)
    actions.add({side.id, side.label, std::string("Look from ") + side.label, side.key, 0, false,
                 [this, side] { return model_ != nullptr && (!side.of || model_->has_bone(*side.of)); },
                 [this, side] {
                   return model_ != nullptr && !state_.shows_lateral && bones_.is_seen_from(side.view);
                 },
                 [this, side] { look_from(side.view); }});
  actions.add({"plan.grid", "Grid",
               "The published grid and where studies found the ligament: Bernard and Hertel on the femur, "
               "Amis and Jakob on "
               "the tibia",
               GLFW_KEY_G, 0, false, [this] { return model_ != nullptr; },
               [this] { return state_.shows_grid; },
               [this] {
                 state_.shows_grid = !state_.shows_grid;
                 state_.shown_revision = 0;
               }});
  actions.add({"plan.xray", "Radiograph",
               "The lateral view of the bone that is worked on, with its grid on it", GLFW_KEY_X, 0, false,
               [this] { return model_ != nullptr; }, [this] { return state_.shows_lateral; },
               [this] { state_.shows_lateral = !state_.shows_lateral; }});
  actions.add({"plan.see_through", "See through", "The bone turns translucent", GLFW_KEY_T, 0, false,
               [this] { return model_ != nullptr; }, [this] { return bones_.is_see_through(); },
               [this] { bones_.see_through(!bones_.is_see_through()); }});
}

void PlanView::add_volume_actions(widgets::Actions& actions) {
  actions.add(
      {"plan.volume", "Images in 3D",
       "The images in the bones' place: bone, bone and soft tissue, the bones' surfaces again; needs a "
       "case with images",
       GLFW_KEY_V, 0, false, [this] { return model_ != nullptr && slices_.has_images(); },
       [this] { return volume_.is_on(); }, [this] { volume_.next(); }});
  const auto threshold = [&](const char* id, const char* label, const char* tooltip, int key, int steps) {
    actions.add({id,
                 label,
                 tooltip,
                 key,
                 0,
                 true,
                 [this] { return volume_.item() != nullptr; },
                 {},
                 [this, steps] { volume_.move_threshold(steps); }});
  };
  threshold("plan.volume_less", "Less dense",
            "Shows what is less dense, too: 25 HU, or a 40th of an MR's range", GLFW_KEY_COMMA, -1);
  threshold("plan.volume_more", "Denser", "Shows what is denser alone: 25 HU, or a 40th of an MR's range",
            GLFW_KEY_PERIOD, 1);
}

void PlanView::add_measuring_actions(widgets::Actions& actions) {
  // What is measured is kept with the case: where that can't be, nothing is measured.
  const auto can_measure = [this] {
    return state_.shows_slices && slices_.volume() != nullptr && !history_.is_read_only();
  };
  const auto switch_to = [this](MeasuringTool tool) {
    slices_.use(slices_.tool() == tool ? MeasuringTool::None : tool);
  };
  actions.add({"plan.distance", "Distance", "Drag from one point of the slices to another, or click on both",
               GLFW_KEY_D, 0, false, can_measure,
               [this] { return slices_.tool() == MeasuringTool::Distance; },
               [switch_to] { switch_to(MeasuringTool::Distance); }});
  actions.add({"plan.angle", "Angle",
               "Click on three points of the slices, or drag along one side; the angle is at the second",
               GLFW_KEY_A, 0, false, can_measure, [this] { return slices_.tool() == MeasuringTool::Angle; },
               [switch_to] { switch_to(MeasuringTool::Angle); }});
  actions.add({"plan.unmeasure",
               "Remove last",
               "Removes the newest distance or angle; undo brings it back",
               GLFW_KEY_BACKSPACE,
               0,
               false,
               [this] {
                 return model_ != nullptr && state_.shows_slices && !model_->measurements().empty() &&
                        !history_.is_read_only();
               },
               {},
               [this] {
                 std::vector<cases::Measurement> measurements = model_->measurements();
                 measurements.pop_back();
                 history_.apply_measurements(measurements, "Remove a measurement");
               }});
  actions.add({"plan.stop_measuring",
               "Stop measuring",
               "The mouse moves the cross-hair again",
               GLFW_KEY_ESCAPE,
               0,
               false,
               [this] { return slices_.tool() != MeasuringTool::None && !can_stop_placing(); },
               {},
               [this] { slices_.use(MeasuringTool::None); }});
  const auto page = [&](const char* id, const char* label, const char* tooltip, int key, PanelPage shown) {
    actions.add({id, label, tooltip, key, 0, false, [this] { return model_ != nullptr; },
                 [this, shown] { return state_.page == shown; }, [this, shown] { show_page(shown); }});
  };
  page("plan.checks_page", "Checks", "Numbers and checks of the tunnel", GLFW_KEY_C, PanelPage::Checks);
  page("plan.landmarks_page", "Landmarks",
       "The points that grids and directions follow from: look at each, move or confirm it", GLFW_KEY_L,
       PanelPage::Landmarks);
  page("plan.steps_page", "Steps", "Every change, to go back to any of them", GLFW_KEY_H, PanelPage::Steps);
}

}  // namespace arthronaut::plan
