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

bool contradicts_side(const cases::BoneDoubt& doubt) {
  const auto* side = std::get_if<cases::SideDoubt>(&doubt);
  return side != nullptr && side->is_open();
}

// The first doubt of the side that is like that, in words; empty without one.
template <typename IsLike>
std::string side_words(const cases::BoneDoubts& doubts, IsLike is_like) {
  for (const auto& [bone, of_bone] : doubts)
    for (const cases::BoneDoubt& doubt : of_bone)
      if (is_like(doubt)) return words_of(doubt);
  return "";
}

TunnelVerdict verdict_but_side(const tunnels::Tunnel& tunnel, const std::vector<tunnels::PlanCheck>& checks,
                               const cases::BoneDoubts& doubts, const std::string& grid_doubt) {
  TunnelVerdict verdict{.wrong = tunnels::wrong_in_words(checks)};
  for (const std::string& doubt : doubts_but_side(doubts, tunnel.bone))
    verdict.look.push_back("Bone: " + doubt);
  if (!grid_doubt.empty()) verdict.look.push_back("Grid: " + grid_doubt);
  for (const tunnels::PlanCheck& check : checks)
    if (check.verdict == Verdict::Look) verdict.look.push_back(check.name + ": " + check.text);
  return verdict;
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

TunnelVerdict verdict_of(const tunnels::Tunnel& tunnel, const std::vector<tunnels::PlanCheck>& checks,
                         const cases::BoneDoubts& doubts, const std::string& grid_doubt) {
  TunnelVerdict verdict = verdict_but_side(tunnel, checks, doubts, grid_doubt);
  verdict.side_note = side_note(doubts);
  if (const std::string side = side_doubt(doubts); !side.empty())
    verdict.wrong.insert(verdict.wrong.begin(), "Side: " + side);
  return verdict;
}

CheckedPlan checks_of_plan(const CaseReview& review) {
  CheckedPlan checks;
  for (const auto& [key, measured] : review.tunnels()) checks[key] = review.checks(key);
  return checks;
}

TunnelVerdict verdict_of_plan(const cases::Case& knee, const CheckedPlan& checks,
                              const cases::BoneDoubts& doubts) {
  TunnelVerdict plan;
  if (knee.plan.tunnels.empty()) return plan;
  if (const std::string side = side_doubt(doubts); !side.empty()) plan.wrong.push_back("Side: " + side);
  for (const auto& [key, planned] : knee.plan.tunnels) {
    const std::string name = tunnels::name_of(key) + ": ";
    if (const cases::PlanFit fit = cases::plan_fit(knee, key); !fit.is_valid())
      plan.wrong.push_back(name + "Bone: " + fit.reason);
    const auto checked = checks.find(key);
    if (checked == checks.end()) continue;
    const TunnelVerdict tunnel =
        verdict_but_side(planned, checked->second, doubts, grid_doubt(knee, key.bone));
    for (const std::string& wrong : tunnel.wrong) plan.wrong.push_back(name + wrong);
    for (const std::string& look : tunnel.look) plan.look.push_back(name + look);
  }
  return plan;
}

TunnelVerdict verdict_of_bones(const cases::BoneDoubts& doubts) {
  TunnelVerdict verdict;
  if (const std::string side = side_doubt(doubts); !side.empty()) verdict.wrong.push_back("Side: " + side);
  for (const auto& [kind, of_bone] : doubts)
    for (const std::string& doubt : doubts_but_side(doubts, kind))
      verdict.look.push_back(std::string(bones::to_text(kind)) + ": Bone: " + doubt);
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

std::string side_doubt(const cases::BoneDoubts& doubts) { return side_words(doubts, contradicts_side); }

std::string side_note(const cases::BoneDoubts& doubts) { return side_words(doubts, cases::is_side_note); }

std::vector<std::string> doubts_but_side(const cases::BoneDoubts& doubts, bones::BoneKind bone) {
  std::vector<std::string> others;
  if (const auto of_bone = doubts.find(bone); of_bone != doubts.end())
    for (const cases::BoneDoubt& doubt : of_bone->second)
      if (!contradicts_side(doubt) && !is_note(doubt)) others.push_back(words_of(doubt));
  return others;
}

}  // namespace arthronaut::plan_review
