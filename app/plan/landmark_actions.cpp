// Landmarks in plan mode: gone through, confirmed, moved.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/plan/plan_view.h"
#include "app/plan/roof_line.h"
#include "app/plan/tunnel_moves.h"

namespace arthronaut::plan {

using landmarks::LandmarkState;

std::string PlanView::landmark() const {
  const auto rows = landmark_rows(*model_, state_.key.bone);
  return rows.empty() ? "" : rows[std::min(state_.landmark, rows.size() - 1)].name;
}

// Looked at straight from outside, near enough to judge; the bone may be turned from there.
void PlanView::select_landmark(std::size_t row) {
  state_.landmark = row;
  state_.hint = {};
  const auto& marks = model_->landmarks(state_.key.bone);
  const auto at = marks.find(landmark());
  if (at == marks.end()) return;
  bones_.look_at(at->second, state_.key.bone);
  state_.shown_revision = 0;
  slices_.set_cross(at->second);
}

// Enter confirms one: it has to be in sight before. Where all are confirmed the view stays as it is.
void PlanView::look_at_landmarks() {
  const auto rows = landmark_rows(*model_, state_.key.bone);
  if (!has_to_confirm(rows)) return;
  const bool is_proposed = rows[state_.landmark].state == LandmarkRow::State::Proposed;
  select_landmark(is_proposed ? state_.landmark : *next_proposed(rows, state_.landmark));
}

std::string PlanView::landmark_title() const {
  const landmarks::LandmarkKind* kind = landmarks::find_landmark(state_.key.bone, landmark());
  return kind == nullptr ? "" : std::string(kind->title);
}

// One that is pressed is the one that is worked on.
void PlanView::follow_landmark(const PaneEvent& event) {
  const auto& marks = model_->landmarks(state_.key.bone);
  if (const auto at = marks.find(landmark()); at != marks.end() && event.dragged == at->first) {
    const auto to = lies_within_bone(at->first) ? moved_in_view(bones_.camera(), event.drag_ray, at->second)
                                                : dragged_over(bones_.visible(), state_.key.bone, at->second,
                                                               event.drag_ray, bones_.is_see_through());
    if (to) put_landmark(*to, "Drag", state_.has_dragged);
    state_.has_dragged = state_.has_dragged || to.has_value();
  }
  if (event.pressed.empty()) return;
  const auto rows = landmark_rows(*model_, state_.key.bone);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].name == event.pressed) state_.landmark = i;
}

void PlanView::place_landmark(const scene::SceneRay& ray) {
  const auto met = first_visible(bones_.visible(), ray);
  if (!met || met->is_section || met->bone != state_.key.bone) {
    state_.hint = {"That is not the surface of the " + std::string(bones::to_text(state_.key.bone)) +
                   ". Click on it, or press Esc."};
    return;
  }
  put_landmark_there(lies_within_bone(landmark()) ? middle_behind(model_->surface(state_.key.bone), *met, ray)
                                                  : met->point_mm);
}

void PlanView::put_landmark_there(const Eigen::Vector3d& point_mm) {
  put_landmark(point_mm, "Place", false);
  state_.placing = Placing::Nothing;
  state_.hint = {};
}

void PlanView::put_landmark(const Eigen::Vector3d& point_mm, const std::string& how, bool continues) {
  landmarks::Landmarks marks = model_->landmarks(state_.key.bone);
  landmarks::LandmarkStates states = model_->landmark_states(state_.key.bone);
  marks[landmark()] = point_mm;
  states[landmark()] = LandmarkState::Confirmed;
  history_.apply_landmarks(state_.key.bone, marks, states, how + ": " + landmark_title(), continues,
                           widgets::GraphicsWindow::now_s());
}

void PlanView::confirm_landmarks(bool all) {
  landmarks::LandmarkStates states = model_->landmark_states(state_.key.bone);
  const auto& marks = model_->landmarks(state_.key.bone);
  for (const auto& [name, position] : marks)
    if (all || name == landmark()) states[name] = LandmarkState::Confirmed;
  history_.apply_landmarks(
      state_.key.bone, marks, states,
      all ? "Confirm all landmarks of the " + std::string(bones::to_text(state_.key.bone))
          : "Confirm: " + landmark_title(),
      false, widgets::GraphicsWindow::now_s());
  history_.settle_now();
  if (const auto next = next_proposed(landmark_rows(*model_, state_.key.bone), state_.landmark))
    select_landmark(*next);
}

// A landmark is placed where it is listed: elsewhere nothing shows which one a click would move.
void PlanView::show_page(PanelPage page) {
  const bool begins = page == PanelPage::Landmarks && state_.page != page;
  state_.page = page;
  if (begins) look_at_landmarks();
  if (page != PanelPage::Landmarks && state_.placing == Placing::Landmark) state_.placing = Placing::Nothing;
}

