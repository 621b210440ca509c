// Two tunnels planned in one bone: which of them is drilled now is the surgeon's choice, and nothing else's.
#include <GLFW/glfw3.h>

#include "app/navigate/navigate_view.h"
#include "app/scene/scene_camera.h"

namespace arthronaut::navigate {

using norms::Bundle;
using operation::NextAction;

void NavigateView::choose_tunnel(Bundle bundle) {
  bones_.choose({choices_.bone, bundle});
  notice_.clear();
  if (!is_running()) look_along_plan();
}

void NavigateView::look_along_plan() {
  const auto key = bones_.guided(choices_.bone);
  const auto tunnel = key ? model_->tunnel(*key) : std::nullopt;
  if (!tunnel)
    return scene_.look(scene::look_from(scene::ViewDirection::Anterior, model_->knee().side,
                                        model_->bounds(choices_.bone), 1));
  const scene::SceneCamera along =
      scene::look_along(tunnel->direction.normalized(), tunnel->entry_mm, 150, Eigen::Vector3d::UnitZ());
  scene_.look(scene::orbited(along, {40, -30}, 600));  // a little from the side: depth is seen too
}

std::optional<tunnels::TunnelKey> NavigateView::tunnel_to_choose() const {
  auto keys = model_->knee().plan.of(choices_.bone);
  std::erase_if(keys, [this](const tunnels::TunnelKey& key) {
    const auto planned = bones_.planned(key);
    return planned && drilled_as(*planned) != nullptr;
  });
  if (keys.empty()) return std::nullopt;
  if (bones_.must_choose(choices_.bone)) return keys[choices_.offered_tunnel % keys.size()];
  const bool is_drilled = live_->operation->plan && live_->operation->next_action == NextAction::Finish;
  return is_drilled ? std::optional(keys.front()) : std::nullopt;
}

void NavigateView::add_tunnel_actions(widgets::Actions& actions) {
  struct Choice {
    Bundle bundle;
    const char *id, *label, *tooltip;
    int key;
  };
  for (const Choice& choice :
       {Choice{
            Bundle::Anteromedial, "navigate.tunnel_am", "Tunnel AM",
            "The tunnel of the anteromedial bundle is drilled; while a source runs it is offered, and guides "
            "once it is taken over",
            GLFW_KEY_1},
        Choice{Bundle::Posterolateral, "navigate.tunnel_pl", "Tunnel PL",
               "The tunnel of the posterolateral bundle is drilled; while a source runs it is offered, and "
               "guides "
               "once it is taken over",
               GLFW_KEY_2}})
    actions.add(
        {choice.id, choice.label, choice.tooltip, choice.key, 0, false,
         [this, choice] {
           return model_ != nullptr && model_->knee().plan.tunnels.contains({choices_.bone, choice.bundle});
         },
         [this, choice] {
           return model_ != nullptr &&
                  bones_.guided(choices_.bone) == tunnels::TunnelKey(choices_.bone, choice.bundle);
         },
         [this, choice] { choose_tunnel(choice.bundle); }});
}

}  // namespace arthronaut::navigate
