#include "app/plan/volume_drawing.h"

#include <cmath>

namespace arthronaut::plan {

namespace {

// The skin lies about so far from the bones.
constexpr double kAbout_mm = 30;

}  // namespace

void VolumeDrawing::open(const geometry::Bounds& joint) {
  preparing_.drop();
  turn_ = 0;
  box_ = {joint.min_mm - Eigen::Vector3d::Constant(kAbout_mm),
          joint.max_mm + Eigen::Vector3d::Constant(kAbout_mm)};
  source_.reset();
  volume_.reset();
  item_.reset();
}

void VolumeDrawing::next() {
  const int presets = volume_ == nullptr || volume_->is_ct ? 2 : 1;
  turn_ = (turn_ + 1) % (presets + 1);
  make_item();
}

void VolumeDrawing::move_threshold(int steps) {
  if (item_ == nullptr) return;
  threshold_ = scene::moved_threshold(*volume_, threshold_, steps);
  make_item();
}

void VolumeDrawing::follow(const std::shared_ptr<const images::Volume>& volume) {
  if (is_on() && volume != nullptr && source_ == nullptr) {
    source_ = volume;
    preparing_.start([volume, box = box_] { return scene::drawn_volume(*volume, box); }, wake_);
  }
  if (!preparing_.is_ready()) return;
  volume_ = preparing_.take();
  if (volume_ == nullptr) return;
  threshold_ = scene::first_threshold(*volume_);
  if (!volume_->is_ct && turn_ > 1) turn_ = 0;  // pressed twice before it was known
  make_item();
}

void VolumeDrawing::make_item() {
  item_.reset();
  if (!is_on() || volume_ == nullptr) return;
  scene::VolumeItem item;
  item.volume = volume_;
  item.preset = !volume_->is_ct ? scene::VolumePreset::Grey
                : turn_ == 1    ? scene::VolumePreset::Bone
                                : scene::VolumePreset::BoneAndSoftTissue;
  item.threshold = threshold_;
  item_ = std::make_shared<const scene::VolumeItem>(std::move(item));
}

std::string VolumeDrawing::in_words(const std::string& no_images) const {
  if (!is_on()) return "";
  if (item_ != nullptr && item_->preset == scene::VolumePreset::Grey)
    return "Images: cut open; grey values above " + std::to_string(std::lround(threshold_)) +
           " (, less, . more)";
  if (item_ != nullptr)
    return "Images: " + scene::in_words(item_->preset) + " above " +
           std::to_string(static_cast<int>(std::lround(threshold_))) + (volume_->is_ct ? " HU" : "") +
           " (, less, . more)";
  if (!no_images.empty()) return no_images;
  return is_preparing() || source_ == nullptr ? "Making the images ready ..."
                                              : "The images do not reach to the joint";
}

}  // namespace arthronaut::plan
