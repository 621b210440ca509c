#include "app/case/plan_model.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <map>
#include <utility>

#include "app/scene/lateral_plane.h"
#include "app/scene/notch_cut.h"
#include "planning/bones/mesh_hash.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/landmark_check.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/tunnels/diameter_range.h"

namespace arthronaut::open_case {

namespace {

geometry::Bounds joined(geometry::Bounds all, const geometry::Bounds& other) {
  all.min_mm = all.min_mm.cwiseMin(other.min_mm);
  all.max_mm = all.max_mm.cwiseMax(other.max_mm);
  return all;
}

// Of a view a few hundred pixels wide, with its normals smoothed: the outline is what suffers first.
constexpr std::size_t kMovingTriangles = 6000;

}  // namespace

PlanModel::PlanModel(cases::Case knee, const std::stop_token& stop,
                     const std::function<void(double done)>& tell)
    : knee_(std::move(knee)) {
  knee_surroundings_.is_of_two_frames = knee_.is_of_two_frames;
  // Of each bone: drawn, its size and hash, its landmarks with the surface that they are proposed on.
  const auto pieces =
      3 * std::ranges::count_if(knee_.bones, [](const auto& b) { return !b.second.mesh.empty(); });
  std::atomic<int> pieces_done = 0;
  const auto piece_done = [&] {
    if (stop.stop_requested()) return;  // it was left, and not done
    const int done = ++pieces_done;
    if (tell) tell(static_cast<double>(done) / static_cast<double>(pieces));
  };
  // Beside the proposals, which take seconds.
  auto made_ready = std::async(std::launch::async, [&] {
    for (const auto& [kind, bone] : std::as_const(knee_.bones)) {
      if (bone.mesh.empty() || stop.stop_requested()) continue;
      BoneModel& made = bones_[kind];
      made.drawn = scene::simplified(bone.mesh);
      piece_done();
      if (stop.stop_requested()) continue;
      made.bounds = geometry::bounds_of(bone.mesh);
      made.mesh_sha256 = bones::mesh_sha256(bone.mesh);
      piece_done();
    }
  });
  // A default plan asks for the proposal, too, as long as somebody has to look at the grid: not then, when a
  // key is pressed.
  auto proposed =
      plan_review::propose_landmarks(knee_, plan_review::Proposing::WithoutConfirmed, stop, piece_done);
  made_ready.get();
  if (stop.stop_requested()) throw InvalidInput("the case \"" + knee_.name + "\" is no longer wanted");
  for (auto& [kind, made] : bones_) {
    if (const auto found = proposed.find(kind); found != proposed.end()) {
      made.proposal = std::move(found->second.proposal);
      made.was_proposed = found->second.was_taken;
      made.review.surface = std::move(found->second.surface);  // a third of a second's work
    }
    if (!made.review.surface)
      made.review.surface = std::make_shared<const geometry::Surface>(knee_.bones.at(kind).mesh);
    use_landmarks(kind);
    for (const tunnels::TunnelKey& key : knee_.plan.of(kind))
      knee_.plan.mesh_sha256.try_emplace(key, made.mesh_sha256);
  }
  measure();
  if (bones_.empty()) throw InvalidInput("the case \"" + knee_.name + "\" has no bone to show");
}

void PlanModel::use_landmarks(bones::BoneKind kind) {
  const geometry::TriangleMesh& mesh = knee_.bones.at(kind).mesh;
  BoneModel& bone = bones_.at(kind);
  bone.axes = landmarks::anatomical_axes(kind, knee_.side, landmarks(kind), mesh);
  bone.joint_bounds = scene::joint_bounds(mesh, kind, bone.axes);
  auto unseen = std::move(bone.review.surroundings.unseen);  // the bone's, whatever its landmarks
  bone.review = plan_review::review_bone(mesh, kind, knee_.side, landmarks(kind), bone.review.surface);
  bone.review.surroundings.unseen = std::move(unseen);
  plan_review::put_bone(knee_surroundings_, kind, bone.review);
}

void PlanModel::set_unseen(bones::BoneKind kind, bones::UnseenParts unseen) {
  BoneModel& bone = bones_.at(kind);
  bone.review.surroundings.unseen = std::move(unseen);
  plan_review::put_bone(knee_surroundings_, kind, bone.review);
  ++revision_;
}

const landmarks::Landmarks& PlanModel::landmarks(bones::BoneKind kind) const {
  return knee_.landmarks.at(kind);
}

const landmarks::LandmarkStates& PlanModel::landmark_states(bones::BoneKind kind) const {
  return knee_.landmark_states.at(kind);
}

void PlanModel::set_landmarks(bones::BoneKind kind, landmarks::Landmarks landmarks,
                              landmarks::LandmarkStates states) {
  knee_.landmarks[kind] = std::move(landmarks);
  knee_.landmark_states[kind] = std::move(states);
  use_landmarks(kind);
  ++revision_;
}

const std::optional<landmarks::Proposal>& PlanModel::proposal(bones::BoneKind kind) const {
  const BoneModel& bone = bones_.at(kind);
  if (bone.proposal) return bone.proposal;
  // The surface keeps the mesh, whatever becomes of this model.
  return late_proposals_[kind].ask([surface = bone.review.surface, kind, side = knee_.side,
                                    stop = ending_->stop.get_token()] {
    return landmarks::propose(surface->mesh(), kind, {.side = side, .surface = surface.get(), .stop = stop});
  });
}

const std::shared_ptr<const geometry::TriangleMesh>& PlanModel::moving_mesh(bones::BoneKind kind) const {
  const auto& drawn = drawn_mesh(kind);
  const auto& made = late_moving_[kind].ask([drawn] { return scene::simplified(*drawn, kMovingTriangles); });
  return made ? *made : drawn;
}

default_plan::DefaultTunnel PlanModel::default_tunnel(const tunnels::TunnelKey& key,
                                                      const std::stop_token& stop) const {
  const bones::BoneKind kind = key.bone;
  const BoneModel& bone = bones_.at(kind);
  return default_plan::plan_bone(
      {.bone = &knee_.bones.at(kind),
       .surface = bone.review.surface.get(),
       .landmarks = landmarks(kind),
       .states = landmark_states(kind),
       // Both bundles of a bone are made at once: each leaves the other's default its room, whatever is
       // there.
       .proposal = bone.proposal ? &*bone.proposal : nullptr,
       .unseen = bone.review.surroundings.unseen},
      knee_.side,
      {.bundle = key.bundle, .diameter_mm = tunnels::usual_diameter_mm(key.bundle), .stop = stop});
}

std::optional<tunnels::Tunnel> PlanModel::tunnel(const tunnels::TunnelKey& key) const {
  const auto found = knee_.plan.tunnels.find(key);
  if (found == knee_.plan.tunnels.end()) return std::nullopt;
  return found->second;
}

const tunnels::TunnelGeometry& PlanModel::measured(const tunnels::TunnelKey& key) const {
  static const tunnels::TunnelGeometry none;
  const auto found = measured_.find(key);
  return found == measured_.end() ? none : found->second.geometry;
}

const std::vector<tunnels::PlanCheck>& PlanModel::checks(const tunnels::TunnelKey& key) const {
  Checked& checked = checked_[key];
  const bool by_shape = measured_.contains(key) && proposal(key.bone).has_value();
  if (checked.revision != revision_ || checked.by_shape != by_shape)
    checked = {revision_, by_shape, check(key)};
  return checked.checks;
}

std::vector<tunnels::PlanCheck> PlanModel::check(const tunnels::TunnelKey& key) const {
  if (!measured_.contains(key)) return {};
  auto checks = plan_review::checks_of(key, measured_, surroundings(key.bone), knee_surroundings_,
                                       landmark_check(key.bone));
  if (const cases::PlanFit fit = plan_fit(key); !fit.is_valid()) {
    checks.insert(checks.begin(), {.verdict = tunnels::PlanCheck::Verdict::Wrong,
                                   .name = "Bone",
                                   .text = fit.reason + ": place the entry anew",
                                   .source = ""});
  }
  return checks;
}

tunnels::PlanCheck PlanModel::landmark_check(bones::BoneKind kind) const {
  const auto& by_shape = proposal(kind);
  return plan_review::check_landmarks(kind, landmarks(kind), landmark_states(kind),
                                      by_shape ? &*by_shape : nullptr);
}

cases::PlanFit PlanModel::plan_fit(const tunnels::TunnelKey& key) const { return plan_fit(knee_.plan, key); }

cases::PlanFit PlanModel::plan_fit(const cases::Plan& plan, const tunnels::TunnelKey& key) const {
  const auto bone = bones_.find(key.bone);
  return cases::plan_fit(plan, key, bone == bones_.end() ? "" : bone->second.mesh_sha256);
}

double PlanModel::drawn_length_mm(const tunnels::TunnelKey& key) const {
  constexpr double kLengthOfOneThatMisses_mm = 30;
  const tunnels::TunnelGeometry& geometry = measured(key);
  return geometry.enters_bone ? geometry.length_mm : kLengthOfOneThatMisses_mm;
}

geometry::Bounds PlanModel::bounds(std::optional<bones::BoneKind> only) const {
  if (only && has_bone(*only)) return bones_.at(*only).bounds;
  geometry::Bounds all = bones_.begin()->second.bounds;
  for (const auto& [kind, bone] : bones_) all = joined(all, bone.bounds);
  return all;
}

geometry::Bounds PlanModel::joint_bounds(std::optional<bones::BoneKind> only) const {
  if (only && has_bone(*only)) return bones_.at(*only).joint_bounds;
  geometry::Bounds all = bones_.begin()->second.joint_bounds;
  for (const auto& [kind, bone] : bones_) all = joined(all, bone.joint_bounds);
  return all;
}

std::optional<scene::CutPlane> PlanModel::notch_cut() const {
  const auto femur = knee_.bones.find(bones::BoneKind::Femur);
  if (femur == knee_.bones.end() || !has_bone(bones::BoneKind::Femur)) return std::nullopt;
  return scene::notch_cut(femur->second.mesh, axes(bones::BoneKind::Femur),
                          landmarks(bones::BoneKind::Femur));
}

void PlanModel::set_tunnel(const tunnels::TunnelKey& key, const std::optional<tunnels::Tunnel>& tunnel) {
  cases::Plan plan = knee_.plan;
  const auto before = this->tunnel(key);
  if (tunnel) {
    tunnels::Tunnel named = *tunnel;
    named.bone = key.bone;
    named.bundle = key.bundle;
    const bool is_placed = !before || before->entry_mm != tunnel->entry_mm;
    plan.put(named, is_placed ? bones_.at(key.bone).mesh_sha256 : plan.mesh_sha256[key]);
  } else {
    plan.remove(key);
  }
  set_plan(plan);
}

void PlanModel::set_plan(const cases::Plan& plan) {
  knee_.plan = plan;
  measure();  // about a millisecond each
  ++revision_;
}

void PlanModel::set_measurements(std::vector<cases::Measurement> measurements) {
  measurements_ = std::move(measurements);
  ++revision_;
}

void PlanModel::measure() {
  measured_.clear();
  for (const auto& [key, tunnel] : knee_.plan.tunnels) {
    if (!has_bone(key.bone)) continue;
    measured_.emplace(key, plan_review::MeasuredTunnel{tunnel, tunnels::measure(tunnel, surface(key.bone))});
  }
}

}  // namespace arthronaut::open_case
