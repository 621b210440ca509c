#include "navigation/strokes/curves.h"

namespace arthronaut::strokes {

double length_mm(const Curves& curves) {
  double sum_mm = 0;
  for (std::size_t i = 1; i < curves.size(); ++i)
    if (curves[i].curve == curves[i - 1].curve)
      sum_mm += (curves[i].position_mm - curves[i - 1].position_mm).norm();
  return sum_mm;
}

}  // namespace arthronaut::strokes
