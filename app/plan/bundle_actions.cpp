// One tunnel in a bone, or one for each bundle of the ligament.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/plan/plan_view.h"
#include "app/plan/tunnel_moves.h"

namespace arthronaut::plan {

using norms::Bundle;

tunnels::TunnelKey PlanView::key_in(bones::BoneKind bone) const {
  const auto keys = model_->knee().plan.of(bone);
  const tunnels::TunnelKey alike{bone, state_.key.bundle};
  return keys.empty() || std::ranges::find(keys, alike) != keys.end() ? alike : keys.front();
}

void PlanView::work_on(const tunnels::TunnelKey& key) {
  if (key.bone != state_.key.bone) state_.landmark = 0;  // a row of the other bone's list
  state_.key = key;
  state_.shown_revision = 0;
  state_.survey = nullptr;
  state_.placing = Placing::Nothing;
  state_.hint = {};
}

void PlanView::work_on_bone(bones::BoneKind bone) {
  const bool places_entry = state_.placing == Placing::Entry;
  work_on(key_in(bone));
  if (places_entry) state_.placing = Placing::Entry;
}

// Whose norms are drawn: those of the bone's tunnels; of what is worked on where none is planned.
std::vector<norms::Bundle> PlanView::bundles_shown(bones::BoneKind kind) const {
  std::vector<norms::Bundle> bundles;
  // Where one is still to be placed it goes by its own norm.
  if (kind == state_.key.bone && !model_->tunnel(state_.key)) return {state_.key.bundle};
  for (const tunnels::TunnelKey& key : model_->knee().plan.of(kind)) bundles.push_back(key.bundle);
  if (bundles.empty()) bundles.push_back(key_in(kind).bundle);
  return bundles;
}

void PlanView::follow_plan() {
  if (model_ == nullptr) return;
  // What was said of a plan is true of that plan alone.
  if (state_.hint.of && *state_.hint.of != model_->revision()) state_.hint = {};
  const auto keys = model_->knee().plan.of(state_.key.bone);
  if (!keys.empty() && (keys.front().bundle == Bundle::Whole) != (state_.key.bundle == Bundle::Whole))
    work_on(keys.front());
}

// Both by the norms. Where there are none to go by, the tunnel that is there becomes AM, and PL is placed by
// hand.
void PlanView::plan_bundles() {
  const bones::BoneKind bone = state_.key.bone;
  const tunnels::TunnelKey am{bone, Bundle::Anteromedial}, pl{bone, Bundle::Posterolateral};
  make_defaults({am, pl}, [this, am, pl](std::vector<MadeTunnel> both) {
    const std::string what = "Plan two bundles in the " + std::string(bones::to_text(am.bone));
    const auto missing =
        std::ranges::find_if(both, [](const MadeTunnel& one) { return !one.made.is_usable(); });
    if (missing == both.end()) {
      work_on(am);
      return take_defaults(std::move(both), what);
    }
    // One of another surface would pass for one of this.
    const auto single = model_->plan_fit(am.bone).is_valid() ? model_->tunnel(am.bone) : std::nullopt;
    if (single) history_.apply_tunnels({{am, for_graft(*single, am.bundle)}}, what);
    work_on(single ? pl : am);
    show_page(PanelPage::Checks);  // where P places the entry
    state_.hint = {"No default for two bundles: " + ended(missing->made.message) +
                   " Press P and place the entry."};
  });
}

void PlanView::plan_single() {
  const tunnels::TunnelKey beside = state_.key;
  make_defaults({beside.bone}, [this, beside](std::vector<MadeTunnel> made) {
    const std::string what = "Plan one tunnel in the " + std::string(bones::to_text(beside.bone));
    const auto here = model_->plan_fit(beside).is_valid() ? model_->tunnel(beside) : std::nullopt;
    const bool is_usable = made.front().made.is_usable();
    if (!is_usable && !here) {
      state_.hint = {"No default for one tunnel: " + ended(made.front().made.message)};
      return;
    }
    work_on(beside.bone);
    if (is_usable) return take_defaults(std::move(made), what);
    history_.apply_tunnels({{beside.bone, for_graft(*here, Bundle::Whole)}}, what);
  });
}

void PlanView::add_bundle_actions(widgets::Actions& actions) {
  const auto is_of_bundle = [this] {
    return model_ != nullptr && model_->has_bone(state_.key.bone) && state_.key.bundle != Bundle::Whole;
  };
  actions.add(
      {"plan.bundles",
       "Two bundles",
       "A tunnel for each bundle of the ligament, AM and PL, in place of this one; undo takes it back",
       GLFW_KEY_B,
       0,
       false,
       [this] {
         return can_make_defaults() && model_->has_bone(state_.key.bone) &&
                state_.key.bundle == Bundle::Whole;
       },
       {},
       [this] { plan_bundles(); }});
  actions.add({"plan.other_bundle",
               "Other bundle",
               "Work on the other tunnel of this bone: AM or PL",
               GLFW_KEY_B,
               0,
               false,
               is_of_bundle,
               {},
               [this] { work_on(*other_bundle(state_.key)); }});
  actions.add({"plan.single",
               "One tunnel",
               "A single tunnel in place of both bundles' in this bone; undo brings them back",
               GLFW_KEY_B,
               GLFW_MOD_SHIFT,
               false,
               [this, is_of_bundle] { return is_of_bundle() && can_make_defaults(); },
               {},
               [this] { plan_single(); }});
}

}  // namespace arthronaut::plan
