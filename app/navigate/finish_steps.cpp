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

std::vector<FinishedBone> NavigateView::finished_bones() const {
  std::vector<FinishedBone> bones;
  if (model_ == nullptr) return bones;
  const sources::SourceKind kind = started_.kind().value_or(sources::SourceKind::Live);
  for (const bones::BoneKind kind_of_bone : {choices_.bone, choices_.other_bone()}) {
    if (!model_->has_bone(kind_of_bone)) continue;
    const auto keys = model_->knee().plan.of(kind_of_bone);
    if (keys.empty()) continue;
    const theatre::LiveOperation* const known = bones_.known(kind_of_bone);
    FinishedBone bone{kind_of_bone,
                      {},
                      choices_.markers_out.contains({kind, kind_of_bone}),
                      known != nullptr && known->latest()->phase != theatre::LiveState::Phase::NoSource};
    for (const tunnels::TunnelKey& key : keys) {
      const auto said = choices_.drilled.find({kind, key});
      const auto planned = bones_.planned(key);
      FinishedTunnel& tunnel = bone.tunnels.emplace_back(FinishedTunnel{key, false, {}, false});
      tunnel.is_drilled = said != choices_.drilled.end() && planned == said->second;
      if (const auto measured = choices_.measured.find({kind, key});
          measured != choices_.measured.end() && planned &&
          operation::PlannedTunnel{measured->second.planned, planned->length_mm} == *planned)
        tunnel.measured = measured->second;
      tunnel.was_verified = choices_.verified.contains({kind, key});
    }
    bones.push_back(std::move(bone));
  }
  return bones;
}

}  // namespace arthronaut::navigate
