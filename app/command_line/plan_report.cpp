#include "app/command_line/plan_report.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "planning/files/fixed_number.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/plan_review/landmark_check.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "planning/tunnels/breach.h"
#include "planning/tunnels/check_numbers.h"

namespace arthronaut::command_line {

namespace {

using tunnels::PlanCheck;

// "12.300, -4.000, 0.000"; never "-0.000".
std::string coordinates(const Eigen::Vector3d& v, int decimals) {
  return files::fixed(v.x(), decimals) + ", " + files::fixed(v.y(), decimals) + ", " +
         files::fixed(v.z(), decimals);
}

const char* sign_of(PlanCheck::Verdict verdict) {
  switch (verdict) {
    case PlanCheck::Verdict::Look:
      return "  ! ";
    case PlanCheck::Verdict::Wrong:  // it cannot be drilled like this
      return "  x ";
    case PlanCheck::Verdict::NotChecked:
      return "  ? ";
    case PlanCheck::Verdict::Note:  // a number that nobody holds against anything: no tick
      return "  - ";
    case PlanCheck::Verdict::Fine:
      break;
  }
  return "    ";
}

// What speaks against the landmarks that say where on its bone a tunnel begins; without a grid the checks
// that need it say so themselves.
std::string doubt_of_grid(const cases::Case& knee, const plan_review::CaseReview& review,
                          bones::BoneKind bone) {
  return review.bone(bone).surroundings.has_grid() ? plan_review::grid_doubt(knee, bone) : "";
}

// Of the same landmarks: "missing", "proposed", "incomplete" (its view's are missing) or "confirmed".
const char* state_of_grid(const cases::Case& knee, const plan_review::CaseReview& review,
                          bones::BoneKind bone) {
  if (!review.bone(bone).surroundings.has_grid()) return "missing";
  switch (plan_review::grid_state(knee, bone)) {
    case landmarks::GridState::Confirmed:
      return "confirmed";
    case landmarks::GridState::Incomplete:
      return "incomplete";
    case landmarks::GridState::Proposed:
      break;
  }
  return "proposed";
}

}  // namespace

PlanVerdict judged(const cases::Case& knee, const plan_review::CaseReview& review,
                   const tunnels::TunnelKey& key, const cases::BoneDoubts& doubts, PlanVerdict verdict) {
  std::vector<std::string>& reasons = verdict.reasons;
  for (std::string& wrong : tunnels::wrong_in_words(review.checks(key))) reasons.push_back(std::move(wrong));
  if (const std::string unseen =
          review.bone(key.bone).surroundings.unseen.reached(review.tunnels().at(key).geometry.exit_mm);
      verdict.source.empty() && !unseen.empty())  // of a default its own reasons say so
    reasons.push_back("the exit: nobody has seen bone there, " + unseen);
  if (auto doubt = plan_review::landmark_doubt(review.landmark_check(key.bone)))
    reasons.push_back(*std::move(doubt));
  if (const auto of_bone = doubts.find(key.bone); of_bone != doubts.end())
    for (const cases::BoneDoubt& doubt : of_bone->second)
      if (!is_note(doubt))
        reasons.push_back("the " + std::string(bones::to_text(key.bone)) + ": " + words_of(doubt));
  if (const auto fit = cases::plan_fit(knee, key); !fit.is_valid()) reasons.push_back(fit.reason);
  if (const std::string doubt = doubt_of_grid(knee, review, key.bone);
      verdict.source.empty() && !doubt.empty())
    reasons.push_back("the grid: " + doubt);
  verdict.is_reliable = reasons.empty();
  return verdict;
}

void describe_tunnel(const Context& context, const cases::Case& knee, const plan_review::CaseReview& review,
                     const tunnels::TunnelKey& key, const PlanVerdict& verdict) {
  const auto& [tunnel, measured] = review.tunnels().at(key);
  context.say(files::format("%s tunnel, %.1f mm", tunnels::name_of(key).c_str(), tunnel.diameter_mm));
  context.say("  entry      " + coordinates(tunnel.entry_mm, 3) + " mm");
  context.say("  direction  " + coordinates(tunnel.direction, 5));
  if (!verdict.source.empty()) context.say("  default    " + verdict.place + " [" + verdict.source + "]");
  if (measured.enters_bone) {
    const bool leaves_images =
        bones::images_end_at(review.bone(key.bone).surroundings.unseen.image_cuts, measured.exit_mm);
    context.say(files::format("  length     %.2f mm inside bone", measured.length_mm) +
                (leaves_images ? ", as far as the images go" : ""));
    context.say("  exit       " + coordinates(measured.exit_mm, 3) + " mm" +
                (leaves_images ? ", where the images end" : ""));
    context.say("  wall       " + files::fixed(measured.wall_mm, 2) + " mm at the thinnest");
  }
  if (const auto fit = cases::plan_fit(knee, key); !fit.is_valid())
    context.say("  ! not valid: " + fit.reason);
  if (const std::string doubt = doubt_of_grid(knee, review, key.bone);
      verdict.source.empty() && !doubt.empty())
    context.say("  ! Grid: " + doubt);
  for (const auto& check : review.checks(key)) {
    const bool is_amiss =
        check.verdict == PlanCheck::Verdict::Look || check.verdict == PlanCheck::Verdict::Wrong;
    const std::string source = is_amiss && !check.source.empty() ? " [" + check.source + "]" : "";
    context.say(sign_of(check.verdict) + check.name + ": " + check.text + source);
  }
}

nlohmann::ordered_json tunnel_to_json(const cases::Case& knee, const plan_review::CaseReview& review,
                                      const tunnels::TunnelKey& key, const PlanVerdict& verdict) {
  const auto& [tunnel, measured] = review.tunnels().at(key);
  nlohmann::ordered_json node = {{"bone", bones::to_text(key.bone)},
                                 {"bundle", norms::to_text(key.bundle)},
                                 {"entry_mm", files::to_json(tunnel.entry_mm)},
                                 {"direction", files::to_json(tunnel.direction)},
                                 {"diameter_mm", tunnel.diameter_mm},
                                 {"enters_bone", measured.enters_bone}};
  if (measured.enters_bone) {
    node["exit_mm"] = files::to_json(measured.exit_mm);
    node["length_mm"] = measured.length_mm;
    node["wall_mm"] = measured.wall_mm;
    node["breaches"] = nlohmann::ordered_json::array();
    for (const auto& breach : tunnels::breaches_of(tunnel, measured, *review.bone(key.bone).surface))
      node["breaches"].push_back({{"from_mm", breach.from_mm}, {"to_mm", breach.to_mm}});
  }
  auto checks = nlohmann::ordered_json::array();
  for (const auto& check : review.checks(key)) {
    nlohmann::ordered_json entry = {{"name", check.name},
                                    {"verdict", to_text(check.verdict)},
                                    {"text", check.text},
                                    {"source", check.source}};
    tunnels::put_numbers(check, entry);
    checks.push_back(std::move(entry));
  }
  node["checks"] = std::move(checks);
  node["landmarks"] = state_of_grid(knee, review, key.bone);
  if (!verdict.source.empty()) {
    node["source"] = verdict.source;
    node["place"] = verdict.place;
    node["off_norm_mm"] = verdict.off_norm_mm;
    if (const auto& other = verdict.other_entry)
      node[other->passes() ? "passing_entry_mm" : "drillable_entry_mm"] = files::to_json(other->entry_mm);
  }
  if (verdict.entry_moved_mm > 0) node["entry_moved_mm"] = verdict.entry_moved_mm;
  if (verdict.kept_version > 0) node["kept_version"] = verdict.kept_version;
  node["reliable"] = verdict.is_reliable;
  node["reasons"] = verdict.reasons;
  return node;
}

}  // namespace arthronaut::command_line
