#include "navigation/theatre/source_watch.h"

#include <algorithm>
#include <array>

#include "planning/files/format.h"

namespace arthronaut::theatre {

namespace {

// Of a source that is slower, and said to be, three of its own pictures, up to so long.
constexpr std::int64_t kLongestSilence_ns = 1'000'000'000;
// What is over in a moment is on the screen long enough to be read.
constexpr std::int64_t kReadable_ns = 2'000'000'000, kSaidAnew_ns = 1'000'000'000;
// Between pictures; faster ones, and those that were older when they came than the next one let them get, are
// late for want of a faster machine.
constexpr double kFew_ms = 50;
// Sources of 30 pictures a second that are sent 60 times repeat half of them, and are none the worse for it.
// Neither are those of 24 that are: 15 of the 25 of 0.4 s, and one more or less.
constexpr double kTooManyRepeats = 0.65;

constexpr std::array<std::string_view, 9> kTroubleNames{"",
                                                        "no picture",
                                                        "plain picture",
                                                        "frozen picture",
                                                        "torn picture",
                                                        "repeated pictures",
                                                        "late pictures",
                                                        "slow pictures",
                                                        "lost pictures"};

}  // namespace

std::string_view to_text(SourceTrouble trouble) { return kTroubleNames[static_cast<std::size_t>(trouble)]; }

bool shows_nothing(SourceTrouble trouble) {
  return trouble == SourceTrouble::NoPicture || trouble == SourceTrouble::Plain ||
         trouble == SourceTrouble::Frozen || trouble == SourceTrouble::Torn;
}

std::string to_record(SourceTrouble trouble, const std::string& words) {
  return trouble == SourceTrouble::None ? "" : std::string(to_text(trouble)) + "; " + words;
}

SourceTrouble trouble_in(std::string_view record) {
  const auto name = std::ranges::find(kTroubleNames, record.substr(0, record.find(';')));
  return name == kTroubleNames.end() ? SourceTrouble::Lost
                                     : static_cast<SourceTrouble>(name - kTroubleNames.begin());
}

bool is_of_now(double age_s, SourceTrouble trouble, double late_after_s) {
  constexpr double kSlowPicture_s = 0.3;
  return age_s <= (trouble == SourceTrouble::Slow ? kSlowPicture_s : late_after_s);
}

bool SourceWatch::set(SourceTrouble trouble, const std::string& words) {
  const bool is_another = trouble != trouble_;
  trouble_ = trouble;
  if (words_ != words) words_ = words;
  return is_another;
}

void SourceWatch::shown_until(double age_ms, std::int64_t now_ns) {
  const bool is_too_old = age_ms > late_after_ms_;
  if (is_too_old) replaced_ms_ = age_ms;
  too_old_ = too_old_ << 1 | std::bitset<6>(is_too_old ? 1 : 0);
  if (is_too_old) slow_ns_ = now_ns;
  is_slow_ = 2 * too_old_.count() >= too_old_.size() || (is_slow_ && now_ns - slow_ns_ < kReadable_ns);
}

bool SourceWatch::are_too_few() const { return gap_ms_ > kFew_ms && 2 * gap_ms_ > replaced_ms_; }

std::string SourceWatch::words_of_slow() const {
  if (are_too_few())
    return files::format("%.0f a second are too few: each is too old to guide by before the next one",
                         1000 / gap_ms_);
  // Most of its age it has before this machine knows of it.
  if (2 * received_ms_ > replaced_ms_)
    return files::format(
        "Each is %.0f ms old when it comes: see to what sends it (encoder without B-frames, network)",
        received_ms_);
  return files::format("Each is over %.0f ms old before the next one is shown: end other programs",
                       late_after_ms_);
}

void SourceWatch::received(double age_ms) {
  received_ms_ += (received_ms_ > 0 ? 0.3 : 1.0) * (std::max(age_ms, 0.0) - received_ms_);
}

std::int64_t SourceWatch::silence_ns() const {
  // However slow the machine is: of a source that falls silent it says nothing.
  if (!is_slow_ || !are_too_few()) return kSilence_ns;
  return std::clamp(static_cast<std::int64_t>(3e6 * gap_ms_), kSilence_ns, kLongestSilence_ns);
}

bool SourceWatch::silence(const std::string& why, std::int64_t now_ns,
                          const std::optional<Eigen::Vector2i>& changed_to_px) {
  changed_to_px_ = changed_to_px;
  if (!has_begun_) {  // counted from the first time that somebody waited
    has_begun_ = true;
    last_picture_ns_ = now_ns;
  }
  if (now_ns - last_picture_ns_ < silence_ns() && why.empty()) return false;
  const std::string words = why.empty() ? "No picture comes" : "No picture comes: " + why;
  // Its reason may change with every attempt to connect again: it is news once a second at most, and the one
  // that stays is told then.
  const bool is_news = set(SourceTrouble::NoPicture, words) ||
                       (words != silence_said_ && now_ns - silence_said_ns_ >= kSaidAnew_ns);
  if (!is_news) return false;
  silence_said_ = words;
  silence_said_ns_ = now_ns;
  return true;
}

bool SourceWatch::picture(const pipeline::PictureObservation& view, double guidance_ms, std::int64_t now_ns,
                          const std::string& remark) {
  changed_to_px_.reset();
  if (has_begun_) {
    const std::int64_t gap_ns = now_ns - last_picture_ns_;
    // A pause is no pace.
    if (gap_ns < kLongestSilence_ns)
      gap_ms_ += (gap_ms_ > 0 ? 0.3 : 1.0) * (static_cast<double>(gap_ns) * 1e-6 - gap_ms_);
  }
  has_begun_ = true;
  last_picture_ns_ = now_ns;
  if (view.is_torn) {
    was_torn_ = true;
    torn_ns_ = now_ns;
  }
  if (guidance_ms > late_after_ms_) {
    was_late_ = true;
    late_ns_ = now_ns;
    late_ms_ = guidance_ms;
  }
  was_torn_ = was_torn_ && now_ns - torn_ns_ < kReadable_ns;
  was_late_ = was_late_ && now_ns - late_ns_ < kReadable_ns;
  if (view.is_blank)
    return set(SourceTrouble::Plain, "The picture is plain: no light, or no signal from the camera");
  if (view.is_frozen)
    return set(SourceTrouble::Frozen,
               "The source sends the same picture again and again: check cable and camera");
  if (is_slow_) {
    if (trouble_ == SourceTrouble::Slow && now_ns - late_said_ns_ < kSaidAnew_ns) return false;
    late_said_ns_ = now_ns;
    return set(SourceTrouble::Slow, words_of_slow());
  }
  if (was_late_) {
    // The words change with the number only when it is said anew: once a second can be read.
    if (trouble_ == SourceTrouble::Late && (late_ns_ != now_ns || now_ns - late_said_ns_ < kSaidAnew_ns))
      return false;
    late_said_ns_ = now_ns;
    return set(SourceTrouble::Late,
               files::format("Pictures are late: %.0f ms from capture to guidance, %.0f ms may pass",
                             late_ms_, late_after_ms_));
  }
  if (was_torn_)
    return set(SourceTrouble::Torn,
               "Torn pictures: parts of two moments in one. Check cable and capture card");
  if (view.repeat_share > kTooManyRepeats) {
    if (trouble_ == SourceTrouble::Repeated) return false;
    return set(SourceTrouble::Repeated,
               files::format("The source repeats %.0f pictures in 100", 100 * view.repeat_share));
  }
  // Its words count on; they change with the first ones only.
  if (!remark.empty()) return trouble_ != SourceTrouble::Lost && set(SourceTrouble::Lost, remark);
  return set(SourceTrouble::None, "");
}

}  // namespace arthronaut::theatre
