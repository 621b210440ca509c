#include "app/paint/paint_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/scene/lateral_plane.h"
#include "app/scene/scene_camera.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/painting/label_edits.h"
#include "planning/segmentation/ct_bones.h"
#include "planning/segmentation/dark_rim.h"

namespace arthronaut::paint {

using painting::Layer;

namespace {

// A hand that goes on painting is not grown after in between.
constexpr double kRestBeforeGrowth_s = 0.25;
constexpr double kAspect = 1.4;

}  // namespace

PaintView::PaintView(PaintCallbacks callbacks)
    : callbacks_(std::move(callbacks)),
      store_(callbacks_.wake),
      job_(callbacks_.wake),
      making_(callbacks_.wake),
      panes_{plan::SlicePane("Axial", Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()),
             plan::SlicePane("Coronal", Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ()),
             plan::SlicePane("Sagittal", Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ())},
      model_(callbacks_.make_current) {}

void PaintView::open(const cases::Case& knee, const std::filesystem::path& case_folder, bool read_only) {
  // Of one that another program had until now that program may have painted more.
  const bool is_same =
      case_folder == case_folder_ && read_only == is_read_only_ && (is_ready() || store_.is_loading());
  knee_ = knee;
  knee_.bones.clear();  // the meshes go to the store
  is_read_only_ = read_only;
  if (making_.state() == BoneMaking::State::Done) making_.forget();
  if (is_same) return;
  case_folder_ = case_folder;
  painting_.reset();
  previewing_ = {};
  brushing_ = {};
  keys_ = {};
  look_ = {};
  hint_.clear();
  job_.cancel();
  making_.cancel();
  const auto image = image_to_paint(knee);
  std::vector<CaseBone> bones;
  joint_.reset();
  for (const auto& [kind, bone] : knee.bones) {
    if (bone.mesh.empty()) continue;
    bones.push_back({kind, std::make_shared<const geometry::TriangleMesh>(bone.mesh)});
    const auto marks = knee.landmarks.find(kind);
    const auto axes = landmarks::anatomical_axes(
        kind, knee.side, marks != knee.landmarks.end() ? marks->second : landmarks::Landmarks{}, bone.mesh);
    const geometry::Bounds of_bone = scene::joint_bounds(bone.mesh, kind, axes);
    joint_ = joint_ ? geometry::Bounds{joint_->min_mm.cwiseMin(of_bone.min_mm),
                                       joint_->max_mm.cwiseMax(of_bone.max_mm)}
                    : of_bone;
  }
  if (image) store_.open(case_folder, *image, read_only, std::move(bones));
}

void PaintView::close() {
  leave();
  job_.cancel();
  making_.cancel();
  case_folder_.clear();
  painting_.reset();
  previewing_ = {};
}

void PaintView::leave() {
  keys_.is_down = false;
  if (is_ready()) store_.keep_now(*painting_);
}

bool PaintView::is_busy() const {
  const BoneMaking::State making = making_.state();
  return store_.is_loading() || job_.is_running() || making == BoneMaking::State::Making ||
         making == BoneMaking::State::Saving ||
         (is_ready() && !is_read_only_ && !store_.is_saved(*painting_));
}

bool PaintView::can_edit() const {
  const BoneMaking::State making = making_.state();
  return is_ready() && !is_read_only_ && store_.may_save() &&
         (making == BoneMaking::State::Idle || making == BoneMaking::State::Done);
}

bool PaintView::is_working() const {
  return job_.is_running() || making_.state() == BoneMaking::State::Making;
}

bool PaintView::can_stop() const { return is_working() || previewing_.kind != Preview::None || is_judging(); }

void PaintView::tick(double now_s) {
  if (auto loaded = store_.take_loaded()) {
    painting_ = std::move(loaded);
    const images::Volume& volume = painting_->volume();
    look_.automatic = scene::automatic_window(volume);
    look_.window = volume.modality == images::Modality::Ct ? scene::kBoneWindow : look_.automatic;
    look_.cross_mm =
        volume.lps_from_index * Eigen::Vector3d(0.5 * (volume.size - Eigen::Vector3i::Ones()).cast<double>());
    for (plan::SlicePane& pane : panes_) pane.fit(volume);
    if (joint_) {  // where the bones are, rather than somewhere in a scan of both legs
      constexpr double kAround = 1.15;
      look_.cross_mm = joint_->center_mm();
      for (plan::SlicePane& pane : panes_) pane.show(look_.cross_mm, kAround * joint_->size_mm().maxCoeff());
    }
    keys_.pane = sharpest_pane();
    if (!painting_->holds(Layer::Strokes) && painting_->holds(Layer::Bones)) brushing_.layer = Layer::Bones;
    previewing_.threshold = segmentation::CtBonesOptions{}.threshold_for(volume);
  }
  take_job();
  const BoneMaking::State before = making_.state();
  making_.poll();
  if (before == BoneMaking::State::Making && is_judging()) {
    ++look_.judged;
    scene::SceneContent content;
    std::optional<geometry::Bounds> bounds;
    for (const importing::ImportedBone& made : making_.result().bones) {
      content.bones.push_back({scene::simplified(made.bone.mesh, 60'000)});
      const geometry::Bounds of_bone = geometry::bounds_of(made.bone.mesh);
      if (!bounds) bounds = of_bone;
      bounds->min_mm = bounds->min_mm.cwiseMin(of_bone.min_mm);
      bounds->max_mm = bounds->max_mm.cwiseMax(of_bone.max_mm);
    }
    model_.show(content);
    if (bounds) model_.look(scene::look_from(scene::ViewDirection::Anterior, knee_.side, *bounds, kAspect));
  }
  if (before == BoneMaking::State::Saving && making_.state() == BoneMaking::State::Done) {
    if (is_ready()) store_.note_made(*painting_);
    callbacks_.bones_made();
  }
  if (!is_ready()) return;
  if (painting_->revision() != previewing_.seen_revision) {
    previewing_.seen_revision = painting_->revision();
    previewing_.changed_at_s = now_s;
  }
  const bool is_stale =
      previewing_.kind == Preview::Growth && previewing_.of_revision != painting_->revision();
  if (is_stale && !job_.is_running() && now_s - previewing_.changed_at_s > kRestBeforeGrowth_s) grow();
  store_.keep(*painting_, now_s);
}

void PaintView::begin_growth() {
  hint_.clear();
  previewing_.kind = Preview::Growth;
  previewing_.grown.clear();
  grow();
}

void PaintView::grow() {
  if (job_.is_running()) return;
  previewing_.of_revision = painting_->revision();
  job_.start("Growing", [volume = painting_->shared_volume(),
                         strokes = painting_->labels(Layer::Strokes)](const LabelJob::Tell& tell) {
    painting::Labels grown = segmentation::grow_from_seeds(*volume, strokes, {.on_progress = tell});
    for (const auto& [bone, other] :
         {std::pair{painting::kFemur, painting::kTibia}, std::pair{painting::kTibia, painting::kFemur}})
      (void)segmentation::take_in_dark_rim(grown, *volume, bone, std::array{other}, strokes);
    std::replace(grown.begin(), grown.end(), painting::kSurroundings, painting::kNothing);
    return grown;
  });
}

void PaintView::begin_threshold() {
  hint_.clear();
  job_.cancel();
  previewing_.kind = Preview::Threshold;
  if (brushing_.label != painting::kTibia) brushing_.label = painting::kFemur;
  ++look_.labels_revision;
}

void PaintView::take_preview() {
  if (previewing_.kind == Preview::Growth) {
    painting_->put(Layer::Bones, previewing_.grown, "Grow the bones");
  } else if (previewing_.kind == Preview::Threshold) {
    edit("Take the threshold of " + widgets::fixed(previewing_.threshold, 0),
         [threshold = static_cast<float>(previewing_.threshold), label = brushing_.label](
             painting::Labels& labels, const images::Volume& volume) {
           painting::add_above(labels, volume, threshold, label);
         });
  }
  drop_preview();
  brushing_.layer = Layer::Bones;
}

void PaintView::drop_preview() {
  if (previewing_.kind == Preview::Growth) job_.cancel();
  previewing_.kind = Preview::None;
  previewing_.grown = {};
  ++look_.labels_revision;
}

void PaintView::edit(const std::string& what,
                     std::function<void(painting::Labels&, const images::Volume&)> change) {
  if (job_.is_running()) return;
  hint_.clear();
  brushing_.layer = Layer::Bones;
  job_.start(what, [volume = painting_->shared_volume(), labels = painting_->labels(Layer::Bones),
                    change = std::move(change)](const LabelJob::Tell&) mutable {
    change(labels, *volume);
    return std::move(labels);
  });
}

void PaintView::take_job() {
  const auto done = job_.take();
  if (!done || !is_ready() || done->labels.size() != painting_->volume().values.size()) {
    if (done && !done->failure.empty()) {
      hint_ = done->failure;
      if (previewing_.kind == Preview::Growth) previewing_.kind = Preview::None;
    }
    return;
  }
  if (previewing_.kind == Preview::Growth) {
    previewing_.grown = done->labels;
    ++look_.labels_revision;
    return;
  }
  const std::size_t before = painting_->step_count();
  const std::uint64_t revision = painting_->revision();
  painting_->put(Layer::Bones, done->labels, done->what);
  if (painting_->step_count() == before && painting_->revision() == revision)
    hint_ = done->what + ": nothing changed";
}

void PaintView::make_bones() {
  const std::vector<bones::BoneKind> unchanged = store_.unchanged(*painting_);
  hint_ = BoneMaking::refusal(knee_, *painting_, unchanged);
  if (!hint_.empty()) return;
  drop_preview();
  store_.keep_now(*painting_);
  if (hint_ = store_.failure(); !hint_.empty()) return;
  making_.start(knee_, case_folder_, *image_to_paint(knee_), *painting_, unchanged);
}

void PaintView::follow(std::size_t pane, const plan::SliceEvent& event) {
  if (event.cross_mm) look_.cross_mm = *event.cross_mm;
  if (event.window) look_.window = *event.window;
  if (event.brush_steps != 0)
    brushing_.brush.radius_mm =
        std::clamp(brushing_.brush.radius_mm * std::pow(1.2, event.brush_steps), 0.3, 40.0);
  if (event.painted) (void)paint(pane, *event.painted);
}

bool PaintView::paint(std::size_t pane, const plan::SliceEvent::Painted& drawn) {
  if (!can_edit()) return false;
  // A whole-map edit that runs would be painted over by what it began with.
  if (brushing_.layer == Layer::Bones && job_.is_running()) {
    hint_ = "Wait until " + job_.what() + " is done, or stop it with Esc";
    return false;
  }
  if (drawn.begins) hint_.clear();
  brushing_.pane = pane;
  std::uint8_t label = brushing_.label;
  const std::string where = brushing_.layer == Layer::Strokes ? "stroke" : "bone";
  painting_->paint(
      brushing_.layer, {drawn.from_mm, drawn.to_mm, panes_[pane].normal(), brushing_.brush}, label,
      label == painting::kNothing ? "Erase " + where : "Paint " + label_name(label) + " " + where,
      !drawn.begins);
  return true;
}

}  // namespace arthronaut::paint
