// What somebody paints over the images of a case: strokes, from which bones are grown, and the bones
// themselves, as two label maps in the grid of the volume. Every edit is a step that can be undone; a drag is
// one step.
//
// GUI-free. One thread; a job beside it works on copies.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "planning/images/volume.h"
#include "planning/painting/brush.h"

namespace arthronaut::painting {

enum class Layer {
  Strokes,  // femur, tibia, surroundings
  Bones,    // femur, tibia
};

class Painting {
 public:
  // Of an image, with nothing painted; null for none.
  explicit Painting(std::shared_ptr<const images::Volume> volume = nullptr);
  // What was painted before, without a step. Throws InvalidInput when it is not of the volume's size.
  void restore(Labels strokes, Labels bones);

  [[nodiscard]] const images::Volume& volume() const { return *volume_; }
  [[nodiscard]] const std::shared_ptr<const images::Volume>& shared_volume() const { return volume_; }
  [[nodiscard]] const Labels& labels(Layer layer) const { return labels_[static_cast<std::size_t>(layer)]; }
  // Whether any voxel has the label; kNothing: whether anything is painted at all.
  [[nodiscard]] bool holds(Layer layer, std::uint8_t label = kNothing) const;

  // continues: belongs to the step before it, as the moves of a drag do. A move that changes nothing is no
  // step.
  void paint(Layer layer, const BrushMove& move, std::uint8_t label, const std::string& what, bool continues);
  // The layer becomes this, as one step; nothing when it is that already. Throws InvalidInput when it is not
  // of the volume's size.
  void put(Layer layer, const Labels& labels, const std::string& what);

  // Without effect when there is nothing to undo or redo.
  void undo();
  void redo();
  // Undoes or redoes until so many steps are done; at most step_count().
  void go_to(std::size_t position);
  [[nodiscard]] bool can_undo() const { return position_ > 0; }
  [[nodiscard]] bool can_redo() const { return position_ < steps_.size(); }
  // What was done, the oldest first, and how many of these are not undone. Of very many large steps the
  // oldest are forgotten.
  [[nodiscard]] std::size_t step_count() const { return steps_.size(); }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] const std::string& step_name(std::size_t step) const { return steps_[step].what; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }  // counts the changes

 private:
  struct Step {
    std::string what;
    Layer layer = Layer::Strokes;
    LabelChange change;
  };
  void count_voxels(Layer layer, const LabelChange& change, bool undoes);
  void recount();
  void begin(Step step);
  void forget_oldest();

  std::shared_ptr<const images::Volume> volume_;
  std::array<Labels, 2> labels_;
  std::array<std::array<std::size_t, 256>, 2> counts_{};  // voxels of each label
  std::deque<Step> steps_;
  std::size_t position_ = 0;  // steps_[0, position_) are done
  bool can_continue_ = false;
  std::uint64_t revision_ = 1;
};

}  // namespace arthronaut::painting
