#include "app/navigate/theatre_bones.h"

#include <algorithm>

#include "app/scene/tool_clearance.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {

namespace {

using operation::OperationState;
using operation::PlannedTunnel;

// Projects what lies over a picture, on the operation's thread: prepared for one bone and the plan in force.
class LineMaker {
 public:
  LineMaker(std::shared_ptr<const geometry::Surface> surface,
            std::shared_ptr<const geometry::TriangleMesh> drawn)
      : surface_(std::move(surface)), drawn_(std::move(drawn)) {}

  std::shared_ptr<const theatre::Decoration> operator()(const OperationState& state) {
    const pipeline::FrameResult& frame = state.frame;
    if (!frame.camera_from_world.is_valid) return nullptr;
    auto made = std::make_shared<PictureLines>();
    const geometry::RigidTransform& camera_from_world = frame.camera_from_world.target_from_source;
    const std::vector<scene::ClearDisc> clear = scene::clear_discs_of(frame, state.source->pipeline.tools);
    const operation::RegistrationInForce& in_force = state.registration->in_force;
    const bool may_guide = state.time_out != operation::TimeOut::Due;
    if (in_force.standing == operation::Standing::Stands && may_guide) {
      prepare(state.plan);
      made->plan =
          model_->project(frame.camera, camera_from_world * in_force.registration->marker_from_bone, clear);
    }
    points_.clear();
    for (const strokes::CurvePoint& point : *state.registration->drawn)
      points_.push_back(camera_from_world * point.position_mm);
    // Strokes of before lie where they lay once a touch has shown that the marker does.
    if (state.resumed != nullptr && in_force.standing == operation::Standing::Stands &&
        (*state.registration->history)[*state.registration->entry_in_force].origin ==
            operation::RegistrationOrigin::Resumed)
      for (const strokes::CurvePoint& point : state.resumed->drawn)
        points_.push_back(camera_from_world * point.position_mm);
    scene::add_curves(made->touched, frame.camera, points_, strokes::StrokeOptions{}.max_hop_mm, clear);
    return made;
  }

 private:
  void prepare(const std::optional<PlannedTunnel>& plan) {
    if (model_ && plan == plan_) return;
    plan_ = plan;
    model_.emplace(surface_, *drawn_, plan ? std::optional(plan->tunnel) : std::nullopt,
                   plan ? plan->length_mm : 0);
  }

