// Whether the probe's tip rests, so that a touch is taken of it, as far as single pictures tell. A hand feels
// that it rests; of a simulated one the screen has to say so.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace arthronaut::navigate {

class RestingTip {
 public:
  // Of the newest picture, in the world marker's frame; nullopt: it is not seen. Another source's clock
  // begins anew.
  void follow(std::int64_t timestamp_ns, const std::optional<Eigen::Vector3d>& tip_in_world_mm) {
    constexpr double kSamePlace_mm = 0.5;  // within which operation::SteadyTip calls it steady, twice over
    const bool stays = tip_in_world_mm && at_mm_ && timestamp_ns >= now_ns_ &&
                       (*tip_in_world_mm - *at_mm_).norm() < kSamePlace_mm;
    now_ns_ = timestamp_ns;
    if (stays) return;
    at_mm_ = tip_in_world_mm;
    since_ns_ = timestamp_ns;
  }
  [[nodiscard]] bool rests() const {
    constexpr std::int64_t kTakes_ns = 300'000'000;  // what a touch is made of, and a little more
    return at_mm_ && now_ns_ - since_ns_ >= kTakes_ns;
  }

 private:
  std::optional<Eigen::Vector3d> at_mm_;
  std::int64_t since_ns_ = 0, now_ns_ = 0;
};

}  // namespace arthronaut::navigate
