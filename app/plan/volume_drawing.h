// The images of a case in 3D, in the place of the bones: which preset and threshold, and the volume made
// ready beside the screen.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/scene/drawn_volume.h"
#include "navigation/worker/awaited.h"

namespace arthronaut::plan {

class VolumeDrawing {
 public:
  // wake: called from another thread when a volume is ready.
  explicit VolumeDrawing(std::function<void()> wake) : wake_(std::move(wake)) {}

  // Another case: nothing is drawn. joint: what is looked at of it; the volume is drawn with what lies about.
  void open(const geometry::Bounds& joint);
  // Off, bone, bone and soft tissue, off; of images that are no CT: off, grey values, off.
  void next();
  [[nodiscard]] bool is_on() const { return turn_ != 0; }
  void move_threshold(int steps);  // of moved_threshold(); nothing before there is an item()
  // For every frame: the images, nullptr while there are none (yet). Takes over what was made ready.
  void follow(const std::shared_ptr<const images::Volume>& volume);

  [[nodiscard]] bool is_preparing() const { return preparing_.is_busy(); }
  // What is to be drawn; nullptr: nothing, or not yet. Another one for every change.
  [[nodiscard]] const std::shared_ptr<const scene::VolumeItem>& item() const { return item_; }
  // "Images: bone above 250 HU"; no_images: why there are none. Empty while it is off.
  [[nodiscard]] std::string in_words(const std::string& no_images) const;

 private:
  void make_item();

  std::function<void()> wake_;
  int turn_ = 0;  // presses since it was off
  geometry::Bounds box_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::shared_ptr<const images::Volume> source_;  // that `volume_` is, or is being, made of
  std::shared_ptr<const scene::DrawnVolume> volume_;
  double threshold_ = 0;
  std::shared_ptr<const scene::VolumeItem> item_;
  worker::Awaited<std::shared_ptr<const scene::DrawnVolume>> preparing_;  // last: ends first
};

}  // namespace arthronaut::plan
