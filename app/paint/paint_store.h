// The images that are painted in and what is painted of them, from the case's folder and back into it.
// Loading and saving are on threads of their own; the window waits for them only in keep_now(), and in open()
// for what is still being loaded.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/worker/awaited.h"
#include "navigation/worker/worker.h"
#include "planning/cases/case.h"
#include "planning/painting/painting.h"
#include "planning/painting/painting_file.h"

namespace arthronaut::paint {

// The image of a case in which bones are painted: the newest grey one. nullopt without any.
[[nodiscard]] std::optional<cases::CaseImage> image_to_paint(const cases::Case& knee);

// A bone that the case has already: its painting begins with it.
struct CaseBone {
  bones::BoneKind kind = bones::BoneKind::Femur;
  std::shared_ptr<const geometry::TriangleMesh> mesh;  // not null
};
[[nodiscard]] inline std::uint8_t label_of(bones::BoneKind kind) {
  return kind == bones::BoneKind::Femur ? painting::kFemur : painting::kTibia;
}

class PaintStore {
 public:
  explicit PaintStore(std::function<void()> wake);
  ~PaintStore();
  PaintStore(const PaintStore&) = delete;
  PaintStore& operator=(const PaintStore&) = delete;

  // Begins to load; what was open is forgotten. read_only: nothing will be saved. What was painted before is
  // gone on with; where nothing was, the case's bones are what is painted as bones, without a step, and
  // nothing is written before they are changed.
  void open(const std::filesystem::path& case_folder, const cases::CaseImage& image, bool read_only,
            std::vector<CaseBone> case_bones = {});
  [[nodiscard]] bool is_loading() const { return loading_.is_busy(); }
  [[nodiscard]] double loaded_fraction() const { return loaded_; }
  // The painting, once, when it has been loaded. What was painted before is in it, without steps. A saved
  // painting that cannot be read is said by failure(), and nothing is saved over it.
  [[nodiscard]] std::optional<painting::Painting> take_loaded();
  [[nodiscard]] const std::string& failure() const { return failure_; }  // why nothing is loaded, or saved
  // False where the case is read-only, and where a saved painting is left alone: what is painted then would
  // be lost.
  [[nodiscard]] bool may_save() const { return !is_read_only_; }

  // The bones that are painted just as the case has them.
  [[nodiscard]] std::vector<bones::BoneKind> unchanged(const painting::Painting& painting) const;

  // Nothing was painted yet over the case's own bones.
  [[nodiscard]] bool is_of_case(const painting::Painting& painting) const {
    return is_of_case_ && painting.revision() == loaded_revision_;
  }
  // The case has the bones that are painted from now on.
  void note_made(const painting::Painting& painting);

  // For every frame: saves what has changed when the hand has rested for a moment; what could not be saved,
  // every few seconds again.
  void keep(const painting::Painting& painting, double now_s);
  // Saves what has changed, and waits for that.
  void keep_now(const painting::Painting& painting);
  [[nodiscard]] bool is_saved(const painting::Painting& painting) const;

 private:
  struct Loaded {
    std::optional<painting::Painting> painting;
    std::map<bones::BoneKind, std::uint64_t> digests;
    bool is_of_case = false;
    std::string failure;
  };
  struct Snapshot {
    std::filesystem::path folder;
    std::shared_ptr<const images::Volume> volume;
    painting::SavedPainting painting;
    std::uint64_t revision = 0;
  };
  struct Saved {
    std::uint64_t revision = 0;
    std::string failure;
  };
  void post(const painting::Painting& painting);

  std::function<void()> wake_;
  std::filesystem::path folder_;
  bool is_read_only_ = false, is_of_case_ = false;
  std::atomic<double> loaded_{0};
  std::atomic<bool> stops_{false};
  std::string failure_;
  std::map<bones::BoneKind, std::uint64_t> digests_;           // of the case's bones, as labels
  std::uint64_t seen_ = 1, posted_ = 1, loaded_revision_ = 1;  // revisions of the painting
  double changed_at_s_ = 0;
  worker::Awaited<Loaded> loading_;  // last: end first
  std::unique_ptr<worker::Worker<Snapshot, Saved>> saver_;
};

}  // namespace arthronaut::paint
