// What is kept of a plan beside the one that is worked on, and what goes to other programs.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "app/plan/plan_view.h"
#include "planning/plan_export/markups_file.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan {

// What is wrong with the versions says the place that a click's answer has: it stands in nobody's way.
void PlanView::load_versions() {
  versions_.clear();
  try {
    for (cases::PlanVersion& version : cases::load_plan_versions(case_folder_))
      versions_.push_back(measured_in(*model_, std::move(version)));
  } catch (const std::runtime_error& error) {  // a file of the case that was changed by hand
    state_.hint = {error.what()};
  }
}

void PlanView::load_bone_doubts() {
  bone_doubts_.clear();
  try {
    bone_doubts_ = cases::load_bone_doubts(case_folder_);
  } catch (const std::runtime_error& error) {  // as of the versions
    state_.hint = {error.what()};
  }
}

void PlanView::keep_version() {
  history_.settle_now();
  try {  // a full disk is a state of the screen
    const cases::PlanVersion kept =
        cases::keep_plan_version(case_folder_, model_->knee().plan, model_->knee().side);
    // Of the plan as it is: the next change is not in it.
    state_.hint = {"Kept as version " + std::to_string(kept.number) + ". Shift+K gives it a name and a note",
                   true, model_->revision()};
    load_versions();
    state_.version_row = 0;  // it, which Shift+K then names
  } catch (const std::runtime_error& error) {
    state_.hint = {error.what()};
  }
}

void PlanView::take_version(std::size_t place) {
  const cases::PlanVersion& version = versions_.at(place).version;
  if (const std::string refusal = cases::side_refusal(version, model_->knee().side); !refusal.empty()) {
    state_.hint = {refusal + ": it is not taken"};
    return;
  }
  history_.apply_plan(version.plan, "Take version " + std::to_string(version.number));
}

std::size_t PlanView::chosen_version() const {
  return versions_.empty() ? 0 : versions_.size() - 1 - std::min(state_.version_row, versions_.size() - 1);
}

void PlanView::name_version(std::size_t place) {
  if (history_.is_read_only()) return;
  show_page(PanelPage::Steps);
  version_field_.open(versions_.at(place).version);
}

void PlanView::say_of_version(int number, const cases::VersionWords& words) {
  try {  // as in keep_version()
    cases::say_of_version(case_folder_, number, words);
    version_field_.close();
    load_versions();
  } catch (const std::runtime_error& error) {
    state_.hint = {error.what()};
  }
}

// Into the case, which is its owner's alone to read; from there it goes wherever it is to go.
void PlanView::export_plan() {
  history_.settle_now();
  state_.hint = {};
  plan_review::CheckedPlan checks;
  for (const auto& [key, tunnel] : model_->tunnels()) checks[key] = model_->checks(key);
  export_.start(model_->knee(), model_->revision(), case_folder_,
                plan_review::verdict_of_plan(model_->knee(), checks, bone_doubts_).wrong);
}

void PlanView::take_markups(const std::filesystem::path& file) {
  state_.placing = Placing::Nothing;
  if (history_.is_read_only()) {
    state_.hint = {"Nothing is taken from " + file.filename().string() + ": the case is read-only"};
    return;
  }
  try {  // a file from elsewhere
    std::vector<cases::PlanVersion> kept;
    for (const KeptVersion& one : versions_) kept.push_back(one.version);
    const std::string doubt = plan_export::origin_doubt(file, model_->knee(), kept);
    const auto [tunnels, note] = plan_export::read_tunnels(
        file, model_->knee().plan,
        [this](bones::BoneKind kind) { return model_->has_bone(kind) ? &model_->surface(kind) : nullptr; });
    history_.apply_tunnels(tunnels, "Take the tunnels of markups");
    std::string names;
    for (const auto& [key, tunnel] : tunnels) names += (names.empty() ? "" : ", ") + tunnels::name_of(key);
    state_.hint = {"Taken from " + file.filename().string() + ": " + names +
                       (note.empty() ? "" : ". The " + note) + (doubt.empty() ? "" : ". Look: " + doubt) +
                       ". Ctrl+Z brings back the plan that was there.",
                   true, model_->revision()};
    follow_plan();
  } catch (const std::runtime_error& error) {
    state_.hint = {error.what()};
  }
}

void PlanView::add_version_actions(widgets::Actions& actions) {
  const auto has_plan = [this] {
    return model_ != nullptr && !model_->knee().plan.tunnels.empty() && !history_.is_read_only();
  };
  actions.add({"plan.keep",
               "Keep version",
               "The plan as it is now stays beside the one that is worked on, to be compared and taken again",
               GLFW_KEY_K,
               0,
               false,
               has_plan,
               {},
               [this] { keep_version(); }});
  actions.add(
      {"plan.name_version",
       "Name version",
       "A name and a note for the chosen version, at first the newest; a click on the line below a row, too",
       GLFW_KEY_K,
       GLFW_MOD_SHIFT,
       false,
       [this] { return model_ != nullptr && !versions_.empty() && !history_.is_read_only(); },
       {},
       [this] { name_version(chosen_version()); }});
  // On the page of the steps, which lists them, the newest first.
  const auto lists = [this] {
    return model_ != nullptr && state_.page == PanelPage::Steps && !versions_.empty();
  };
  for (const auto& [id, label, key, by] :
       {std::tuple{"plan.version_below", "Older version", GLFW_KEY_PAGE_DOWN, 1},
        std::tuple{"plan.version_above", "Newer version", GLFW_KEY_PAGE_UP, -1}})
    actions.add({id,
                 label,
                 "Chooses it in the list, for Enter to take it",
                 key,
                 0,
                 true,
                 lists,
                 {},
                 [this, step = by] {
                   const auto count = static_cast<int>(versions_.size());
                   const int row = static_cast<int>(versions_.size() - 1 - chosen_version());
                   state_.version_row = static_cast<std::size_t>((row + step + count) % count);
                 }});
  actions.add({"plan.version_take",
               "Take version",
               "The chosen version becomes the plan; undo brings back the one that was there",
               GLFW_KEY_ENTER,
               0,
               false,
               [this, lists] { return lists() && !history_.is_read_only(); },
               {},
               [this] { take_version(chosen_version()); }});
  actions.add(
      {"plan.export",
       "Export",
       "For other programs, into the plan's own folder within \"export\" of the case: the plan as JSON, CSV "
       "and "
       "markups of 3D Slicer, the drilled bones as STL and PLY. Markups that were moved there are taken back "
       "by Ctrl+M",
       GLFW_KEY_E,
       GLFW_MOD_CONTROL,
       false,
       [this, has_plan] { return has_plan() && !export_.is_running(); },
       {},
       [this] { export_plan(); }});
}

}  // namespace arthronaut::plan
