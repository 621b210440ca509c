#include "navigation/pipeline/repeated_pictures.h"

#include <algorithm>
#include <utility>

namespace arthronaut::pipeline {

namespace {

// Measured at 1080p on path-traced arthroscopy (mean difference within the worst tile, grey values). A still
// coded anew: 0 to 0.2 in four frames of five (H.264 and MPEG-4, CRF 15 to 30, 8 Mb/s constant rate), up
// to 5.7 from one key frame to another. The same scene held still under sensor noise and coded at CRF 15 to
// 18: 1.1 and more in every frame. Moving clips: 11 and more.
constexpr double kMostRepeat = 0.3, kLeastRepeat = 0.1, kShareOfNoise = 0.3;
// What an encoder adds to a picture that hangs, where it stopped: up to 0.38 of the noise, or 0.03 of what
// moved before (H.264, 8 Mb/s at 640 x 480, CRF 18 to 28 at 1080p). But for one picture in a dozen, a key
// frame or the first one: 0.21 of what moved before.
// Within four pictures it halves.
constexpr double kRefinedOfNoise = 0.45, kRefinedOfMotion = 0.03, kStopped = 0.25, kDecayed = 0.45;
constexpr double kMotion = 8;  // no key frame of the same picture changes a tile by so much
// Two repeats more than the source is used to make: 67 ms at 30 pictures a second, which come up to 7 ms
// nearer to each other where sender and network are busy.
constexpr int kRepeatsTooMany = 2;
constexpr std::int64_t kRepeatingFor_ns = 55'000'000, kTooOld_ns = 95'000'000;
// Within so long after a stop an encoder's refinement is told from a scope at rest, of which the worst tile
// changes by all of the noise. It may go on from key frame to key frame in steps as little as what a codec
// leaves of a scope at rest.
constexpr std::int64_t kUndecided_ns = 300'000'000;
constexpr double kLively = 0.75;
// So many on end that change as much as noise does no encoder makes of a picture that hangs: within four what
// it refines has halved.
constexpr int kLivesOn = 4;
constexpr int kNoHabit = 5;  // repeats on end; what a source makes that hangs is none

}  // namespace

void RepeatedPictures::begin(std::int64_t timestamp_ns) {
  reset();
  steps_[0] = {timestamp_ns};
  count_ = 1;
  row_.since_ns = last_ns_ = timestamp_ns;
}

double RepeatedPictures::most_repeat(double noise) {
  return noise < 0 ? kMostRepeat : std::clamp(kShareOfNoise * noise, kLeastRepeat, kMostRepeat);
}

// As long as three rows of repeats were before the newest one: what came once or twice, as what a source that
// hung a moment ago repeated up to a key frame, is none.
int RepeatedPictures::habit() const {
  const std::size_t known = std::min(count_, kMost);
  std::array<int, 3> longest{};  // falling
  int count = 0;
  for (auto i = static_cast<std::size_t>(row_.count); i < known; ++i) {
    if (steps_[(count_ - 1 - i) % kMost].repeats) {
      ++count;
    } else {
      for (int& row : longest)
        if (count < kNoHabit && count > row) std::swap(count, row);
      count = 0;
    }
  }
  return longest.back();
}

bool RepeatedPictures::is_too_long(const Row& row, std::int64_t timestamp_ns) const {
  const std::int64_t lasted_ns = timestamp_ns - row.since_ns;
  if (row.count < kRepeatsTooMany || lasted_ns < kRepeatingFor_ns) return false;
  return lasted_ns >= kTooOld_ns || row.count >= habit() + kRepeatsTooMany;
}

bool RepeatedPictures::hardly_changes(double largest, double noise) const {
  return largest < std::max(kRefinedOfNoise * noise, kRefinedOfMotion * stop_.moved);
}

// It changes less and less; noise does not.
bool RepeatedPictures::is_refined(double largest, double noise) const {
  const double most = *std::max_element(largest_.begin(), largest_.end());
  return hardly_changes(largest, noise) && largest < kDecayed * most;
}

void RepeatedPictures::follow_stop(double largest, double noise) {
  const bool goes_on = stop_.moved > 0 && largest > kStopped * stop_.moved;
  if (goes_on) {
    stops_and_goes_ = stop_.is_of_repeats();
    // What stood between two pictures that moved is known by the second one; of an encoder's first
    // refinement, which changes as much as noise does, it is known then, too.
    const int between = std::min(stop_.repeats.count + stop_.others, kNoHabit);
    for (int i = 1; stops_and_goes_ && i <= between; ++i)
      steps_[(count_ - static_cast<std::size_t>(i)) % kMost].is_coded_repeat = true;
    stop_ = {};
  }
  if (stop_.moved == 0 && largest < kStopped * largest_[0]) {
    stop_ = {{0, last_ns_}, 0, 0, 0, largest_[0]};
    largest_.fill(0);
  } else if (stop_.moved == 0 && !goes_on) {
    stops_and_goes_ = false;
  }
  if (stop_.moved == 0) return;
  stop_.lively_in_row = largest >= kLively * noise ? stop_.lively_in_row + 1 : 0;
  if (hardly_changes(largest, noise)) {
    ++stop_.repeats.count;
    return;
  }
  ++stop_.others;
  if (largest >= kLively * noise) ++stop_.lively;
  // What went on by a leap, as a source that hung does, and moves by less since, has not stopped.
  if (stop_.lively_in_row >= kLivesOn) stop_ = {};
}

bool RepeatedPictures::observe(double largest, double noise, std::int64_t timestamp_ns) {
  follow_stop(largest, noise);
  const bool is_same = largest < most_repeat(noise), is_refined_now = is_refined(largest, noise);
  const bool repeats = is_same || (is_suspected_ && is_refined_now);
  if (!repeats) row_ = {0, timestamp_ns};
  row_.count += repeats ? 1 : 0;
  const bool hardly = stop_.moved > 0 && hardly_changes(largest, noise);
  const bool is_in_stop = hardly && stop_.is_of_repeats();
  steps_[count_++ % kMost] = {timestamp_ns, repeats, stops_and_goes_ && hardly, is_in_stop};

  const bool hangs = stop_.stands() && (is_same || is_refined_now);
  const bool is_too_many =
      is_too_long(row_, timestamp_ns) || (hangs && is_too_long(stop_.repeats, timestamp_ns));
  if (repeats || is_too_many) lives_since_ns_ = timestamp_ns;
  const bool lives = largest > kMotion || (!repeats && timestamp_ns - lives_since_ns_ >=
                                                           (is_in_stop ? kUndecided_ns : kTooOld_ns));
  is_suspected_ = is_too_many || (is_suspected_ && !lives);
  const bool may_hang =
      stop_.moved > 0 && stop_.lively <= 1 && timestamp_ns - stop_.repeats.since_ns < kUndecided_ns;
  const std::int64_t since_ns = std::min(row_.since_ns, may_hang ? stop_.repeats.since_ns : timestamp_ns);
  shown_for_ns_ = is_suspected_ ? 0 : timestamp_ns - since_ns;
  std::shift_right(largest_.begin(), largest_.end(), 1);
  largest_[0] = largest;
  last_ns_ = timestamp_ns;
  return repeats;
}

template <typename Which>
double RepeatedPictures::share_of(std::int64_t since_ns, const Which& which) const {
  int count = 0, those = 0;
  for (std::size_t i = 0; i < std::min(count_, kMost); ++i) {
    const Step& step = steps_[(count_ - 1 - i) % kMost];
    if (step.timestamp_ns <= since_ns) break;
    ++count;
    those += which(step) ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(those) / count : 0;
}

double RepeatedPictures::share(std::int64_t since_ns) const {
  return share_of(since_ns, [](const Step& step) { return step.repeats || step.is_coded_repeat; });
}

double RepeatedPictures::hanging_share(std::int64_t since_ns) const {
  return share_of(since_ns,
                  [this](const Step& step) { return step.repeats || (is_suspected_ && step.is_in_stop); });
}

}  // namespace arthronaut::pipeline
