#include "navigation/contour/agreement.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::contour {

namespace {

constexpr double kLongestStep_s = 0.2;
constexpr double kFilled = 0.5;  // of the memory, before it says anything
// Less alike than this a piece never was a good one to ask.
constexpr float kLeastExpected = 0.45f;

}  // namespace

Agreement::Agreement(std::size_t place_count, const AgreementOptions& options)
    : options_(options), expected_(place_count, -1.0f) {}

void Agreement::clear() {
  std::fill(expected_.begin(), expected_.end(), -1.0f);
  frame_asked_ = frame_alike_ = 0;
  asked_ = alike_ = weight_ = differed_for_s_ = agreed_for_s_ = 0;
  verdict_ = {};
}

void Agreement::add(std::size_t index, const ShiftMap& map, bool learns) {
  if (!map.is_as_clear) return;
  float& expected = expected_[index];
  if (expected < 0) {
    if (learns) expected = map.in_place;
    return;
  }
  if (expected >= kLeastExpected) {
    ++frame_asked_;
    const bool is_alike = map.in_place >= static_cast<float>(options_.alike_from_share) * expected;
    frame_alike_ += is_alike;
    learns = learns && is_alike;
  }
  if (learns) expected += static_cast<float>(options_.learnt_share) * (map.in_place - expected);
}

const AgreementVerdict& Agreement::judge(double elapsed_s) {
  const double elapsed = std::clamp(elapsed_s, 0.0, kLongestStep_s);
  const double kept = std::exp(-elapsed / options_.memory_s);
  weight_ = kept * weight_ + (1 - kept);
  asked_ = kept * asked_ + (1 - kept) * frame_asked_;
  alike_ = kept * alike_ + (1 - kept) * frame_alike_;
  const bool agrees_now = frame_alike_ >= options_.agrees_from_share * frame_asked_;
  frame_asked_ = frame_alike_ = 0;
  verdict_.is_asked = weight_ > kFilled && asked_ >= options_.fewest_pieces * weight_;
  verdict_.share = asked_ > 0 ? alike_ / asked_ : 0;
  verdict_.agrees = verdict_.is_asked && agrees_now && verdict_.share >= options_.agrees_from_share;
  verdict_.differs = verdict_.is_asked && verdict_.share < options_.differs_below_share;
  differed_for_s_ = verdict_.differs ? differed_for_s_ + elapsed : 0;
  agreed_for_s_ = verdict_.agrees ? agreed_for_s_ + elapsed : 0;
  if (differed_for_s_ >= options_.holds_s) verdict_.is_otherwise = true;
  if (agreed_for_s_ >= options_.recovers_s) verdict_.is_otherwise = false;
  return verdict_;
}

}  // namespace arthronaut::contour
