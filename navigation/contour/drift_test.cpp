#include "navigation/contour/drift_test.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::contour {

namespace {

constexpr int kGrid = 7;  // steps to each side
constexpr int kSide = 2 * kGrid + 1;
constexpr double kGridStep_mm = 0.25;
constexpr double kShell_mm = 0.15;    // displacements this near to 1 mm stand for it
constexpr double kLeastWeight = 0.3;  // of the memory that has to be filled

}  // namespace

DriftTest::DriftTest(const DriftTestOptions& options) : options_(options) {
  at_cell_.assign(static_cast<std::size_t>(kSide) * kSide * kSide, -1);
  const double null_steps = options.null_radius_mm / kGridStep_mm;
  for (int x = -kGrid; x <= kGrid; ++x) {
    for (int y = -kGrid; y <= kGrid; ++y) {
      for (int z = -kGrid; z <= kGrid; ++z) {
        const int squared = x * x + y * y + z * z;
        if (squared <= null_steps * null_steps) about_.push_back((x * kSide + y) * kSide + z);
        if (squared > kGrid * kGrid) continue;
        const int cell = ((x + kGrid) * kSide + y + kGrid) * kSide + z + kGrid;
        at_cell_[static_cast<std::size_t>(cell)] = static_cast<std::int32_t>(displacements_.size());
        cells_.push_back(cell);
        displacements_.push_back((kGridStep_mm * Eigen::Vector3d(x, y, z)).cast<float>());
      }
    }
  }
  frame_.resize(displacements_.size());
  score_.resize(displacements_.size());
  kinds_.resize(displacements_.size());
  at_1_mm_.resize(displacements_.size());
  classify();
}

void DriftTest::clear() {
  std::fill(frame_.begin(), frame_.end(), 0.0f);
  std::fill(score_.begin(), score_.end(), 0.0f);
  weight_ = pieces_ = led_for_s_ = 0;
  frame_pieces_ = 0;
  verdict_ = {};
  set_reference(Eigen::Vector3d::Zero());
}

void DriftTest::set_reference(const Eigen::Vector3d& in_bone_mm) {
  reference_ = in_bone_mm;
  led_for_s_ = 0;  // over another null
  verdict_.has_drifted = false;
  classify();
}

void DriftTest::classify() {
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    const double from_mm = (displacements_[i].cast<double>() - reference_).norm();
    kinds_[i] = from_mm <= options_.null_radius_mm    ? Kind::Null
                : from_mm >= options_.drift_radius_mm ? Kind::Drift
                                                      : Kind::Between;
    at_1_mm_[i] = std::abs(from_mm - 1) <= kShell_mm;
  }
}

void DriftTest::add(const EdgeProfile& profile) {
  ++frame_pieces_;
  const Eigen::Vector3f per_step = profile.normal_in_bone / static_cast<float>(kStep_mm);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    const int place = static_cast<int>(displacements_[i].dot(per_step) + (kSteps + 0.5f));
    frame_[i] += profile.strength[static_cast<std::size_t>(std::clamp(place, 0, kPlaces - 1))];
  }
}

void DriftTest::add(const ShiftMap& map) {
  ++frame_pieces_;
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    const Eigen::Vector2f shift = map.shift_per_mm * displacements_[i];
    const float u = std::clamp(shift.x() + kShifts, 0.0f, kShiftSide - 1.001f),
                v = std::clamp(shift.y() + kShifts, 0.0f, kShiftSide - 1.001f);
    const int iu = static_cast<int>(u), iv = static_cast<int>(v);
    const float fu = u - static_cast<float>(iu), fv = v - static_cast<float>(iv);
    const float* const at = map.likeness.data() + iv * kShiftSide + iu;
    frame_[i] += (1 - fv) * ((1 - fu) * at[0] + fu * at[1]) +
                 fv * ((1 - fu) * at[kShiftSide] + fu * at[kShiftSide + 1]);
  }
}

