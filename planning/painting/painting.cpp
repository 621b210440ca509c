#include "planning/painting/painting.h"

#include <utility>

#include "planning/geometry/error.h"

namespace arthronaut::painting {

namespace {

// 12 bytes each: 240 MB at the most.
constexpr std::size_t kMostRuns = 20'000'000;

}  // namespace

Painting::Painting(std::shared_ptr<const images::Volume> volume) : volume_(std::move(volume)) {
  if (volume_ != nullptr)
    for (Labels& labels : labels_) labels.assign(volume_->values.size(), kNothing);
  recount();
}

void Painting::restore(Labels strokes, Labels bones) {
  if (strokes.size() != labels_[0].size() || bones.size() != labels_[1].size())
    throw InvalidInput("what was painted is not of the volume's size");
  labels_ = {std::move(strokes), std::move(bones)};
  steps_.clear();
  position_ = 0;
  can_continue_ = false;
  recount();
  ++revision_;
}

void Painting::recount() {
  for (std::size_t layer = 0; layer < labels_.size(); ++layer) {
    counts_[layer].fill(0);
    for (const std::uint8_t label : labels_[layer]) ++counts_[layer][label];
  }
}

bool Painting::holds(Layer layer, std::uint8_t label) const {
  const auto& counts = counts_[static_cast<std::size_t>(layer)];
  return label != kNothing ? counts[label] > 0 : counts[kNothing] < labels(layer).size();
}

void Painting::count_voxels(Layer layer, const LabelChange& change, bool undoes) {
  auto& counts = counts_[static_cast<std::size_t>(layer)];
  for (const LabelRun& run : change.runs()) {
    counts[undoes ? run.after : run.before] -= run.count;
    counts[undoes ? run.before : run.after] += run.count;
  }
}

void Painting::paint(Layer layer, const BrushMove& move, std::uint8_t label, const std::string& what,
                     bool continues) {
  LabelChange change;
  Labels& labels = labels_[static_cast<std::size_t>(layer)];
  painting::paint(labels, *volume_, move, label, change);
  if (!continues) can_continue_ = false;
  if (change.is_empty()) return;
  count_voxels(layer, change, false);
  ++revision_;
  if (can_continue_ && position_ == steps_.size() && position_ > 0 && steps_.back().layer == layer) {
    for (const LabelRun& run : change.runs())
      for (std::uint32_t n = 0; n < run.count; ++n)
        steps_.back().change.note(run.first + n, run.before, run.after);
    return;
  }
  begin({what, layer, std::move(change)});
  can_continue_ = true;
}

void Painting::put(Layer layer, const Labels& labels, const std::string& what) {
  Labels& there = labels_[static_cast<std::size_t>(layer)];
  if (labels.size() != there.size()) throw InvalidInput("the labels are not of the volume's size");
  LabelChange change = change_between(there, labels);
  if (change.is_empty()) return;
  there = labels;
  count_voxels(layer, change, false);
  ++revision_;
  begin({what, layer, std::move(change)});
  can_continue_ = false;
}

void Painting::begin(Step step) {
  steps_.resize(position_);
  steps_.push_back(std::move(step));
  position_ = steps_.size();
  forget_oldest();
}

void Painting::forget_oldest() {
  std::size_t runs = 0;
  for (const Step& step : steps_) runs += step.change.runs().size();
  while (runs > kMostRuns && steps_.size() > 1) {
    runs -= steps_.front().change.runs().size();
    steps_.pop_front();
    --position_;
  }
}

void Painting::undo() {
  if (!can_undo()) return;
  const Step& step = steps_[--position_];
  step.change.undo(labels_[static_cast<std::size_t>(step.layer)]);
  count_voxels(step.layer, step.change, true);
  can_continue_ = false;
  ++revision_;
}

void Painting::redo() {
  if (!can_redo()) return;
  const Step& step = steps_[position_++];
  step.change.redo(labels_[static_cast<std::size_t>(step.layer)]);
  count_voxels(step.layer, step.change, false);
  can_continue_ = false;
  ++revision_;
}

void Painting::go_to(std::size_t position) {
  while (position_ > position) undo();
  while (position_ < position && can_redo()) redo();
}

}  // namespace arthronaut::painting
