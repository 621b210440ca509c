// A number or a vector that may be missing, in the room of one that is there. std::optional takes eight bytes
// more, which count where a stroke of an hour has two hundred thousand points. NaN stands for a missing one,
// so that a value that is NaN is none; else it reads as std::optional does.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

namespace arthronaut::strokes {

// T: double, or a vector of Eigen's.
template <typename T>
class PackedOptional {
 public:
  PackedOptional() : PackedOptional(std::nullopt) {}
  PackedOptional(std::nullopt_t) {
    if constexpr (std::is_floating_point_v<T>)
      value_ = kMissing;
    else
      value_.setConstant(kMissing);
  }
  PackedOptional(const T& value) : value_(value) {}
  PackedOptional(const std::optional<T>& value) : PackedOptional() {
    if (value) value_ = *value;
  }
  operator std::optional<T>() const { return has_value() ? std::optional<T>(value_) : std::nullopt; }

  [[nodiscard]] bool has_value() const {
    if constexpr (std::is_floating_point_v<T>)
      return !std::isnan(value_);
    else
      return !value_.hasNaN();
  }
  explicit operator bool() const { return has_value(); }
  // Precondition of the three: has_value().
  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }
  T* operator->() { return &value_; }
  [[nodiscard]] T value_or(const T& other) const { return has_value() ? value_ : other; }

  friend bool operator==(const PackedOptional& a, const PackedOptional& b) {
    return a.has_value() == b.has_value() && (!a.has_value() || a.value_ == b.value_);
  }

 private:
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  T value_;
};

}  // namespace arthronaut::strokes
