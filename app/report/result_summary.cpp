#include "app/report/result_summary.h"

#include <algorithm>
#include <map>

#include "app/report/plans_in_force.h"
#include "app/report/report_words.h"
#include "app/report/session_rows.h"
#include "planning/files/unit_signs.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::report {

namespace {

const tunnels::Quantities kAxis{tunnels::Quantity::Entry, tunnels::Quantity::Direction};

std::string off_by(double entry_mm, double angle_deg) {
  return number(entry_mm, " mm") + ", " + number(angle_deg, "\u00B0");
}

std::string by_navigation(const Content& content, const TunnelResult& result) {
  if (result.is_by_word) return "drilled by word alone: no pose shows where";
  if (result.navigated == nullptr) return content.session ? "not drilled in this session" : "\u2013";
  const operation::AchievedTunnel& achieved = *result.navigated;
  const operation::TunnelDifference off = operation::compare(achieved.planned, achieved.measured);
  return off_by(off.entry_mm, off.angle_deg) +
         (changed_since(content, achieved.planned).empty() ? "" : "; off a plan of before");
}

std::string by_ct(const Content& content, const TunnelResult& result) {
  if (result.imaged == nullptr) return "\u2013";
  const postop::ComparisonVerdict verdict = verdict_of(content, result.key);
  const std::string words(to_text(verdict));
  const postop::AchievedTunnel& found = result.imaged->tunnel;
  if (!found.is_found) return words;
  // Whatever is not known else: these two are what stands here.
  const bool is_axis_known =
      is_relied_on(*result.imaged, kAxis) && verdict != postop::ComparisonVerdict::OfAnEarlierPlan;
  const std::string known = known_in_words(relied_on(*result.imaged));
  return off_by(found.offset_mm, geometry::deg_from_rad(found.angle_rad)) +
         (is_axis_known                                          ? ""
          : verdict == postop::ComparisonVerdict::ReliableInPart ? "; " + words + ": " + known
                                                                 : "; " + words) +
         (result.imaged->kept_because.empty() ? "" : "; kept from earlier images");
}

// By what a bone's tunnel was drilled, or would have been: "Femur: registration reliable, ...".
std::string by_registration(bones::BoneKind bone,
                            const std::optional<registration::RegistrationSummary>& registration,
                            const std::string& without, const Safety& safety) {
  std::string words = (bone == bones::BoneKind::Femur ? "Femur: " : "Tibia: ") + without;
  if (registration)
    words = std::string(bone == bones::BoneKind::Femur ? "Femur" : "Tibia") + ": registration " +
            (registration->reliable ? "reliable" : "NOT RELIABLE") +
            (registration->has_pose
                 ? ", predicted error at the target " + number(registration->predicted_tre_mm, " mm", 2)
                 : "");
  return words + ". Verification: " + verification_in_words(safety) +
         ". Alarms, void registrations: " + alarms_in_words(safety) + ".";
}

}  // namespace

std::vector<TunnelResult> results_of(const Content& content) {
  std::map<tunnels::TunnelKey, TunnelResult> results;
  const auto result_of = [&](const tunnels::TunnelKey& key) -> TunnelResult& {
    return results.try_emplace(key, TunnelResult{.key = key}).first->second;
  };
  for (const auto& [key, tunnel] : content.knee.plan.tunnels) result_of(key);
  for (const Content::Earlier& earlier : content.earlier)
    result_of(earlier.achieved.planned.key()).navigated = &earlier.achieved;
  for (const operation::AchievedTunnel& achieved : content.achieved)
    result_of(achieved.planned.key()).navigated = &achieved;
  for (const auto& [key, comparison] : content.postoperative) result_of(key).imaged = &comparison;
  std::vector<TunnelResult> in_order;
  for (auto& [key, result] : results) {
    result.is_by_word = std::ranges::any_of(content.by_word, [&](const Content::ByWord& said) {
      return said.tunnel == tunnels::name_of(result.key);
    });
    // What was measured in another surface lies in another frame.
    const bool is_of_this_bone =
        !content.is_of_another_surface || content.session->header().bone != result.key.bone;
    if (result.navigated != nullptr && !result.is_by_word && is_of_this_bone && result.imaged != nullptr &&
        is_relied_on(*result.imaged, kAxis))
      result.navigated_to_imaged =
          operation::compare(result.navigated->measured, result.imaged->tunnel.tunnel);
    in_order.push_back(result);
  }
  return in_order;
}

void draw_plan_verdicts(FlowingPages& pages, const Content& content) {
  if (const std::string side = plan_review::side_note(content.bone_doubts); !side.empty())
    pages.sentence("The side: " + side, {.size_pt = 9});
  for (const auto& [key, measured] : content.review->tunnels()) {
    const auto checks = content.review->checks(key);
    const plan_review::TunnelVerdict verdict =
        plan_review::verdict_of(measured.tunnel, checks, content.bone_doubts, grid_doubt(content, key.bone));
    const auto unmade =
        std::ranges::count(checks, tunnels::PlanCheck::Verdict::NotChecked, &tunnels::PlanCheck::verdict);
    const std::string name = "Checks of the " + tunnels::name_of(key) + ": ";
    for (const std::string& wrong : verdict.wrong)
      pages.sentence(files::with_signs(name + "WRONG: " + wrong), {.bold = true, .ink = kWarning});
    for (const std::string& look : verdict.look)
      pages.sentence(files::with_signs(name + "look: " + look), {.size_pt = 9, .ink = kCaution});
    if (verdict.is_fine())
      pages.sentence(name + "nothing speaks against it" +
                         (unmade > 0 ? ", " + std::to_string(unmade) + " could not be made" : ""),
                     {.size_pt = 9});
  }
}

void draw_result_summary(FlowingPages& pages, const Content& content) {
  const std::vector<TunnelResult> results = results_of(content);
  if (!content.session && content.postoperative.empty()) return;
  pages.heading("Result");
  if (content.session && content.session->header().source_kind == sources::SourceKind::Simulation)
    pages.sentence("SIMULATION: nobody's knee.", {.bold = true, .ink = kWarning});
  std::vector<std::string> warnings;
  for (const Content::Other& other : content.others)
    warnings.insert(warnings.end(), other.plan_warnings.begin(), other.plan_warnings.end());
  if (content.session)
    std::ranges::move(plan_warnings(*content.session, content), std::back_inserter(warnings));
  for (const std::string& warning : warnings) pages.sentence(warning, {.bold = true, .ink = kWarning});
  std::vector<std::vector<std::string>> rows = {{"Tunnel", "Navigation: offset of the entry",
                                                 "CT after: offset of the entry", "CT against navigation"}};
  for (const TunnelResult& result : results)
    rows.push_back({tunnels::name_of(result.key), by_navigation(content, result), by_ct(content, result),
                    result.navigated_to_imaged
                        ? off_by(result.navigated_to_imaged->entry_mm, result.navigated_to_imaged->angle_deg)
                        : "\u2013"});
  if (!results.empty()) pages.table({20, 54, 54, 42}, rows);
  if (!content.session) return;
  pages.sentence(by_registration(content.session->header().bone, content.registration,
                                 content.registration_problem.empty() ? "no registration was kept"
                                                                      : "NOT READABLE: the registration",
                                 content.safety),
                 {.size_pt = 8.5});
  for (const Content::Other& other : content.others)
    pages.sentence(by_registration(other.bone, other.registration,
                                   other.has_broken_registration ? "NOT READABLE: the registration"
                                                                 : "no registration was kept",
                                   other.safety),
                   {.size_pt = 8.5});
}

}  // namespace arthronaut::report
