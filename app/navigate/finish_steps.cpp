// How an operation ends on the theatre screen: which tunnels are drilled, and what the pedal does then.
#include "app/navigate/navigate_view.h"
#include "planning/log/log.h"

namespace arthronaut::navigate {

void NavigateView::finish_step(FinishAction action) {
  switch (action) {
    case FinishAction::TakeMarkerOut:
      log::info("world marker said to be out: " + std::string(bones::to_text(choices_.bone)));
      return ask(operation::MarkerOut{});
    case FinishAction::OtherBone:
      choices_.goes_to_other_bone = true;
      if (is_under_way(*live_)) end_source();
      return;
    case FinishAction::EndSource:
      return end_source();
    case FinishAction::Nothing:
      return;
  }
}

sources::SourceKind NavigateView::shown_kind() const {
  const auto& source = live_->operation->source;
  return source != nullptr ? source->kind : started_.kind().value_or(sources::SourceKind::Live);
}

const operation::DrilledTunnel* NavigateView::drilled_as(const operation::PlannedTunnel& plan) const {
  const auto of_kind = drilled_.find(shown_kind());
  return of_kind == drilled_.end() ? nullptr : of_kind->second.find(plan);
}

bool NavigateView::marker_is_out(bones::BoneKind bone) const {
  const auto of_kind = drilled_.find(shown_kind());
  return of_kind != drilled_.end() && of_kind->second.marker_is_out(bone);
}

std::vector<FinishedBone> NavigateView::finished_bones() const {
  std::vector<FinishedBone> bones;
  if (model_ == nullptr) return bones;
  for (const bones::BoneKind kind : {choices_.bone, choices_.other_bone()}) {
    if (!model_->has_bone(kind)) continue;
    const auto keys = model_->knee().plan.of(kind);
    if (keys.empty()) continue;
    const theatre::LiveOperation* const known = bones_.known(kind);
    FinishedBone bone{kind,
                      {},
                      marker_is_out(kind),
                      known != nullptr && known->latest()->phase != theatre::LiveState::Phase::NoSource};
    for (const tunnels::TunnelKey& key : keys) {
      const auto planned = bones_.planned(key);
      const operation::DrilledTunnel* const drilled = planned ? drilled_as(*planned) : nullptr;
      bone.tunnels.push_back(drilled == nullptr
                                 ? FinishedTunnel{key, false, {}, false}
                                 : FinishedTunnel{key, true, drilled->measured, drilled->was_verified});
    }
    bones.push_back(std::move(bone));
  }
  return bones;
}

}  // namespace arthronaut::navigate
