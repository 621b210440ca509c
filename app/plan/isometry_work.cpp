#include "app/plan/isometry_work.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planning/plan_review/landmark_check.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;
using Verdict = tunnels::PlanCheck::Verdict;

// The bone is drawn with fewer triangles than the map is made of.
constexpr double kLift_mm = 0.3;

geometry::TriangleMesh lifted(const geometry::TriangleMesh& band) {
  geometry::TriangleMesh mesh = geometry::Surface(band).mesh();  // with corners that triangles share
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) mesh.vertices_mm[i] += kLift_mm * normals[i];
  return mesh;
}

std::string tibial_doubt(const open_case::PlanModel& model, const tunnels::Tunnel& tibial) {
  if (const cases::PlanFit fit = model.plan_fit(tibial.key()); !fit.is_valid()) return fit.reason;
  const std::string unseen =
      model.surroundings(BoneKind::Tibia).unseen.reached(tibial.entry_mm, tibial.diameter_mm / 2);
  return unseen.empty() ? "" : "it reaches " + unseen;
}

}  // namespace

bool IsometryRequest::has_wall_of(const IsometryRequest& other) const {
  return femur == other.femur && axes.anterior == other.axes.anterior &&
         axes.proximal == other.axes.proximal && axes.lateral == other.axes.lateral;
}

bool IsometryRequest::is_same_as(const IsometryRequest& other) const {
  return has_wall_of(other) && axis.origin == other.axis.origin && axis.point_mm == other.axis.point_mm &&
         axis.direction == other.axis.direction && tibial_opening_mm == other.tibial_opening_mm;
}

std::optional<tunnels::LengthChange> IsometryRequest::at(const Eigen::Vector3d& point_mm,
                                                         const Eigen::Vector3d& normal) const {
  if (!tunnels::is_lateral_wall(*femur, point_mm, normal, axes, extents)) return std::nullopt;
  return tunnels::length_change(point_mm, tibial_opening_mm, axis);
}

IsometryAsked isometry_asked(const open_case::PlanModel& model, const tunnels::TunnelKey& key,
                             const cases::BoneDoubts& doubts) {
  if (!model.has_bone(key.bone) || !model.tunnel(key)) return {.why_not = "there is no femoral tunnel yet"};
  if (const std::string side = plan_review::side_doubt(doubts); !side.empty())
    return {.why_not = "the side is in doubt: " + side};
  // Confirmed landmarks wait for what the shape says of them.
  if (!model.proposal(BoneKind::Femur))
    return {.why_not = "where the femur's shape puts its landmarks is not known yet"};
  if (const auto doubt = plan_review::landmark_doubt(model.landmark_check(BoneKind::Femur)))
    return {.why_not = "the femur's hinge is in doubt: " + *doubt};
  const auto& checks = model.checks(key);
  const auto check = std::ranges::find(checks, "Length over flexion", &tunnels::PlanCheck::name);
  if (check == checks.end()) return {.why_not = "the femoral tunnel does not enter the bone"};
  if (check->verdict == Verdict::NotChecked)
    return {.why_not = "\"Length over flexion\" is " + check->text +
                       (check->source.empty() ? "" : ": " + check->source)};
  // The check was made: the tunnel's graft has a tibial end, and the knee a hinge.
  const plan_review::MeasuredTunnel& tibial = *plan_review::other_end(key, model.tunnels());
  if (const std::string doubt = tibial_doubt(model, tibial.tunnel); !doubt.empty())
    return {.why_not = "the tibial entry is in doubt: " + doubt};
  const tunnels::PlanSurroundings& femur = model.surroundings(BoneKind::Femur);
  if (!femur.axes || femur.axes->origin != landmarks::AnatomicalAxes::Origin::FromLandmarks)
    return {.why_not = "the femur's landmarks do not tell which way is lateral"};
  return {.request = IsometryRequest{.femur = model.shared_surface(BoneKind::Femur),
                                     .axes = *femur.axes,
                                     .extents = femur.extents,
                                     .axis = *model.knee_surroundings().axis,
                                     .tibial_opening_mm = tibial.geometry.entry_on_surface_mm}};
}

std::vector<std::string> isometry_in_words(const open_case::PlanModel& model, const tunnels::TunnelKey& key,
                                           const IsometryRequest& request) {
  std::vector<std::string> lines{
      "Isometry: how much the graft's length changes, by where it begins; its tibial end as planned",
      "This entry: " + tunnels::to_text(tunnels::length_change(model.measured(key).entry_on_surface_mm,
                                                               request.tibial_opening_mm, request.axis)),
      "Model: the tibia turned about " + std::string(graft::to_text(request.axis.origin)) +
          ", a hinge: no roll-back, turning or load. It compares places and gives no last mm"};
  if (const auto check = model.landmark_check(BoneKind::Femur); check.verdict == Verdict::Note)
    lines.push_back("Landmarks: " + check.text);
  return lines;
}

scene::Color isometry_color(std::size_t band, std::size_t count) {
  constexpr std::array<scene::Color, 4> kStops{
      {{0.11F, 0.17F, 0.45F}, {0.45F, 0.33F, 0.62F}, {0.88F, 0.48F, 0.42F}, {0.98F, 0.90F, 0.35F}}};
  const float at = count < 2 ? 0 : static_cast<float>(band) / static_cast<float>(count - 1) * 3;
  const auto lower = std::min<std::size_t>(static_cast<std::size_t>(at), 2);
  const float share = at - static_cast<float>(lower);
  const scene::Color &a = kStops[lower], &b = kStops[lower + 1];
  return {std::lerp(a.red, b.red, share), std::lerp(a.green, b.green, share),
          std::lerp(a.blue, b.blue, share)};
}

ShownIsometry shown_isometry(const IsometryRequest& of, const geometry::TriangleMesh& wall) {
  ShownIsometry shown{of, tunnels::isometry_map(wall, of.tibial_opening_mm, of.axis), {}};
  const auto& bands = shown.map.bands;
  for (std::size_t i = 0; i < bands.size(); ++i)
    shown.items.push_back({std::make_shared<const geometry::TriangleMesh>(lifted(bands[i].mesh)),
                           isometry_color(i, bands.size())});
  return shown;
}

IsometryWork::IsometryWork(const std::function<void()>& wake)
    : worker_(
          worker::Backlog::NewestWins,
          [](auto& inbox) {
            // Of a bone whose tibial end alone is dragged the wall is found once.
            std::optional<IsometryRequest> wall_of;
            geometry::TriangleMesh wall;
            while (const auto request = inbox.next()) {
              if (!wall_of || !wall_of->has_wall_of(*request)) {
                wall = tunnels::lateral_wall(*request->femur, request->axes, request->extents,
                                             [&] { return inbox.stops(); });
                wall_of = *request;
              }
              inbox.publish(shown_isometry(*request, wall));
            }
          },
          wake) {}

std::shared_ptr<const ShownIsometry> IsometryWork::of(const IsometryRequest& request) {
  if (const auto found = worker_.latest(); found != nullptr && found->of.is_same_as(request)) return found;
  if (asked_ && asked_->is_same_as(request)) return nullptr;
  asked_ = request;
  worker_.post(request);
  return nullptr;
}

}  // namespace arthronaut::plan
