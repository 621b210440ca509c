#include "navigation/operation/stroke_bias.h"

namespace arthronaut::operation {

std::optional<guidance::RegistrationBias> StrokeBias::bias(const StrokeBook& strokes) const {
  guidance::BiasSums sums;
  for (const auto& [curve, of_stroke] : of_stroke_)
    if (strokes.uses(curve)) sums += of_stroke;
  return sums.empty() ? std::nullopt : std::optional(sums.bias());
}

}  // namespace arthronaut::operation
