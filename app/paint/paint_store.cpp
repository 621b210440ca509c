#include "app/paint/paint_store.h"

#include <utility>

#include "planning/cases/case_image.h"
#include "planning/painting/bone_labels.h"

namespace arthronaut::paint {

namespace {

struct Stopped {};

// A hand that draws one stroke after the other is not waited for longer than it pauses.
constexpr double kRest_s = 0.4;
// A disk that was full is asked again.
constexpr double kTryAgain_s = 5;

}  // namespace

std::optional<cases::CaseImage> image_to_paint(const cases::Case& knee) {
  std::optional<cases::CaseImage> image;
  for (const cases::CaseImage& other : knee.images)
    if (!other.is_label_map) image = other;
  return image;
}

PaintStore::PaintStore(std::function<void()> wake) : wake_(std::move(wake)) {}

PaintStore::~PaintStore() { stops_ = true; }

void PaintStore::open(const std::filesystem::path& case_folder, const cases::CaseImage& image, bool read_only,
                      std::vector<CaseBone> case_bones) {
  stops_ = true;
  loading_.drop();
  stops_ = false;
  if (saver_ != nullptr) saver_->finish();
  // A worker of its own: what one case's saving failed of says nothing of the next.
  saver_ = std::make_unique<worker::Worker<Snapshot, Saved>>(
      worker::Backlog::NewestWins,
      [](auto& inbox) {
        while (auto snapshot = inbox.next()) {
          Saved saved{snapshot->revision, ""};
          try {  // the top of the saving thread: a full disk is a state of the screen
            painting::save_painting(snapshot->folder, *snapshot->volume, snapshot->painting);
          } catch (const std::exception& error) {
            saved.failure = error.what();
          }
          inbox.publish(std::move(saved));
        }
      },
      wake_);
  folder_ = case_folder;
  is_read_only_ = read_only;
  failure_.clear();
  loaded_ = 0;
  loading_.start(
      [this, folder = case_folder, image, bones = std::move(case_bones)] {
        Loaded loaded;
        try {  // the top of the loading thread
          auto volume =
              std::make_shared<const images::Volume>(cases::load_image(folder, image, [this](double f) {
                if (stops_) throw Stopped();
                loaded_ = f;
              }));
          painting::Painting painting(volume);
          painting::Labels of_case(volume->values.size(), painting::kNothing);
          for (const CaseBone& bone : bones)
            painting::add_bone(of_case, *volume, *bone.mesh, label_of(bone.kind));
          for (const CaseBone& bone : bones)
            loaded.digests[bone.kind] = painting::digest_of(of_case, label_of(bone.kind));
          try {
            if (auto saved = painting::load_painting(folder, *volume)) {
              painting.restore(std::move(saved->strokes), std::move(saved->bones));
            } else if (!bones.empty()) {
              painting::Labels strokes(of_case.size(),
                                       painting::kNothing);  // before the labels are moved away
              painting.restore(std::move(strokes), std::move(of_case));
              loaded.is_of_case = true;
            }
          } catch (const std::exception& error) {
            loaded.failure =
                std::string("What was painted cannot be read, and is left alone: ") + error.what();
          }
          loaded.painting = std::move(painting);
        } catch (const Stopped&) {
        } catch (const std::exception& error) {
          loaded.failure = error.what();
        }
        return loaded;
      },
      wake_);
}

std::optional<painting::Painting> PaintStore::take_loaded() {
  if (!loading_.is_ready()) return std::nullopt;
  Loaded loaded = loading_.take();
  failure_ = loaded.failure;
  is_of_case_ = loaded.is_of_case;
  digests_ = std::move(loaded.digests);
  if (!failure_.empty()) is_read_only_ = true;
  if (loaded.painting) seen_ = posted_ = loaded_revision_ = loaded.painting->revision();
  return std::move(loaded.painting);
}

std::vector<bones::BoneKind> PaintStore::unchanged(const painting::Painting& painting) const {
  std::vector<bones::BoneKind> kinds;
  for (const auto& [kind, digest] : digests_)
    if (painting::digest_of(painting.labels(painting::Layer::Bones), label_of(kind)) == digest)
      kinds.push_back(kind);
  return kinds;
}

void PaintStore::note_made(const painting::Painting& painting) {
  for (const bones::BoneKind kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
    if (painting.holds(painting::Layer::Bones, label_of(kind)))
      digests_[kind] = painting::digest_of(painting.labels(painting::Layer::Bones), label_of(kind));
}

void PaintStore::post(const painting::Painting& painting) {
  posted_ = painting.revision();
  saver_->post({folder_,
                painting.shared_volume(),
                {painting.labels(painting::Layer::Strokes), painting.labels(painting::Layer::Bones)},
                posted_});
}

void PaintStore::keep(const painting::Painting& painting, double now_s) {
  if (is_read_only_ || saver_ == nullptr) return;
  const auto saved = saver_->latest();
  if (saved != nullptr) failure_ = saved->failure;
  if (painting.revision() != seen_) {
    seen_ = painting.revision();
    changed_at_s_ = now_s;
  }
  const double rests_s = now_s - changed_at_s_;
  if (seen_ != posted_ && rests_s >= kRest_s) return post(painting);
  if (saved == nullptr || saved->revision != posted_ || saved->failure.empty() || rests_s < kTryAgain_s)
    return;
  changed_at_s_ = now_s;
  post(painting);
}

void PaintStore::keep_now(const painting::Painting& painting) {
  if (is_read_only_ || saver_ == nullptr) return;
  if (painting.revision() != posted_) post(painting);
  seen_ = posted_;
  saver_->finish();
  if (!is_saved(painting)) {  // what could not be written before may be possible now
    post(painting);
    saver_->finish();
  }
  if (const auto saved = saver_->latest(); saved != nullptr) failure_ = saved->failure;
}

bool PaintStore::is_saved(const painting::Painting& painting) const {
  if (painting.revision() == loaded_revision_) return true;
  const auto saved = saver_ != nullptr ? saver_->latest() : nullptr;
  return saved != nullptr && saved->revision == painting.revision() && saved->failure.empty();
}

}  // namespace arthronaut::paint
