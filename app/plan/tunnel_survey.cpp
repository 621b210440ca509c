#include "app/plan/tunnel_survey.h"

#include <algorithm>
#include <utility>

namespace arthronaut::plan {

namespace {

using bones::BoneKind;

constexpr double kMapRadius_mm = 10, kMapSpacing_mm = 1.25;
constexpr double kDrill_mm = 4.5;       // the cannulated drill's guide wire and its play, not the tunnel
constexpr double kShownBefore_mm = 45;  // of the way from a portal
constexpr double kShownBeyond_mm = 25;  // of the way from outside in, beyond the cortex
constexpr double kAimLine_mm = 0.5;
constexpr double kAimsAsked = 21.0 * 21.0;  // by outside_in_aims, at most
constexpr scene::Color kOutsideInColor{0.80F, 0.47F, 0.65F};

}  // namespace

std::optional<SurveyRequest> survey_request(const open_case::PlanModel& model,
                                            const tunnels::TunnelKey& key) {
  const BoneKind bone = key.bone;
  if (!model.has_bone(bone)) return std::nullopt;
  const auto tunnel = model.tunnel(key);
  if (!tunnel) return std::nullopt;
  SurveyRequest request{.revision = model.revision(),
                        .tunnel = *tunnel,
                        .surface = model.shared_surface(bone),
                        .surroundings = model.surroundings(bone),
                        .knee = model.knee_surroundings(),
                        .others = model.tunnels()};
  request.others.erase(key);
  return request;
}

Survey survey(const SurveyRequest& request, const std::function<bool()>& is_cancelled,
              const std::function<void(double done)>& tell,
              const std::function<void(const Survey& map)>& map_made) {
  const tunnels::TunnelKey key = request.tunnel.key();
  Survey found{.revision = request.revision,
               .key = key,
               .surface = request.surface,
               .entries = {},
               .portal = {},
               .outside_in = {}};
  const geometry::Surface& bone = *request.surface;
  const auto knee_checks = [&](const tunnels::Tunnel& tunnel, const tunnels::TunnelGeometry& measured) {
    plan_review::MeasuredPlan plan = request.others;
    plan.insert_or_assign(key, plan_review::MeasuredTunnel{tunnel, measured});
    return plan_review::further_checks(key, plan, request.knee);
  };
  auto entries = tunnels::entries_around(bone, request.tunnel.entry_mm, kMapRadius_mm, kMapSpacing_mm);
  const bool asks_for_aims = key.bone == BoneKind::Femur && request.surroundings.axes;
  // Each entry and each aim from outside in asks once, and costs about the same.
  const double all = static_cast<double>(entries.size()) + (asks_for_aims ? kAimsAsked : 0.0);
  double asked = 0;
  const auto is_cancelled_now = [&] {
    if (tell) tell(std::min(1.0, asked++ / all));
    return is_cancelled && is_cancelled();
  };
  found.entries = tunnels::map_entries(
      {.entries_mm = std::move(entries), .like = request.tunnel, .aim_at = {}, .further = knee_checks}, bone,
      request.surroundings, {}, is_cancelled_now);
  found.has_aims = !asks_for_aims;
  if (!asks_for_aims) return found;
  if (map_made) map_made(found);
  if (request.knee.axis)
    found.portal =
        tunnels::portal_aims(request.tunnel.entry_mm, kDrill_mm,
                             tunnels::anteromedial_portal(*request.knee.axis, *request.surroundings.axes),
                             *request.knee.axis, bone);
  found.outside_in =
      tunnels::outside_in_aims(request.tunnel, bone, request.surroundings, {}, is_cancelled_now);
  found.has_aims = true;
  return found;
}

std::string map_in_words(const Survey& survey, const std::vector<tunnels::PlanCheck>& of_tunnel) {
  using Verdict = tunnels::PlanCheck::Verdict;
  const auto count = [&](Verdict verdict) {
    return std::to_string(std::ranges::count(survey.entries, verdict, &tunnels::EntrySample::verdict));
  };
  std::string unmade;
  for (const tunnels::PlanCheck& check : of_tunnel)
    if (check.verdict == Verdict::NotChecked) unmade += (unmade.empty() ? "" : ", ") + check.name;
  return "Entries of a tunnel of this direction: dot, every check " +
         std::string(unmade.empty() ? "" : "that can be made ") + "passed (" + count(Verdict::Fine) +
         "); ring, to be looked at (" + count(Verdict::Look) + "); cross, wrong (" + count(Verdict::Wrong) +
         ")" + (unmade.empty() ? "" : ". Not checked at any: " + unmade);
}

void add_aims(scene::SceneContent& content, const Survey& survey, const tunnels::Tunnel& tunnel,
              double length_mm) {
  for (const tunnels::PortalAim& aim : survey.portal) {
    if (!aim.is_clear) continue;
    content.lines.push_back({{tunnel.entry_mm, tunnel.entry_mm - kShownBefore_mm * aim.direction},
                             kAimLine_mm,
                             false,
                             scene::kGuideColor,
                             true});
  }
  for (const Eigen::Vector3d& direction : survey.outside_in)
    content.lines.push_back({{tunnel.entry_mm, tunnel.entry_mm + (length_mm + kShownBeyond_mm) * direction},
                             kAimLine_mm,
                             false,
                             kOutsideInColor,
                             true});
}

TunnelSurvey::TunnelSurvey(const std::function<void()>& wake)
    : worker_(
          worker::Backlog::NewestWins,
          [this](auto& inbox) {
            while (const auto request = inbox.next()) {
              const auto is_stale = [&] { return inbox.stops() || inbox.has_message(); };
              const auto publish = [&](Survey found) {
                if (!is_stale()) inbox.publish(std::move(found));
              };
              done_ = 0;
              publish(survey(
                  *request, is_stale, [this](double done) { done_ = done; }, publish));
            }
          },
          wake) {}

std::shared_ptr<const Survey> TunnelSurvey::of(const open_case::PlanModel& model,
                                               const tunnels::TunnelKey& key) {
  if (!model.has_bone(key.bone)) return nullptr;
  const auto surface = model.shared_surface(key.bone);
  if (const auto found = worker_.latest(); found != nullptr && found->revision == model.revision() &&
                                           found->key == key && found->surface == surface)
    return found;
  if (asked_revision_ == model.revision() && asked_key_ == key && asked_surface_ == surface) return nullptr;
  auto request = survey_request(model, key);
  if (!request) return nullptr;
  asked_revision_ = model.revision();
  asked_key_ = key;
  asked_surface_ = surface;
  worker_.post(std::move(*request));
  return nullptr;
}

}  // namespace arthronaut::plan
