// How good the guide's numbers are, by their size and by their predicted error. A number that trembles about
// its limit would turn from green to amber and back with every picture; so in theatre what is worse is told
// at once, and what is better once every picture has shown it for kHolds_ns. Review, which shows one picture,
// says what that one is worth alone.
//
// A held grade is the worst of the pictures of that time, and nothing else is remembered: the same pictures
// give the same one on replay. A picture without valid numbers has no grade and changes none.
//
// Thread-free, deterministic; allocates nothing.
#pragma once

#include <cstdint>
#include <optional>

#include "navigation/guidance/guidance.h"

namespace arthronaut::operation {

// From good to bad. None: no number is valid.
enum class Grade { None, Good, Caution, Bad };

struct GuidanceGrades {
  Grade offset = Grade::None, angle = Grade::None;
};

// Of these numbers alone; meaningful where they are valid. Good: offset under 1 mm, angle under 2 degrees,
// each with a predicted error (one sigma) under the same number. Caution: under 2 mm and 4 degrees. Bad:
// anything else, and whatever is known to no better than that. The program's own thresholds.
[[nodiscard]] GuidanceGrades grades_of(const guidance::GuidanceNumbers& guidance);

class HeldGrades {
 public:
  static constexpr std::int64_t kHolds_ns = 400'000'000;

  // Every picture's numbers, in order of time.
  void add(const guidance::GuidanceNumbers& guidance, std::int64_t now_ns);
  // Another source, plan or registration: what was shown until now says nothing of the numbers that come.
  void on_other_numbers() { *this = HeldGrades(); }
  // As of the newest picture; None where its numbers are not valid.
  [[nodiscard]] const GuidanceGrades& grades() const { return grades_; }

 private:
  // The worst of the last pictures, by when each grade was seen last.
  class Held {
   public:
    [[nodiscard]] Grade add(Grade grade, std::int64_t now_ns);

   private:
    std::optional<std::int64_t> bad_ns_, caution_ns_;
  };
  Held offset_, angle_;
  GuidanceGrades grades_;
};

}  // namespace arthronaut::operation
