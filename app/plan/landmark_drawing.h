// The picture of what is meant by the selected landmark (landmark_sketch.h), on the screen: made once for
// each landmark that is looked at, and kept until another one is.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "app/plan/landmark_sketch.h"
#include "app/widgets/color_texture.h"
#include "app/widgets/controls.h"
#include "navigation/worker/awaited.h"

namespace arthronaut::plan {

class LandmarkDrawing {
 public:
  // wake: called from another thread when the schematic knee is ready.
  explicit LandmarkDrawing(std::function<void()> wake) : wake_(std::move(wake)) {}

  // For every frame in which one is wanted: a knee of that side is made where there is none.
  void follow(bones::Side side);
  [[nodiscard]] bool is_preparing() const { return making_.is_busy(); }
  // Of a knee of that side, in the square; nothing while there is none yet.
  void draw(const widgets::Ui& ui, const widgets::Rect& square, bones::Side side, bones::BoneKind bone,
            const std::string& name);

 private:
  std::function<void()> wake_;
  std::optional<SchematicKnee> knee_;
  LandmarkSketch shown_;  // in texture_; its pixels are there alone
  bones::Side shown_side_ = bones::Side::Right;
  bones::BoneKind shown_bone_ = bones::BoneKind::Femur;
  std::string shown_name_;  // empty: none is
  widgets::ColorTexture texture_;
  std::uint64_t version_ = 0;              // of what texture_ holds (draw_damage.h)
  worker::Awaited<SchematicKnee> making_;  // last: ends first
};

}  // namespace arthronaut::plan
