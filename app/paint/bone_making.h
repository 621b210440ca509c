// From painted labels to the bones of the case, by the import's own way: the surfaces are made, mended and
// judged in a process of their own, a person looks at them, and add_to_case() puts them in.
//
//   Idle ─► Making ─► Judging ─► Saving ─► Done
//    ▲ cancel() │  refused │ cancel() │ refused: back to Judging, with the reason
//    └──────────┴──────────┘
//
// One thread; poll() once a frame. A thread of its own writes, and is waited for.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "navigation/worker/awaited.h"
#include "planning/cases/case.h"
#include "planning/import/bone_quality.h"
#include "planning/import/import_process.h"
#include "planning/painting/painting.h"

namespace arthronaut::paint {

class BoneMaking {
 public:
  enum class State { Idle, Making, Judging, Saving, Done };

  // program: what answers importing::kImportChildWord.
  explicit BoneMaking(std::function<void()> wake, std::filesystem::path program = "/proc/self/exe");
  BoneMaking(const BoneMaking&) = delete;
  BoneMaking& operator=(const BoneMaking&) = delete;

  // Why the painting cannot become bones of the case; empty when it can: a bone that is planned on stays.
  // unchanged: bones that are painted as the case has them; these are not made anew, and do not count.
  [[nodiscard]] static std::string refusal(const cases::Case& knee, const painting::Painting& painting,
                                           const std::vector<bones::BoneKind>& unchanged = {});
  // From any state but Saving. The painting is on disk. image: that it was painted in.
  void start(const cases::Case& knee, const std::filesystem::path& case_folder, const cases::CaseImage& image,
             const painting::Painting& painting, const std::vector<bones::BoneKind>& unchanged = {});
  void cancel();  // Making, Judging: back to Idle
  void save();    // Judging
  void forget();  // Done: Idle
  void poll();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const importing::ImportProgress& progress() const { return progress_; }
  [[nodiscard]] double done_fraction() const { return done_fraction_; }  // Making: of all, never back
  [[nodiscard]] const std::vector<importing::BoneQuality>& qualities() const {
    return qualities_;
  }                                                                              // Judging
  [[nodiscard]] const importing::BoneImport& result() const { return result_; }  // Judging
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  void judge();

  std::function<void()> wake_;
  std::filesystem::path program_, folder_;
  State state_ = State::Idle;
  std::unique_ptr<importing::ImportProcess> process_;
  importing::ImportProgress progress_;
  double done_fraction_ = 0;
  importing::BoneImport result_;
  std::vector<importing::BoneQuality> qualities_;  // the painted volume is known from the start
  std::shared_ptr<const images::Volume> images_;   // that it was painted in
  std::string image_file_;                         // likewise
  bones::Side side_ = bones::Side::Right;
  std::string failure_;
  worker::Awaited<void> saving_;
};

}  // namespace arthronaut::paint
