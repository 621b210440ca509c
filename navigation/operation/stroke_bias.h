// How the registrations that strokes give follow the errors of probe and camera
// (guidance/registration_bias.h): summed up stroke by stroke, since strokes are taken back and excluded.
// World-marker frame, mm.
//
// Of the strokes that are there: those that were cleared or taken back count no more, and numbers of strokes
// are never used twice.
//
// Thread-free, deterministic.
#pragma once

#include <map>
#include <optional>

#include "navigation/guidance/registration_bias.h"
#include "navigation/operation/stroke_book.h"

namespace arthronaut::operation {

class StrokeBias {
 public:
  // A point of that stroke, step_mm after the one before it in the stroke: it counts as much as the stroke
  // that it stands for, as it does in the fit. The first one of a stroke stands for none.
  void add(int curve, const guidance::TipSensitivity& sensitivity, double step_mm) {
    if (step_mm > 0) of_stroke_[curve].add(sensitivity, step_mm);
  }
  void on_strokes_cleared() { of_stroke_.clear(); }
  // Of the strokes in use now; empty: none is.
  [[nodiscard]] std::optional<guidance::RegistrationBias> bias(const StrokeBook& strokes) const;

 private:
  std::map<int, guidance::BiasSums> of_stroke_;
};

}  // namespace arthronaut::operation
