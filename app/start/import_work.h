// An import as the window leads through it: looking what a folder holds and making the bones, each in a
// process of its own; the questions that only a person can answer; writing the case. Nothing here waits.
//
//   Idle ─► Looking ─► Choosing ─► Running ─► Asking ─► Saving ─► Done
//                         ▲  cancel() │  refused │ (with the reason, see failure())
//                         └───────────┴──────────┘
//
// The list is there with Choosing, its pictures come after it.
//
// One thread; poll() once a frame. A thread of its own writes; `wake` is called from it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/start/import_sources.h"
#include "navigation/worker/awaited.h"
#include "planning/import/bone_import.h"
#include "planning/import/import_process.h"
#include "planning/import/series_process.h"

namespace arthronaut::start {

struct ImportWishes {
  std::vector<std::size_t> sources;      // of the list; one volume, or meshes of different bones
  std::optional<bones::Side> side = {};  // nullopt: as names and images tell; asked for where they do not
  // The images alone, for a case in which the bones are painted; of a grey volume.
  bool images_only = false;
  // Of a label map without names; of meshes that no bone is as large as in mm, and that one is in this unit.
  std::map<bones::BoneKind, int> labels = {};
  std::optional<bones::LengthUnit> unit = {};
};

class ImportWork {
 public:
  enum class State { Idle, Looking, Choosing, Running, Asking, Saving, Done };

  // program: what answers importing::kImportChildWord.
  explicit ImportWork(std::function<void()> wake, std::filesystem::path program = "/proc/self/exe");
  ~ImportWork();  // cancels, and waits for what is being written
  ImportWork(const ImportWork&) = delete;
  ImportWork& operator=(const ImportWork&) = delete;

  // From any state; what ran is cancelled. One slice of a DICOM series stands for its series: its folder is
  // looked into then.
  void look_into(const std::filesystem::path& root);
  void start(const ImportWishes& wishes);  // Choosing; without a source: nothing
  // Running, Asking: back to Choosing. Looking: Idle. Choosing: no more pictures are made.
  void cancel();
  // Choosing. Which bone a mesh of the list is.
  void set_bone(std::size_t source, bones::BoneKind bone);
  // Asking. The side must be known then, or said; the one that is said last holds, and becomes of the case
  // alone: result() tells what was found. Name: of the case, empty for "Knee", date and time.
  void set_side(bones::Side side);
  // Asking. Whether the front of a mesh looks to the patient's back, as in the other axes it would not; and
  // the import once more with such meshes in these.
  [[nodiscard]] bool can_swap_axes() const;
  void swap_axes();
  void save(const std::filesystem::path& folder, const std::string& name);
  void poll();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool is_busy() const;
  [[nodiscard]] const ImportSources& sources() const { return sources_; }
  // Of a series, until the next poll(); null before it has been made, and for what has none. Why a series has
  // none is then among its warnings.
  [[nodiscard]] const images::Thumbnail* thumbnail(std::size_t source) const;
  [[nodiscard]] bool makes_pictures() const;     // after the list
  [[nodiscard]] double looked_fraction() const;  // Looking: 0 to 1
  [[nodiscard]] const importing::ImportProgress& progress() const { return progress_; }
  // Of all its stages and sources, 0 to 1, and never back.
  [[nodiscard]] double done_fraction() const { return done_fraction_; }
  // Asking: what was made, and what should be looked at before it is relied on.
  [[nodiscard]] const importing::BoneImport& result() const { return result_; }
  [[nodiscard]] std::vector<std::string> doubts() const;
  // Why the last step was refused or cancelled; empty when it was not.
  [[nodiscard]] const std::string& failure() const { return failure_.words; }
  [[nodiscard]] const importing::Failure& refusal() const { return failure_; }  // with what may be answered
  // Choosing: the source that was refused; null where none was.
  [[nodiscard]] const ImportSource* refused_source() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }  // Done: the case

 private:
  void take_sources();
  void note_pictures();
  void take_bones();
  void begin();
  void start_next(std::optional<bones::LengthUnit> unit = {});
  void take_refusal();
  void end_work();

  std::function<void()> wake_;
  std::filesystem::path program_, folder_;
  State state_ = State::Idle;
  std::unique_ptr<importing::SeriesProcess> series_;
  std::size_t noted_ = 0;  // of its pictures
  worker::Awaited<void> saving_;
  ImportSources sources_;
  std::string wanted_uid_;  // as in sources_
  ImportWishes wishes_;
  std::map<std::size_t, bones::Space> spaces_;  // of sources whose axes a person has swapped
  std::size_t next_ = 0;                        // of the wished sources
  std::unique_ptr<importing::ImportProcess> process_;
  importing::ImportProgress progress_;
  double done_fraction_ = 0;
  importing::BoneImport result_;
  std::optional<bones::Side> said_side_;  // of result_, by a person
  importing::Failure failure_;
};

// A folder for a new case that is not there yet: FOLDER/NAME.arthro, with a number where that is taken.
// Characters that file systems do not have are replaced.
[[nodiscard]] std::filesystem::path new_case_folder(const std::filesystem::path& folder,
                                                    const std::string& name);
// Where imported cases go unless somebody says otherwise: beside the built-in case.
[[nodiscard]] std::filesystem::path cases_folder();

}  // namespace arthronaut::start