  std::shared_ptr<const geometry::Surface> surface_;
  std::shared_ptr<const geometry::TriangleMesh> drawn_;
  std::optional<PlannedTunnel> plan_;
  std::optional<scene::OverlayModel> model_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

void TheatreBones::open(const open_case::PlanModel* model, const std::filesystem::path& case_folder,
                        const std::string& read_only) {
  for (auto& [kind, bone] : bones_)
    if (bone.operation != nullptr) bone.operation->request_stop();
  // A bone that is just being made ready would be waited for.
  ending_.end(std::exchange(bones_, {}));
  chosen_.clear();
  left_.clear();
  keeps_video_ = false;  // of another case nobody has asked for it
  model_ = model;
  case_folder_ = case_folder;
  read_only_ = read_only;
}

std::optional<tunnels::TunnelKey> TheatreBones::guided(bones::BoneKind bone) const {
  const auto keys = model_->knee().plan.of(bone);
  if (const auto chosen = chosen_.find(bone);
      chosen != chosen_.end() && std::ranges::find(keys, chosen->second) != keys.end())
    return chosen->second;
  if (const auto kept = in_force_of_source(bone); kept && std::ranges::find(keys, *kept) != keys.end())
    return kept;
  return keys.size() == 1 ? std::optional(keys.front()) : std::nullopt;
}

bool TheatreBones::must_choose(bones::BoneKind bone) const {
  return !guided(bone) && !model_->knee().plan.of(bone).empty();
}

std::optional<tunnels::TunnelKey> TheatreBones::in_force_of_source(bones::BoneKind bone) const {
  const theatre::LiveOperation* const operation = known(bone);
  if (operation == nullptr) return std::nullopt;
  const theatre::LiveStatePtr state = operation->latest();
  const auto& plan = state->operation->plan;
  return state->operation->has_source && plan ? std::optional(plan->tunnel.key()) : std::nullopt;
}

void TheatreBones::choose(const tunnels::TunnelKey& key) {
  chosen_.insert_or_assign(key.bone, key);
  if (const auto bone = bones_.find(key.bone); bone != bones_.end()) offer_plan(key.bone, bone->second);
}

std::optional<PlannedTunnel> TheatreBones::plan_of(bones::BoneKind bone) const {
  const auto key = guided(bone);
  return key ? planned(*key) : std::nullopt;
}

std::optional<PlannedTunnel> TheatreBones::planned(const tunnels::TunnelKey& key) const {
  const auto tunnel = model_->tunnel(key);
  // One that was made on another surface would lie somewhere else in this one: nothing guides to it.
  if (!tunnel || !model_->plan_fit(key).is_valid()) return std::nullopt;
  return PlannedTunnel{*tunnel, model_->drawn_length_mm(key)};
}

std::unique_ptr<theatre::LiveOperation> TheatreBones::made(bones::BoneKind bone) const {
  const geometry::TriangleMesh& mesh = model_->knee().bones.at(bone).mesh;
  theatre::LiveOptions options;
  options.operation.bone = bone;
  options.operation.mesh_sha256 = bones::mesh_sha256(mesh);
  options.operation.surface = model_->shared_surface(bone);
  options.operation.plan = plan_of(bone);
  const bool has_folder = !case_folder_.empty();
  const auto cache = has_folder ? cases::surface_index_file(case_folder_, bone) : std::filesystem::path();
  std::string cartilage_trouble;
  try {
    if (has_folder)
      if (const auto cartilage = cases::load_cartilage(case_folder_, bone))
        options.operation.cartilage.emplace().points_mm = cartilage->vertices_mm;
  } catch (
      const std::runtime_error& error) {  // without what it declares the bone would be registered wrongly
    cartilage_trouble = error.what();
  }
  options.bone = [mesh, cache, cartilage_trouble]() -> operation::SurfaceIndexPtr {
    if (!cartilage_trouble.empty()) throw std::runtime_error(cartilage_trouble);
    return cache.empty() ? std::make_shared<registration::SurfaceIndex>(mesh)
                         : std::make_shared<registration::SurfaceIndex>(mesh, cache);
  };
  if (has_folder)
    options.make_session_folder = [folder = case_folder_, why_not = read_only_] {
      if (!why_not.empty()) throw IoError("the case is open read-only: it " + why_not);
      return cases::create_session_folder(folder);
    };
  options.tell = tell_;
  options.decorate = [maker =
                          std::make_shared<LineMaker>(options.operation.surface, model_->drawn_mesh(bone))](
                         const OperationState& state) { return (*maker)(state); };
  return std::make_unique<theatre::LiveOperation>(std::move(options), wake_);
}

bool TheatreBones::is_worth_keeping(const theatre::LiveState& state) {
  const operation::RegistrationState& known = *state.operation->registration;
  return state.operation->has_source || state.operation->resumed != nullptr || known.point_count > 0 ||
         !known.history->empty();
}

theatre::LiveOperation& TheatreBones::operation(bones::BoneKind kind) {
  Bone& bone = bones_[kind];
  if (bone.operation != nullptr) {
    const theatre::LiveStatePtr state = bone.operation->latest();
    const bool is_broken = !state->operation->registration->bone_trouble.empty();
    if (is_worth_keeping(*state) || (!is_broken && (bone.is_used || is_told(kind, bone))))
      return *bone.operation;
    bone.operation->request_stop();
    ending_.end(std::move(bone.operation));
  }
  bone.operation = made(kind);
  bone.operation->keep_pictures_as(pictures_as_);
  if (keeps_video_) bone.operation->keep_video(true);
  if (const auto left = left_.find(kind); left != left_.end()) bone.operation->goes_on_after(left->second);
  bone.is_used = false;
  note_told(kind, bone);
  return *bone.operation;
}

theatre::LiveOperation& TheatreBones::used(bones::BoneKind kind) {
  theatre::LiveOperation& used = operation(kind);
  bones_.at(kind).is_used = true;
  return used;
}

theatre::LiveOperation* TheatreBones::known(bones::BoneKind kind) const {
  const auto found = bones_.find(kind);
  return found == bones_.end() ? nullptr : found->second.operation.get();
}

theatre::LiveStatePtr TheatreBones::nothing() {
  auto state = std::make_shared<theatre::LiveState>();
  state->operation = std::make_shared<const OperationState>();
  return state;
}

void TheatreBones::go_on_after(const std::map<bones::BoneKind, std::filesystem::path>& left) {
  if (!read_only_.empty()) return;
  left_ = left;
  for (const auto& [kind, session_folder] : left_)
    if (theatre::LiveOperation* const operation = known(kind)) operation->goes_on_after(session_folder);
}

void TheatreBones::keep_video(bool on) {
  keeps_video_ = on;
  for (auto& [kind, bone] : bones_)
    if (bone.operation != nullptr) bone.operation->keep_video(on);
}

void TheatreBones::keep_pictures_as(recording::PicturesAs as) {
  pictures_as_ = as;
  for (auto& [kind, bone] : bones_)
    if (bone.operation != nullptr) bone.operation->keep_pictures_as(as);
}

void TheatreBones::offer_plans() {
  for (auto& [kind, bone] : bones_) offer_plan(kind, bone);
}

void TheatreBones::offer_plan(bones::BoneKind kind, Bone& bone) {
  if (bone.operation == nullptr || is_told(kind, bone)) return;
  // Made anew when it is asked for next: its registration is to aim at the plan from the first stroke on.
  if (!bone.is_used && !is_worth_keeping(*bone.operation->latest())) return;
  note_told(kind, bone);
  bone.operation->apply(operation::OfferPlan{plan_of(kind)});
}

bool TheatreBones::is_told(bones::BoneKind kind, const Bone& bone) const {
  return bone.plan_revision == model_->revision() && bone.told == guided(kind);
}

void TheatreBones::note_told(bones::BoneKind kind, Bone& bone) const {
  bone.plan_revision = model_->revision();
  bone.told = guided(kind);
}

}  // namespace arthronaut::navigate
