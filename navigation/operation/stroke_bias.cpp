#include "navigation/operation/stroke_bias.h"

namespace arthronaut::operation {

void StrokeBias::on_registrations(std::size_t count, const StrokeBook& strokes) {
  if (count > of_registration_.size()) of_registration_.resize(count, bias(strokes));
}

void StrokeBias::on_other_source() {
  for (auto& bias : of_registration_) bias.reset();
}

// Numbers of strokes are never used twice: those that were taken back count no more.
std::optional<guidance::RegistrationBias> StrokeBias::bias(const StrokeBook& strokes) const {
  guidance::BiasSums sums;
  for (const auto& [curve, of_stroke] : of_stroke_)
    if (strokes.uses(curve)) sums += of_stroke;
  return sums.empty() ? std::nullopt : std::optional(sums.bias());
}

}  // namespace arthronaut::operation
