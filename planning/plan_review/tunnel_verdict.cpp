#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan_review {

using Verdict = tunnels::PlanCheck::Verdict;

namespace {

struct KnownLandmarks {
  landmarks::Landmarks at_mm;
  landmarks::LandmarkStates states;
};
KnownLandmarks known_of(const cases::Case& knee, bones::BoneKind kind) {
  const auto marks = knee.landmarks.find(kind);
  const auto states = knee.landmark_states.find(kind);
  return {marks == knee.landmarks.end() ? landmarks::Landmarks{} : marks->second,
          states == knee.landmark_states.end() ? landmarks::LandmarkStates{} : states->second};
}

}  // namespace

Verdict TunnelVerdict::worst() const {
  return is_wrong() ? Verdict::Wrong : is_fine() ? Verdict::Fine : Verdict::Look;
}

std::string TunnelVerdict::in_short() const {
  if (is_fine()) return "";
  const std::size_t more = (is_wrong() ? wrong : look).size() - 1;
  std::string others = more > 0 ? std::to_string(more) + (is_wrong() ? " more wrong" : " more") : "";
  if (is_wrong() && !look.empty())
    others += (others.empty() ? "" : ", ") + std::to_string(look.size()) + " to look at";
  return (is_wrong() ? wrong : look).front() + (others.empty() ? "" : " (and " + others + ")");
}

TunnelVerdict verdict_of(const std::vector<tunnels::PlanCheck>& checks,
                         const std::vector<cases::BoneDoubt>& bone_doubts, const std::string& grid_doubt) {
  TunnelVerdict verdict{.wrong = tunnels::wrong_in_words(checks)};
  for (const cases::BoneDoubt& doubt : bone_doubts) verdict.look.push_back("Bone: " + words_of(doubt));
  if (!grid_doubt.empty()) verdict.look.push_back("Grid: " + grid_doubt);
  for (const tunnels::PlanCheck& check : checks)
    if (check.verdict == Verdict::Look) verdict.look.push_back(check.name + ": " + check.text);
  return verdict;
}

landmarks::GridState grid_state(const cases::Case& knee, bones::BoneKind kind) {
  const KnownLandmarks known = known_of(knee, kind);
  return landmarks::grid_state(kind, known.at_mm, known.states);
}

std::string grid_doubt(const cases::Case& knee, bones::BoneKind kind) {
  const KnownLandmarks known = known_of(knee, kind);
  return landmarks::grid_doubt(kind, known.at_mm, known.states);
}

std::string side_doubt(const cases::BoneDoubts& doubts) {
  for (const auto& [bone, of_bone] : doubts)
    for (const cases::BoneDoubt& doubt : of_bone)
      if (const auto* side = std::get_if<cases::SideDoubt>(&doubt); side != nullptr && side->is_open())
        return side->words();
  return "";
}

}  // namespace arthronaut::plan_review
