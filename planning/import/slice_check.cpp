#include "planning/import/slice_check.h"

#include "planning/files/format.h"

namespace arthronaut::importing {

namespace {

constexpr double kMostApart_mm = 1.6;  // 1.5, and what a header rounds that to

}  // namespace

std::string slice_doubt(const images::Volume& images) {
  const double apart_mm = images.spacing_mm().maxCoeff();
  if (apart_mm <= kMostApart_mm) return "";
  return files::format(
      "its slices are %.1f mm apart: where the bone ends between two of them, as about the entries, its "
      "surface may be off by %.1f mm or more",
      apart_mm, apart_mm / 2);
}

}  // namespace arthronaut::importing
