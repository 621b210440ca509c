#include "navigation/operation/guidance_grades.h"

namespace arthronaut::operation {

namespace {

constexpr double kGoodOffset_mm = 1, kGoodAngle_deg = 2;

// Written so that a number that is not known is bad.
Grade grade_of(double value, double sigma, double good) {
  if (!(sigma <= 2 * good) || !(value < 2 * good)) return Grade::Bad;
  return value < good && sigma < good ? Grade::Good : Grade::Caution;
}

}  // namespace

GuidanceGrades grades_of(const guidance::GuidanceNumbers& guidance) {
  return {grade_of(guidance.offset_mm, guidance.sigma_offset_mm, kGoodOffset_mm),
          grade_of(guidance.angle_deg, guidance.sigma_angle_deg, kGoodAngle_deg)};
}

Grade HeldGrades::Held::add(Grade grade, std::int64_t now_ns) {
  if (grade == Grade::Bad) bad_ns_ = now_ns;
  if (grade == Grade::Caution) caution_ns_ = now_ns;
  const auto is_held = [&](const std::optional<std::int64_t>& seen_ns) {
    return seen_ns && now_ns - *seen_ns < kHolds_ns;
  };
  return is_held(bad_ns_) ? Grade::Bad : is_held(caution_ns_) ? Grade::Caution : Grade::Good;
}

void HeldGrades::add(const guidance::GuidanceNumbers& guidance, std::int64_t now_ns) {
  grades_ = {};
  if (!guidance.is_valid()) return;
  const GuidanceGrades now = grades_of(guidance);
  grades_ = {offset_.add(now.offset, now_ns), angle_.add(now.angle, now_ns)};
}

}  // namespace arthronaut::operation
