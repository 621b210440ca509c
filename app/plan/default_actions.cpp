// The default plan: made beside the screen, and taken where it is of what is planned by then.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "app/plan/plan_view.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan {

using bones::BoneKind;

void PlanView::make_defaults(const std::vector<tunnels::TunnelKey>& keys,
                             std::function<void(std::vector<MadeTunnel>)> then) {
  state_.placing = Placing::Nothing;
  state_.hint = {};
  // On the other knee every landmark, and so every default, would be another one.
  state_.asks_side = !plan_review::side_doubt(bone_doubts_).empty();
  if (state_.asks_side) {
    state_.hint = {"No default plan yet: say first which knee it is. The side is in doubt."};
    return;
  }
  history_.settle_now();
  defaults_.start(*model_, keys);
  take_made_ = std::move(then);
}

void PlanView::leave_defaults(const std::string& why) {
  if (!defaults_.is_running()) return;
  defaults_.cancel();
  state_.hint = {"No default plan is made: " + why + ".", true};
}

void PlanView::follow_defaults() {
  if (defaults_.is_running() && !defaults_.is_of(*model_))
    leave_defaults("what it follows from was changed meanwhile. N makes it anew");
  if (auto made = defaults_.take()) take_made_(std::move(*made));
}

void PlanView::take_defaults(std::vector<MadeTunnel> made, const std::string& what) {
  const cases::Plan before = model_->knee().plan;
  std::map<tunnels::TunnelKey, tunnels::Tunnel> tunnels;
  for (const MadeTunnel& one : made)
    if (one.made.is_usable()) tunnels.emplace(one.key, one.made.tunnel);
  if (!tunnels.empty()) history_.apply_tunnels(tunnels, what);
  for (MadeTunnel& one : made) one.checks = model_->checks(one.key);
  const bool took_the_place = std::ranges::any_of(cases::compare_plans(model_->knee().plan, before),
                                                  &cases::TunnelDifference::is_lost_here);
  const bool is_as_it_should_be = std::ranges::all_of(made, [](const MadeTunnel& one) {
    return one.made.is_usable() && one.made.doubts.empty() && one.made.failed.empty() &&
           tunnels::wrong_in_words(one.checks).empty();
  });
  state_.hint = {default_in_words(made, took_the_place), is_as_it_should_be, model_->revision()};
  state_.made = std::move(made);
  show_page(PanelPage::Checks);
}

bool PlanView::can_be_moved(const MadeTunnel& made) const {
  const auto now = model_->tunnel(made.key);
  const tunnels::Tunnel& then = made.made.tunnel;
  return made.made.other_entry && now && now->entry_mm == then.entry_mm && now->direction == then.direction &&
         now->diameter_mm == then.diameter_mm;
}

bool PlanView::can_move_defaults() const {
  return can_make_defaults() &&
         std::ranges::any_of(state_.made, [this](const MadeTunnel& one) { return can_be_moved(one); });
}

std::vector<MadeTunnel> PlanView::moved_defaults() const {
  std::vector<MadeTunnel> moved;
  for (const MadeTunnel& one : state_.made)
    if (can_be_moved(one))
      moved.push_back({.key = one.key, .made = default_plan::moved_within_spread(one.made)});
  return moved;
}

bool PlanView::can_make_defaults() const {
  return model_ != nullptr && !defaults_.is_busy() && !history_.is_read_only();
}

void PlanView::add_default_actions(widgets::Actions& actions) {
  actions.add({"plan.default", "Default plan",
               "Both tunnels by the norms and the landmarks: a proposal to begin with, undo takes it back",
               GLFW_KEY_N, 0, false, [this] { return can_make_defaults(); },
               [this] { return defaults_.is_running(); },
               [this] {
                 std::vector<tunnels::TunnelKey> keys;
                 for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) {
                   if (!model_->has_bone(bone)) continue;
                   keys.push_back(key_in(bone));
                   if (const auto beside = other_bundle(keys.back())) keys.push_back(*beside);
                 }
                 make_defaults(keys, [this](std::vector<MadeTunnel> made) {
                   take_defaults(std::move(made), "Make the default plan");
                 });
               }});
  actions.add(
      {"plan.within_spread",
       "Enter where it passes",
       "Tunnels of the default plan that fail a check: entered at the nearest place within the norm's "
       "spread from which they pass every check; where none does, where nothing is wrong",
       GLFW_KEY_N,
       GLFW_MOD_SHIFT,
       false,
       [this] { return can_move_defaults(); },
       {},
       [this] {
         history_.settle_now();
         take_defaults(moved_defaults(), "Enter within the norm's spread");
       }});
}

}  // namespace arthronaut::plan
