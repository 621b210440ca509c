#include "planning/tunnels/half_plane.h"

#include <algorithm>

namespace arthronaut::tunnels {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoughness_mm = 1.0;
constexpr double kHair_mm = 1e-6;  // stations nearer to each other are one

}  // namespace

// Between two of these neither the surface nor the side of the tunnel that lies in bone changes.
void HalfPlane::find_stations() {
  stations_.assign({low_mm_, 0, length_mm_, high_mm_});
  for (const Cut& cut : cuts_) {
    stations_.push_back(std::clamp(cut.from_mm, low_mm_, high_mm_));
    stations_.push_back(std::clamp(cut.to_mm, low_mm_, high_mm_));
    for (const std::array<double, 2>& ends :
         {std::array{cut.from_radius_mm - radius_mm_, cut.to_radius_mm - radius_mm_}, cut.entry_lip.same,
          cut.entry_lip.facing, cut.exit_lip.same, cut.exit_lip.facing}) {
      if (ends[0] * ends[1] >= 0) continue;
      const double root = cut.from_mm + ends[0] / (ends[0] - ends[1]) * (cut.to_mm - cut.from_mm);
      stations_.push_back(std::clamp(root, low_mm_, high_mm_));
    }
  }
  std::sort(stations_.begin(), stations_.end());
  stations_.erase(
      std::unique(stations_.begin(), stations_.end(), [](double a, double b) { return b - a < kHair_mm; }),
      stations_.end());
}

Stretch HalfPlane::stretch_at(double from, double to) const {
  const double middle = 0.5 * (from + to);
  const Cut *outwards = nullptr, *inwards = nullptr;
  double outwards_mm = kInfinity, inwards_mm = -kInfinity;
  for (const Cut* cut : open_) {
    const double radius = cut->radius_at(middle);
    if (radius >= radius_mm_ && radius < outwards_mm) {
      outwards_mm = radius;
      outwards = cut;
    } else if (radius < radius_mm_ && radius > inwards_mm) {
      inwards_mm = radius;
      inwards = cut;
    }
  }
  // With nothing between them the side lies where the axis does, which is in bone from mouth to mouth.
  const bool axis_in_bone = middle > 0 && middle < length_mm_;
  const bool in_bone = outwards ? outwards->comes_out : inwards ? !inwards->comes_out : axis_in_bone;
  return {from, to, in_bone, in_bone ? outwards : inwards};
}

void HalfPlane::find_stretches() {
  std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) { return a.from_mm < b.from_mm; });
  stretches_.clear();
  open_.clear();
  auto next = cuts_.begin();
  for (std::size_t i = 0; i + 1 < stations_.size(); ++i) {
    const double middle = 0.5 * (stations_[i] + stations_[i + 1]);
    for (; next != cuts_.end() && next->from_mm <= middle; ++next) open_.push_back(&*next);
    std::erase_if(open_, [&](const Cut* cut) { return cut->to_mm < middle; });
    stretches_.push_back(stretch_at(stations_[i], stations_[i + 1]));
  }
}

// The side enters the bone before the axis does on one side of a slanting mouth. Where it is still outside
// when the axis enters it is looked at from there on.
void HalfPlane::keep_from_mouth_to_mouth() {
  auto first = std::find_if(stretches_.begin(), stretches_.end(),
                            [](const Stretch& s) { return s.from_mm > -2 * kHair_mm; });
  if (first->in_bone)
    while (first != stretches_.begin() && (first - 1)->in_bone) --first;
  auto last = std::find_if(first, stretches_.end(),
                           [&](const Stretch& s) { return s.to_mm > length_mm_ - 2 * kHair_mm; });
  if (last->in_bone)
    while (last + 1 != stretches_.end() && (last + 1)->in_bone) ++last;
  stretches_.erase(last + 1, stretches_.end());
  stretches_.erase(stretches_.begin(), first);
}

// Where the lip is over; `to` where it never is. What is no lip for less than kRoughness_mm does not end it.
template <typename Iterator, typename LipOf>
Iterator HalfPlane::beyond_lip(Iterator from, Iterator to, LipOf lip_of) {
  double run_mm = 0;
  Iterator began = from;
  for (Iterator at = from; at != to; ++at) {
    if (at->end && at->is_lip(lip_of(*at->end))) {
      run_mm = 0;
      continue;
    }
    if (run_mm == 0) began = at;
    run_mm += at->length_mm();
    if (run_mm >= kRoughness_mm) return began;
  }
  return to;
}

void HalfPlane::add_outside(const Stretch& stretch) {
  if (outside_.empty() || stretch.from_mm > outside_.back().to_mm + kHair_mm)
    outside_.push_back({stretch.from_mm, stretch.to_mm});
  else
    outside_.back().to_mm = stretch.to_mm;
}

Thinnest HalfPlane::thinnest() {
  outside_.clear();
  find_stations();
  find_stretches();
  keep_from_mouth_to_mouth();
  const auto from = beyond_lip(stretches_.begin(), stretches_.end(),
                               [](const Cut& cut) -> const LipEnds& { return cut.entry_lip; });
  const auto to = beyond_lip(stretches_.rbegin(), stretches_.rend(), [](const Cut& cut) -> const LipEnds& {
                    return cut.exit_lip;
                  }).base();
  Thinnest found;
  between_lips_ = {};
  if (from < to) {
    between_lips_ = {from->from_mm, (to - 1)->to_mm};
    for (auto at = from; at != to; ++at) {
      if (!at->end) continue;
      if (!at->in_bone) add_outside(*at);
      for (const double station : {at->from_mm, at->to_mm})
        found.take(at->end->radius_at(station), station, at->end->of);
    }
    return found;
  }
  // One lip runs into the other, as on a lens: between them stands the rim.
  double rim_mm = 0, at_mm = 0;
  for (const Stretch& stretch : stretches_) {
    if (!stretch.end || stretch.end->radius_at(stretch.to_mm) <= rim_mm) continue;
    rim_mm = stretch.end->radius_at(stretch.to_mm);
    at_mm = stretch.to_mm;
  }
  if (rim_mm > 0) found.take(rim_mm, at_mm, nullptr);
  return found;
}

}  // namespace arthronaut::tunnels
