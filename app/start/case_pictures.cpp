#include "app/start/case_pictures.h"

#include <exception>
#include <utility>

#include "app/library/case_thumbnail.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::start {

namespace fs = std::filesystem;

const widgets::VideoTexture* CasePictures::of(const fs::path& case_folder) {
  if (const auto shown = shown_.find(case_folder); shown != shown_.end()) return shown->second.get();
  if (without_.contains(case_folder) || case_folder == made_) return nullptr;
  if (!workstation_library::has_thumbnail(case_folder)) {
    if (wanted_.empty()) wanted_ = case_folder;
    return nullptr;
  }
  verdicts_[case_folder] = workstation_library::plan_verdict(case_folder);
  try {  // a picture is an ornament: a list without it is whole
    const auto frame = std::make_shared<const camera::Frame>(
        sources::read_picture(workstation_library::thumbnail_file(case_folder)));
    auto texture = std::make_unique<widgets::VideoTexture>();
    texture->upload(frame);
    return (shown_[case_folder] = std::move(texture)).get();
  } catch (const std::exception&) {
    without_.insert(case_folder);
  }
  return nullptr;
}

const plan_review::TunnelVerdict* CasePictures::verdict_of(const fs::path& case_folder) const {
  const auto known = verdicts_.find(case_folder);
  return known != verdicts_.end() && known->second ? &*known->second : nullptr;
}

void CasePictures::poll() {
  std::erase_if(left_, [](const auto& one) { return one->is_ready(); });
  if (making_->is_busy()) {
    if (!making_->is_ready()) return;
    take();
  }
  if (wanted_.empty()) return;
  made_ = std::exchange(wanted_, {});
  making_->start(
      [folder = made_, shared = shared_] {
        const workstation_library::ThumbnailCase loaded = workstation_library::load_for_thumbnail(folder);
        const std::scoped_lock lock(shared->drawing);
        if (shared->is_wanted) workstation_library::draw_thumbnail(folder, loaded);
      },
      wake_);
}

void CasePictures::take() {
  try {
    making_->take();
    if (!workstation_library::has_thumbnail(made_)) without_.insert(made_);
  } catch (const std::exception&) {  // as in of()
    without_.insert(made_);
  }
  made_.clear();
}

void CasePictures::finish() {
  wanted_.clear();
  if (!making_->is_busy()) return;
  if (making_->is_ready()) return take();
  {
    const std::scoped_lock lock(shared_->drawing);
    shared_->is_wanted = false;
  }
  left_.push_back(std::exchange(making_, std::make_unique<worker::Awaited<void>>()));
  shared_ = std::make_shared<Making>();
  made_.clear();
}

void CasePictures::forget_all() {
  shown_.clear();
  verdicts_.clear();
  without_.clear();
  wanted_.clear();
}

}  // namespace arthronaut::start
