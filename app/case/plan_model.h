// The open case as the plan mode sees it: the bones made ready for drawing and for exact queries, the tunnels
// and what was measured of them. The one place where the plan lives while the program runs; it changes
// through set_tunnel and set_plan alone; what was measured through set_measurements.
//
// Each tunnel names the mesh that it was planned on (cases::PlanFit). One of an older file, which names none,
// is taken to be of the mesh that it is opened with.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/scene_content.h"
#include "planning/cases/case.h"
#include "planning/cases/measurements.h"
#include "planning/default_plan/default_plan.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/landmarks/propose.h"
#include "planning/plan_review/plan_review.h"

namespace arthronaut::open_case {

class PlanModel {
 public:
  // Proposes landmarks of a bone that the case has no grid for, or one that nobody confirmed: half a second
  // each, for a job. Throws InvalidInput when the case has no bone, and once `stop` asks for it. tell: from
  // any thread, which share of this is done, 0 to 1.
  explicit PlanModel(cases::Case knee, const std::stop_token& stop = {},
                     const std::function<void(double done)>& tell = nullptr);

  [[nodiscard]] const cases::Case& knee() const { return knee_; }
  [[nodiscard]] bool has_bone(bones::BoneKind kind) const { return bones_.contains(kind); }
  // Of the whole mesh, see bones::mesh_sha256. Precondition: has_bone(kind).
  [[nodiscard]] const std::string& mesh_sha256(bones::BoneKind kind) const {
    return bones_.at(kind).mesh_sha256;
  }
  // Preconditions of these three: has_bone(kind).
  [[nodiscard]] const geometry::Surface& surface(bones::BoneKind kind) const {
    return *bones_.at(kind).review.surface;
  }
  [[nodiscard]] std::shared_ptr<const geometry::Surface> shared_surface(bones::BoneKind kind) const {
    return bones_.at(kind).review.surface;
  }
  [[nodiscard]] const std::shared_ptr<const geometry::TriangleMesh>& drawn_mesh(bones::BoneKind kind) const {
    return bones_.at(kind).drawn;
  }
  // Far coarser, for a view that moves where the processor draws: there each triangle costs. Begun beside the
  // caller by the first who asks, and drawn_mesh() until it is there.
  [[nodiscard]] const std::shared_ptr<const geometry::TriangleMesh>& moving_mesh(bones::BoneKind kind) const;

  [[nodiscard]] std::optional<tunnels::Tunnel> tunnel(const tunnels::TunnelKey& key) const;
  // As planned and measured, all on bones of the case.
  [[nodiscard]] const plan_review::MeasuredPlan& tunnels() const { return measured_; }
  // Meaningful with a tunnel.
  [[nodiscard]] const tunnels::TunnelGeometry& measured(const tunnels::TunnelKey& key) const;
  // Which way is anterior, proximal and lateral, and what else the checks know of the bone. Precondition:
  // has_bone(kind).
  [[nodiscard]] const tunnels::PlanSurroundings& surroundings(bones::BoneKind kind) const {
    return bones_.at(kind).review.surroundings;
  }
  // What the checks know of the knee beside its tunnels.
  [[nodiscard]] const tunnels::KneeSurroundings& knee_surroundings() const { return knee_surroundings_; }
  // Those of the tunnel, of the two of its bone, and of the whole knee that concern it. Empty without a
  // tunnel. That it was planned on another mesh is the first check, and a wrong one. Made when first asked
  // after a change; the reference holds until the next change.
  [[nodiscard]] const std::vector<tunnels::PlanCheck>& checks(const tunnels::TunnelKey& key) const;
  // Whether the bone's landmarks lie where its shape puts them; not checked while proposal() is not there.
  // Precondition: has_bone(kind).
  [[nodiscard]] tunnels::PlanCheck landmark_check(bones::BoneKind kind) const;
  // Whether the tunnel is of the bone's mesh: what is not valid must not be guided by.
  [[nodiscard]] cases::PlanFit plan_fit(const tunnels::TunnelKey& key) const;
  // Of another plan, as one that was kept, against the bones of now.
  [[nodiscard]] cases::PlanFit plan_fit(const cases::Plan& plan, const tunnels::TunnelKey& key) const;
  // How far a tunnel is drawn: through the bone, or 30 mm where it misses.
  [[nodiscard]] double drawn_length_mm(const tunnels::TunnelKey& key) const;
  [[nodiscard]] geometry::Bounds bounds(std::optional<bones::BoneKind> only) const;
  // What a surgeon looks at of them: within 80 mm of the joint, along the bone, of a bone that may be whole.
  [[nodiscard]] geometry::Bounds joint_bounds(std::optional<bones::BoneKind> only) const;
  // Which way is anterior, proximal and lateral. Precondition: has_bone(kind).
  [[nodiscard]] const landmarks::AnatomicalAxes& axes(bones::BoneKind kind) const {
    return bones_.at(kind).axes;
  }
  // The named points that are planned by: the case's own, and proposed ones where it has none. Preconditions
  // as above.
  [[nodiscard]] const landmarks::Landmarks& landmarks(bones::BoneKind kind) const;
  [[nodiscard]] const landmarks::LandmarkStates& landmark_states(bones::BoneKind kind) const;
  // Whether the bone's landmarks were completed by proposed ones when the case was opened: its file has none
  // that give a grid.
  [[nodiscard]] bool was_proposed(bones::BoneKind kind) const { return bones_.at(kind).was_proposed; }
  // What the shape alone gives, with its doubts. Where somebody confirmed what the grid asks for nothing
  // waits for it: it is begun, beside the caller, by the first who asks, and nullopt for the seconds until it
  // is there.
  [[nodiscard]] const std::optional<landmarks::Proposal>& proposal(bones::BoneKind kind) const;
  // Where the ligament, or the bundle, is expected by the norm; null where the landmarks give no grid.
  // Precondition: has_bone(key.bone).
  [[nodiscard]] const norms::ExpectedFootprint* footprint(const tunnels::TunnelKey& key) const {
    const auto& footprints = bones_.at(key.bone).review.footprints;
    const auto found = footprints.find(key.bundle);
    return found == footprints.end() ? nullptr : &found->second;
  }
  // A tunnel by norms and landmarks; read the outcome. Takes a moment.
  [[nodiscard]] default_plan::DefaultTunnel default_tunnel(const tunnels::TunnelKey& key,
                                                           const std::stop_token& stop = {}) const;
  // Where nobody has seen the bone (cases::unseen_parts_of). Precondition: has_bone(kind).
  void set_unseen(bones::BoneKind kind, bones::UnseenParts unseen);
  void set_landmarks(bones::BoneKind kind, landmarks::Landmarks landmarks, landmarks::LandmarkStates states);
  // Where the femur is cut open to see the lateral wall of its notch; nullopt without a femur.
  [[nodiscard]] std::optional<scene::CutPlane> notch_cut() const;

