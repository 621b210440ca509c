// What can be done while something is imported: choosing, answering, writing the case.
#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/start/import_questions.h"
#include "app/start/side_line.h"
#include "app/start/start_view.h"

namespace arthronaut::start {

using State = ImportWork::State;

void StartView::start_import(bool images_only) {
  if (state_.ticked.empty()) return;
  // What an import before this one guessed is not given to it as known.
  if (!state_.side_was_said) state_.side.reset();
  ImportWishes wishes{.sources = state_.ticked, .side = state_.side, .images_only = images_only};
  wishes.unit = state_.unit;
  if (asks_for_labels()) wishes.labels = state_.labels;
  work_.start(wishes);
}

const library::PlannedCase* StartView::planned_of_selected() const {
  return work_.state() == State::Choosing ? planned_.of(state_.selected) : nullptr;
}

// One that Enter may pass by: a wrong side is a wrong operation.
bool StartView::has_sure_side() const {
  return state_.side.has_value() &&
         !side_line(work_.result(), state_.side, state_.side_was_said).needs_choice;
}

void StartView::save_import() {
  if (!has_sure_side()) return;
  work_.set_side(*state_.side);
  work_.save(new_case_folder(cases_folder(), state_.name), state_.name);
}

void StartView::add_import_actions(widgets::Actions& actions) {
  const auto chooses = [this] { return state_.page == Page::Import && work_.state() == State::Choosing; };
  const auto can_take = [this] {
    return state_.selected < work_.sources().sources.size() &&
           work_.sources().sources[state_.selected].can_be_imported();
  };
  const auto waits = [this] { return state_.page == Page::Import && work_.state() == State::Asking; };
  actions.add({"start.tick",
               "Take it",
               "Takes the selected series in place of another; takes a mesh, or leaves it: meshes of "
               "different bones go together",
               GLFW_KEY_SPACE,
               0,
               false,
               [chooses, can_take] { return chooses() && can_take(); },
               {},
               [this] { tick_selected(); }});
  actions.add({"start.import",
               "Make the bones",
               "Cuts femur and tibia out of what was taken; in a process of its own",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, chooses, can_take] {
                 return chooses() && (!state_.ticked.empty() || can_take()) &&
                        !(asks_for_labels() && state_.labels.empty());
               },
               {},
               [this] {
                 if (state_.ticked.empty())
                   tick_selected();  // where nothing else was taken that one is meant
                 start_import();
               }});
  actions.add(
      {"start.paint",
       "Paint the bones",
       "Takes the images alone, then you paint strokes that the bones are grown from: for an MR, and for "
       "a CT whose bones are not found",
       GLFW_KEY_P,
       0,
       false,
       [this, chooses] {
         return chooses() && state_.ticked.size() == 1 &&
                work_.sources().sources[state_.ticked.front()].series.has_value();
       },
       {},
       [this] { start_import(true); }});
  actions.add(
      {"start.compare",
       "Compare with the plan",
       "Takes the images as those after the operation of the case that is named above: what was drilled "
       "is found in them and compared with its plan",
       GLFW_KEY_A,
       0,
       false,
       [this, chooses] { return chooses() && planned_of_selected() != nullptr; },
       {},
       [this] {
         const ImportSource& source = work_.sources().sources[state_.selected];
         after_operation_ = {planned_of_selected()->folder, source.source, source.series->uid};
       }});
  actions.add({"start.save",
               "Make the case",
               "Writes the case and opens it",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, waits] { return waits() && has_sure_side(); },
               {},
               [this] { save_import(); }});
  actions.add({"start.swap_axes",
               "Swap axes",
               "Reads the mesh as RAS where it was taken for LPS, and the other way round",
               GLFW_KEY_X,
               0,
               false,
               [this, waits] { return waits() && work_.can_swap_axes(); },
               {},
               [this] { work_.swap_axes(); }});
  // Asked once: of what was made, or before where the images show both knees.
  const auto can_say_side = [this, waits] {
    return asks(importing::FailureReason::ShowsBothKnees) || waits();
  };
  actions.add({"start.right", "Right knee", "The images are of a right knee", GLFW_KEY_R, 0, false,
               can_say_side, [this] { return state_.side == bones::Side::Right; },
               [this] { say_side(bones::Side::Right); }});
  actions.add({"start.left", "Left knee", "The images are of a left knee", GLFW_KEY_L, 0, false, can_say_side,
               [this] { return state_.side == bones::Side::Left; }, [this] { say_side(bones::Side::Left); }});
  add_question_actions(actions);
}

