#include "app/plan/anatomical_text.h"

#include <array>
#include <cmath>

namespace arthronaut::plan {

std::string anatomical_text(const Eigen::Vector3d& displacement_mm, const landmarks::AnatomicalAxes& axes) {
  struct Part {
    double value;
    const char *positive, *negative;
  };
  const std::array<Part, 3> parts{Part{displacement_mm.dot(axes.proximal), "proximal", "distal"},
                                  Part{displacement_mm.dot(axes.lateral), "lateral", "medial"},
                                  Part{displacement_mm.dot(axes.anterior), "anterior", "posterior"}};
  std::string text;
  for (const Part& part : parts) {
    if (std::abs(part.value) < 0.5) continue;
    if (!text.empty()) text += ", ";
    text += std::to_string(std::lround(std::abs(part.value))) + " mm " +
            (part.value > 0 ? part.positive : part.negative);
  }
  return text;
}

std::string place_from_entry(const Eigen::Vector3d& displacement_mm, const landmarks::AnatomicalAxes& axes) {
  const std::string text = anatomical_text(displacement_mm, axes);
  return text.empty() ? "at the entry" : text + " of the entry";
}

}  // namespace arthronaut::plan
