// What is wrong with a live source, in words, while it is wrong: no picture comes, the picture is plain,
// frozen, torn, repeated, late or too slow, or others are lost. Says it within half a second and takes it
// back when it is over. Guidance does not wait for it: what a picture does not stand for is gone in that
// picture, and an old picture guides nobody.
//
// Pure: told of pictures and of their absence, with the time; one thread at a time.
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>

#include "navigation/pipeline/view_tracker.h"
#include "navigation/tracker/pose_book.h"

namespace arthronaut::theatre {

// Late: pictures that are too old to guide by now and then; Slow: so many that nothing may guide, steadily.
enum class SourceTrouble { None, NoPicture, Plain, Frozen, Torn, Repeated, Late, Slow, Lost };
// "no picture", "plain picture", ...; empty for None.
[[nodiscard]] std::string_view to_text(SourceTrouble trouble);
// Nothing, or nothing of the knee, is seen in the pictures, or parts of two moments: what is said beside them
// is said by no picture.
[[nodiscard]] bool shows_nothing(SourceTrouble trouble);
// What a record keeps of it, "no picture; No picture comes: tower: broke off", and what that was of; empty
// for None. What names no trouble is Lost: something was wrong.
[[nodiscard]] std::string to_record(SourceTrouble trouble, const std::string& words);
[[nodiscard]] SourceTrouble trouble_in(std::string_view record);

// Whether a live picture of this age may be shown, and told to others, as one of now. Of a slow source no
// picture guides, and what is young enough for a touch (see OperationRun::apply) is shown all the same.
// The limit that an outside tracker's poses have, too.
inline constexpr double kLateAfter_s = tracker::PoseBook::kMaxAge_s;
[[nodiscard]] bool is_of_now(double age_s, SourceTrouble trouble, double late_after_s = kLateAfter_s);

// Three pictures of a slow source (10 a second) without one are told of; half a second may pass until it is.
inline constexpr std::int64_t kSilence_ns = 300'000'000;

class SourceWatch {
 public:
  SourceWatch() = default;
  explicit SourceWatch(double late_after_ms) : late_after_ms_(late_after_ms) {}

  // The picture that is told of next was so old when it came, before anything was done with it; below 0:
  // nobody knows. Tells a slow sender from a slow machine.
  void received(double age_ms);
  // A picture that was worked in; guidance_ms: from its capture until guidance was known, below 0 when nobody
  // knows; remark: what the source says of its pictures. True: what is wrong has changed.
  bool picture(const pipeline::PictureObservation& view, double guidance_ms, std::int64_t now_ns,
               const std::string& remark = "");
  // The screen drew a picture for the last time when it was so old, and then the next one. Tells with the
  // next picture whether the source is too slow: half of six were drawn when they were too old. For as long
  // as that goes on what guides would come and go with every picture. Over once none was for two seconds.
  void shown_until(double age_ms, std::int64_t now_ns);
  // None came since the last call; why, as the source says it, and in which size they come that it does not
  // give. True: it is silent now, or for another reason, which is said once a second.
  bool silence(const std::string& why, std::int64_t now_ns,
               const std::optional<Eigen::Vector2i>& changed_to_px = std::nullopt);

  [[nodiscard]] SourceTrouble trouble() const { return trouble_; }
  // "No picture comes: rtsp://tower/scope: broke off; connecting again"; empty while all is well.
  [[nodiscard]] const std::string& words() const { return words_; }
  // With NoPicture: they come in that size, and no waiting ends it. Empty: nobody says so.
  [[nodiscard]] const std::optional<Eigen::Vector2i>& changed_to_px() const { return changed_to_px_; }

 private:
  bool set(SourceTrouble trouble, const std::string& words);
  [[nodiscard]] std::int64_t silence_ns() const;
  // Of a slow source, by what it is slow.
  [[nodiscard]] std::string words_of_slow() const;
  [[nodiscard]] bool are_too_few() const;  // it is its rate, and not the machine

  double late_after_ms_ = 1000 * kLateAfter_s;
  SourceTrouble trouble_ = SourceTrouble::None;
  std::string words_, silence_said_;
  std::optional<Eigen::Vector2i> changed_to_px_;
  std::int64_t silence_said_ns_ = 0;
  std::int64_t last_picture_ns_ = 0, torn_ns_ = 0, late_ns_ = 0, late_said_ns_ = 0, slow_ns_ = 0;
  double late_ms_ = 0, gap_ms_ = 0;  // between pictures, lately
  double received_ms_ = 0;           // how old they were when they came, lately; 0: not known
  double replaced_ms_ = 0;           // how old one that was too old was when the next one was shown
  bool has_begun_ = false, was_torn_ = false, was_late_ = false, is_slow_ = false;
  std::bitset<6> too_old_;  // of those that were shown last
};

}  // namespace arthronaut::theatre
