#include "planning/painting/label_change.h"

#include <algorithm>

namespace arthronaut::painting {

void LabelChange::note(std::size_t voxel, std::uint8_t before, std::uint8_t after) {
  const auto at = static_cast<std::uint32_t>(voxel);
  if (!runs_.empty()) {
    LabelRun& last = runs_.back();
    if (last.first + last.count == at && last.before == before && last.after == after) {
      ++last.count;
      return;
    }
  }
  runs_.push_back({at, 1, before, after});
}

void LabelChange::redo(Labels& labels) const {
  for (const LabelRun& run : runs_) std::fill_n(labels.begin() + run.first, run.count, run.after);
}

void LabelChange::undo(Labels& labels) const {
  for (auto run = runs_.rbegin(); run != runs_.rend(); ++run)
    std::fill_n(labels.begin() + run->first, run->count, run->before);
}

LabelChange change_between(std::span<const std::uint8_t> before, std::span<const std::uint8_t> after) {
  LabelChange change;
  auto at = std::mismatch(before.begin(), before.end(), after.begin());
  while (at.first != before.end()) {
    change.note(static_cast<std::size_t>(at.first - before.begin()), *at.first, *at.second);
    at = std::mismatch(at.first + 1, before.end(), at.second + 1);
  }
  return change;
}

}  // namespace arthronaut::painting
