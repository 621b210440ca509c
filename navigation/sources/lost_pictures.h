// How many pictures were lost between a camera and its reader, by the driver's count, and when that is worth
// saying.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace arthronaut::sources {

class LostPictures {
 public:
  // A picture with the driver's number of it came; how many between it and the one before did not. Damaged
  // ones are lost as well.
  std::int64_t came(std::uint32_t sequence, bool is_damaged, std::int64_t now_ns);
  // "12 of the last 100 pictures were lost"; empty while it is no more than one in twenty, over the last 2 s.
  [[nodiscard]] const std::string& words() const { return words_; }
  [[nodiscard]] long lost() const { return lost_; }
  [[nodiscard]] long all() const { return all_; }

 private:
  std::optional<std::uint32_t> last_;
  std::int64_t begun_ns_ = 0, not_told_ = 0;
  long lost_ = 0, all_ = 0, lost_before_ = 0, all_before_ = 0;  // before: at the beginning of the 2 s
  std::string words_;
};

}  // namespace arthronaut::sources
