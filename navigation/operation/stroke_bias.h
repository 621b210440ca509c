// How the registrations that strokes give follow the errors of probe and camera
// (guidance/registration_bias.h): summed up stroke by stroke, since strokes are taken back and excluded.
// World-marker frame, mm.
//
// A registration keeps what is of the strokes in use when it was found, whatever is drawn, excluded or
// cleared since. With another camera or probe, whose errors have nothing to do with those of before, it is
// gone.
//
// Thread-free, deterministic.
#pragma once

#include <map>
#include <optional>
#include <vector>

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
  // So many registrations there are: those that are new were found by the strokes in use now.
  void on_registrations(std::size_t count, const StrokeBook& strokes);
  // Pictures of something else: no error is shared with what was drawn before.
  void on_other_source();
  // By its number in the ledger; empty: no stroke was in use, or another source came. Of what came from
  // elsewhere it says nothing. Precondition: on_registrations() was told of it.
  [[nodiscard]] const std::optional<guidance::RegistrationBias>& of_registration(std::size_t entry) const {
    return of_registration_[entry];
  }

 private:
  [[nodiscard]] std::optional<guidance::RegistrationBias> bias(const StrokeBook& strokes) const;

  std::map<int, guidance::BiasSums> of_stroke_;
  std::vector<std::optional<guidance::RegistrationBias>> of_registration_;
};

}  // namespace arthronaut::operation
