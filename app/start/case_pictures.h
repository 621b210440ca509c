// The thumbnails of the cases in the list: those that are there are shown, those that are missing or older
// than the plan are made one after the other beside the screen.
//
// One thread, which owns the window's OpenGL context. Of the drawing off-screen one thread at a time is
// allowed: finish() before anything else draws.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "app/library/plan_verdict.h"
#include "app/widgets/video_texture.h"
#include "navigation/worker/awaited.h"

namespace arthronaut::start {

class CasePictures {
 public:
  explicit CasePictures(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~CasePictures() { finish(); }  // and waits for all that was begun
  CasePictures(const CasePictures&) = delete;
  CasePictures& operator=(const CasePictures&) = delete;

  // Of a case that is in view. Null while it has none; it is then the next to be made. A case that cannot be
  // drawn stays without.
  [[nodiscard]] const widgets::VideoTexture* of(const std::filesystem::path& case_folder);
  // Of a case in view that has no picture yet, but will.
  [[nodiscard]] bool is_coming(const std::filesystem::path& case_folder) const {
    return !shown_.contains(case_folder) && !without_.contains(case_folder);
  }
  // What is wrong in its plan; null until of() has its picture.
  [[nodiscard]] const plan_review::TunnelVerdict* verdict_of(const std::filesystem::path& case_folder) const;
  void poll();
  // From here on nothing is drawn off-screen until another picture is asked for: waits while one is drawn,
  // not while its case is read, which goes on for itself and comes to nothing.
  void finish();
  void forget_all();  // what is on disk is looked at again
  [[nodiscard]] bool is_busy() const { return making_->is_busy(); }

 private:
  // What this thread and the one that makes a picture have in common.
  struct Making {
    std::mutex drawing;
    bool is_wanted = true;  // under the lock
  };

  void take();  // what is ready

  std::function<void()> wake_;
  std::map<std::filesystem::path, std::unique_ptr<widgets::VideoTexture>> shown_;
  std::map<std::filesystem::path, std::optional<plan_review::TunnelVerdict>> verdicts_;
  std::set<std::filesystem::path> without_;  // have none, and will have none until forget_all()
  std::filesystem::path wanted_, made_;      // next to be made; being made
  std::shared_ptr<Making> shared_ = std::make_shared<Making>();                                // never null
  std::unique_ptr<worker::Awaited<void>> making_ = std::make_unique<worker::Awaited<void>>();  // never null
  std::vector<std::unique_ptr<worker::Awaited<void>>> left_;  // what nobody waits for
};

}  // namespace arthronaut::start