void StartView::add_question_actions(widgets::Actions& actions) {
  struct Unit {
    const char *id, *label, *tooltip;
    int key;
    bones::LengthUnit unit;
  };
  for (const Unit& unit :
       {Unit{"start.unit_m", "Metres", "The mesh is in metres", GLFW_KEY_M, bones::LengthUnit::Metre},
        Unit{"start.unit_cm", "Centimetres", "The mesh is in centimetres", GLFW_KEY_C,
             bones::LengthUnit::Centimetre},
        Unit{"start.unit_in", "Inches", "The mesh is in inches", GLFW_KEY_N, bones::LengthUnit::Inch}})
    actions.add({unit.id,
                 unit.label,
                 unit.tooltip,
                 unit.key,
                 0,
                 false,
                 [this, unit = unit.unit] {
                   const auto& fitting = work_.refusal().units;
                   return asks(importing::FailureReason::NeedsUnit) &&
                          std::find(fitting.begin(), fitting.end(), unit) != fitting.end();
                 },
                 {},
                 [this, unit = unit.unit] {
                   state_.unit = unit;
                   start_import();
                 }});
  struct Bone {
    const char *id, *label, *tooltip;
    int key;
    bones::BoneKind kind;
  };
  for (const Bone& bone :
       {Bone{"start.femur", "Femur", "The selected mesh is the femur; of a label map: the femur's next label",
             GLFW_KEY_F, bones::BoneKind::Femur},
        Bone{"start.tibia", "Tibia", "The selected mesh is the tibia; of a label map: the tibia's next label",
             GLFW_KEY_T, bones::BoneKind::Tibia}})
    actions.add({bone.id, bone.label, bone.tooltip, bone.key, 0, false,
                 [this] { return asks_for_labels() || selects_mesh(); },
                 [this, kind = bone.kind] {
                   return !asks_for_labels() && selects_mesh() &&
                          work_.sources().sources[state_.selected].bone == kind;
                 },
                 [this, kind = bone.kind] {
                   if (asks_for_labels())
                     choose_next_label(work_.refusal().labels, state_.labels, kind);
                   else
                     say_bone(kind);
                 }});
}

// While what was refused is still taken.
importing::FailureReason StartView::question() const {
  const ImportSource* refused = work_.refused_source();
  const bool is_taken = state_.page == Page::Import && refused != nullptr &&
                        std::any_of(state_.ticked.begin(), state_.ticked.end(),
                                    [&](std::size_t i) { return &work_.sources().sources[i] == refused; });
  return is_taken ? work_.refusal().reason : importing::FailureReason::Other;
}

bool StartView::asks(importing::FailureReason reason) const { return question() == reason; }

bool StartView::asks_for_labels() const { return asks(importing::FailureReason::NeedsLabels); }

bool StartView::selects_mesh() const {
  const auto& sources = work_.sources().sources;
  return state_.page == Page::Import && work_.state() == State::Choosing &&
         state_.selected < sources.size() && !sources[state_.selected].series;
}

// Said of a mesh, it is taken.
void StartView::say_bone(bones::BoneKind kind) {
  std::erase(state_.ticked, state_.selected);
  work_.set_bone(state_.selected, kind);
  tick_selected();
}

void StartView::take_selected_volume() {
  const auto& sources = work_.sources().sources;
  const auto is_volume = [&](std::size_t i) { return i < sources.size() && sources[i].series.has_value(); };
  if (state_.page == Page::Import && work_.state() == State::Choosing && is_volume(state_.selected) &&
      sources[state_.selected].can_be_imported() && std::ranges::all_of(state_.ticked, is_volume))
    state_.ticked = {state_.selected};
}

void StartView::tick_selected() {
  const auto& sources = work_.sources().sources;
  const ImportSource& taken = sources[state_.selected];
  // A volume stands alone, until another one is taken; a mesh beside meshes of other bones.
  if (taken.series) {
    state_.ticked = {state_.selected};
    return;
  }
  const auto at = std::find(state_.ticked.begin(), state_.ticked.end(), state_.selected);
  if (at != state_.ticked.end()) {
    state_.ticked.erase(at);
    return;
  }
  std::erase_if(state_.ticked,
                [&](std::size_t i) { return sources[i].series || sources[i].bone == taken.bone; });
  state_.ticked.push_back(state_.selected);
}

}  // namespace arthronaut::start