  // nullopt removes the tunnel. A single one takes the place of both bundles', one of a bundle that of a
  // single one (cases::Plan::put); its key is `key`, whatever it says. One with another entry is planned on
  // this case's mesh, where its entry was put; one that was only turned or widened stays of the mesh that it
  // was of. Precondition: has_bone(kind).
  void set_tunnel(const tunnels::TunnelKey& key, const std::optional<tunnels::Tunnel>& tunnel);
  // As it is, with the meshes that it names: for undo.
  void set_plan(const cases::Plan& plan);
  // Distances and angles that were measured in this case.
  [[nodiscard]] const std::vector<cases::Measurement>& measurements() const { return measurements_; }
  void set_measurements(std::vector<cases::Measurement> measurements);
  [[nodiscard]] std::uint64_t revision() const { return revision_; }  // counts the changes
  // For whoever starts work on what is on the disk: saves what is not saved yet. Why it could not be, else
  // empty; also where nobody saves this model.
  [[nodiscard]] std::string save_now() const { return saver_ ? saver_() : std::string(); }
  // By whom it is saved: PlanHistory.
  void set_saver(std::function<std::string()> saver) { saver_ = std::move(saver); }

 private:
  struct BoneModel {
    std::shared_ptr<const geometry::TriangleMesh> drawn;
    plan_review::ReviewedBone review;
    geometry::Bounds bounds, joint_bounds;
    landmarks::AnatomicalAxes axes;
    std::optional<landmarks::Proposal> proposal;
    std::string mesh_sha256;
    bool was_proposed = false;
  };
  // What is made in a thread of its own, begun by the first who asks.
  template <typename Thing>
  struct Late {
    template <typename Make>
    const std::optional<Thing>& ask(Make make) {
      if (!coming.valid()) coming = std::async(std::launch::async, std::move(make));
      if (!there && coming.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        there = coming.get();
      return there;
    }
    std::shared_future<Thing> coming;
    std::optional<Thing> there;
  };
  // What is still in the making when the last copy of the model goes is asked to end.
  struct Ending {
    ~Ending() { stop.request_stop(); }
    std::stop_source stop;
  };
  struct Checked {
    std::uint64_t revision = 0;
    bool by_shape = false;  // what the shape gives was there
    std::vector<tunnels::PlanCheck> checks;
  };
  [[nodiscard]] std::vector<tunnels::PlanCheck> check(const tunnels::TunnelKey& key) const;
  void measure();
  void use_landmarks(bones::BoneKind kind);  // what follows from them

  cases::Case knee_;
  std::map<bones::BoneKind, BoneModel> bones_;
  std::vector<cases::Measurement> measurements_;
  plan_review::MeasuredPlan measured_;
  tunnels::KneeSurroundings knee_surroundings_;
  std::uint64_t revision_ = 1;
  std::function<std::string()> saver_;
  // Every frame asks, and every change costs a dozen milliseconds.
  mutable std::map<tunnels::TunnelKey, Checked> checked_;
  mutable std::map<bones::BoneKind, Late<landmarks::Proposal>> late_proposals_;
  mutable std::map<bones::BoneKind, Late<std::shared_ptr<const geometry::TriangleMesh>>> late_moving_;
  std::shared_ptr<Ending> ending_ = std::make_shared<Ending>();  // last: before those are waited for
};

}  // namespace arthronaut::open_case