void PlanView::add_landmark_marks(std::vector<PaneMark>& marks) const {
  const std::string selected = landmark();
  const auto& points = model_->landmarks(state_.key.bone);
  for (const LandmarkRow& row : landmark_rows(*model_, state_.key.bone)) {
    const auto at = points.find(row.name);
    if (at == points.end()) continue;
    const bool is_selected = row.name == selected, is_confirmed = row.state == LandmarkRow::State::Confirmed;
    const bool is_within = lies_within_bone(row.name);
    // What lies within the bone would be taken for what is seen before it: that one alone is which was
    // chosen.
    marks.push_back({is_selected ? PaneMark::Shape::Ring : PaneMark::Shape::Cross, row.name,
                     is_selected ? row.title : "", at->second,
                     is_confirmed ? widgets::kGood : widgets::kCaution, !is_within || is_selected,
                     row.title + (is_confirmed ? ", confirmed: " : ", proposed: ") + row.meaning});
    marks.back().shows_through = is_within && is_selected;
  }
}

void PlanView::add_landmark_actions(widgets::Actions& actions) {
  const auto here = [this] {
    return model_ != nullptr && state_.page == PanelPage::Landmarks && model_->has_bone(state_.key.bone);
  };
  // Of a case that is only looked at they are looked at alone.
  const auto can_change = [this, here] { return here() && !history_.is_read_only(); };
  const auto is_there = [this, can_change] {
    return can_change() && model_->landmarks(state_.key.bone).contains(landmark());
  };
  const auto go = [this](int by) {
    const auto count = static_cast<int>(landmark_rows(*model_, state_.key.bone).size());
    select_landmark(static_cast<std::size_t>((static_cast<int>(state_.landmark) + by + count) % count));
  };
  for (const auto& [id, key] :
       {std::pair("plan.landmark_next", GLFW_KEY_PAGE_DOWN), std::pair("plan.landmark_below", GLFW_KEY_DOWN)})
    actions.add({id, "Next landmark", "Looks at the next one", key, 0, true, here, {}, [go] { go(1); }});
  for (const auto& [id, key] :
       {std::pair("plan.landmark_previous", GLFW_KEY_PAGE_UP), std::pair("plan.landmark_above", GLFW_KEY_UP)})
    actions.add({id, "Landmark before", "Looks at the one before", key, 0, true, here, {}, [go] { go(-1); }});
  actions.add({"plan.landmark_confirm",
               "Confirm",
               "The landmark is where it should be; goes on to the next proposed one",
               GLFW_KEY_ENTER,
               0,
               false,
               is_there,
               {},
               [this] { confirm_landmarks(false); }});
  actions.add(
      {"plan.landmark_confirm_all",
       "Confirm all",
       "Every landmark of this bone is where it should be",
       GLFW_KEY_ENTER,
       GLFW_MOD_SHIFT,
       false,
       [this, can_change] { return can_change() && has_to_confirm(landmark_rows(*model_, state_.key.bone)); },
       {},
       [this] { confirm_landmarks(true); }});
  actions.add({"plan.landmark_place", "Place", "Then click where the landmark is", GLFW_KEY_P, 0, false,
               can_change, [this] { return state_.placing == Placing::Landmark; },
               [this] {
                 state_.placing = state_.placing == Placing::Landmark ? Placing::Nothing : Placing::Landmark;
                 state_.shows_lateral = false;  // in the radiograph nothing is placed
                 state_.hint = {};
               }});
  actions.add({"plan.landmark_reset",
               "As proposed",
               "Back to where the bone's shape puts it",
               GLFW_KEY_R,
               0,
               false,
               [this, can_change] {
                 return can_change() && model_->proposal(state_.key.bone) &&
                        model_->proposal(state_.key.bone)->landmarks.contains(landmark());
               },
               {},
               [this] {
                 landmarks::Landmarks marks = model_->landmarks(state_.key.bone);
                 landmarks::LandmarkStates states = model_->landmark_states(state_.key.bone);
                 marks[landmark()] = model_->proposal(state_.key.bone)->landmarks.at(landmark());
                 states[landmark()] = LandmarkState::Proposed;
                 history_.apply_landmarks(state_.key.bone, marks, states, "As proposed: " + landmark_title(),
                                          false, widgets::GraphicsWindow::now_s());
               }});
  actions.add(
      {"plan.roof",
       "Lay Blumensaat's line the other way",
       "From end to end of the roof, as Bernard and Hertel's grid is defined, or along the flat of it "
       "without "
       "the hill that stands in two roofs of three (Yahagi 2018): the grid's percentages follow",
       GLFW_KEY_U,
       0,
       false,
       [this, can_change] {
         return can_change() && state_.key.bone == bones::BoneKind::Femur &&
                with_other_roof(*model_).has_value();
       },
       {},
       [this] {
         const auto laid = with_other_roof(*model_);
         history_.apply_landmarks(bones::BoneKind::Femur, laid->landmarks, laid->states,
                                  laid->line == RoofLine::Flat ? "Lay Blumensaat's line along the flat roof"
                                                               : "Lay Blumensaat's line from end to end",
                                  false, widgets::GraphicsWindow::now_s());
         history_.settle_now();
       }});
}

}  // namespace arthronaut::plan