const DriftVerdict& DriftTest::judge(double elapsed_s) {
  const double elapsed = std::clamp(elapsed_s, 0.0, kLongestGap_s);
  const auto kept = static_cast<float>(std::exp(-elapsed / options_.memory_s));
  weight_ = kept * weight_ + (1 - kept);
  pieces_ = kept * pieces_ + (1 - kept) * frame_pieces_;
  frame_pieces_ = 0;
  float null = -1e9f, drift = -1e9f;
  for (std::size_t i = 0; i < score_.size(); ++i) {
    score_[i] = kept * score_[i] + (1 - kept) * frame_[i];
    frame_[i] = 0;
    if (kinds_[i] == Kind::Null) null = std::max(null, score_[i]);
    if (kinds_[i] == Kind::Drift) drift = std::max(drift, score_[i]);
  }
  const double weight = std::max(weight_, 1e-9);
  const float best = std::max(null, drift);
  const double spoken = std::abs(best) / weight;
  const double needed = std::max(options_.lead_pieces, options_.lead_share * spoken),
               to_see = std::max(options_.seen_pieces, options_.seen_share * spoken);
  verdict_.lead = (drift - null) / weight;
  verdict_.share_seen = share_seen(best, to_see * weight);
  verdict_.is_checked = weight_ > kLeastWeight && verdict_.share_seen >= options_.least_share_seen;
  const bool fits = options_.fits_share <= 0 || drift >= options_.fits_share * pieces_;
  const bool leads = weight_ > kLeastWeight && verdict_.lead > needed && fits;
  led_for_s_ = leads ? led_for_s_ + elapsed : 0;
  verdict_.has_drifted = led_for_s_ >= options_.holds_s;
  verdict_.offset_in_bone_mm = nearest_of_best(drift > null ? Kind::Drift : Kind::Null, best);
  verdict_.from_reference_mm = (verdict_.offset_in_bone_mm - reference_).norm();
  return verdict_;
}

// Of those that fit all but as well as the best, the one nearest to the reference: what cannot be seen of a
// displacement is not made up.
Eigen::Vector3d DriftTest::nearest_of_best(Kind kind, float best) const {
  constexpr float kAsWell = 0.03f;
  double nearest_mm = 1e9;
  Eigen::Vector3d nearest = reference_;
  for (std::size_t i = 0; i < score_.size(); ++i) {
    if (kinds_[i] != kind || score_[i] < best - kAsWell * std::abs(best)) continue;
    const Eigen::Vector3d displacement = displacements_[i].cast<double>();
    if ((displacement - reference_).norm() >= nearest_mm) continue;
    nearest_mm = (displacement - reference_).norm();
    nearest = displacement;
  }
  return nearest;
}

// A bone that lay t further would be scored as it is now, all displacements shifted by t: the null would then
// be what lies about -t now, and the drift would lead over it by what that falls short of the best.
double DriftTest::share_seen(float best, double needed) const {
  int told = 0, all = 0;
  for (std::size_t i = 0; i < score_.size(); ++i) {
    if (!at_1_mm_[i]) continue;
    ++all;
    float null = -1e9f;
    for (const int step : about_) {
      const int place = cells_[i] + step;
      if (place < 0 || place >= static_cast<int>(at_cell_.size())) continue;
      const std::int32_t index = at_cell_[static_cast<std::size_t>(place)];
      if (index >= 0) null = std::max(null, score_[static_cast<std::size_t>(index)]);
    }
    told += best - null > needed;
  }
  return static_cast<double>(told) / std::max(all, 1);
}

Eigen::Vector3d DriftTest::best_near_mm() const {
  constexpr float kNear_mm = 1.0f, kAsWell = 0.06f;
  float best = -1e9f, smallest_mm = 1e9f;
  Eigen::Vector3f smallest = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < score_.size(); ++i)
    if (displacements_[i].norm() <= kNear_mm) best = std::max(best, score_[i]);
  for (std::size_t i = 0; i < score_.size(); ++i) {
    const float norm_mm = displacements_[i].norm();
    if (norm_mm > kNear_mm || score_[i] < best - kAsWell * std::abs(best) || norm_mm >= smallest_mm) continue;
    smallest_mm = norm_mm;
    smallest = displacements_[i];
  }
  return smallest.cast<double>();
}

}  // namespace arthronaut::contour
