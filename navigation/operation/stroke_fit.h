// The registration of all strokes: which was asked for, of what, and whether it still counts when it comes.
//
// One is of the strokes in use when it was asked for. When these change it is not waited for any more, though
// it is still under way: the next one has to wait for its end. Which strokes were tried is known so that the
// same are not asked of again: the same again gives the same, at the same plan.
//
// Thread-free, deterministic. Lengths in mm.
#pragma once

#include <cstdint>
#include <set>

#include "navigation/operation/now_and_then.h"
#include "navigation/operation/registration_work.h"
#include "navigation/operation/stroke_book.h"

namespace arthronaut::operation {

class StrokeFit {
 public:
  // Points that were drawn are gone: what was tried is not what is drawn now.
  void on_strokes_gone();
  // Strokes were excluded, or taken in again.
  void on_strokes_excluded();
  // All of them are gone: the next ones are as long as they are.
  void on_strokes_cleared();
  // It is judged at another place: the same strokes may give another verdict.
  void on_aim() { tried_points_ = 0; }
  // Nothing can be registered to this bone: what was asked for will never come.
  void on_failure() { is_under_way_ = is_wanted_ = false; }

  [[nodiscard]] bool is_under_way() const { return is_under_way_; }
  // These strokes are to be registered now. What is to be asked; empty: none of them is long enough. Then
  // asked_with() says with which request. Precondition: none is under way.
  [[nodiscard]] std::optional<FitAll> ask(const StrokeBook& strokes);
  void asked_with(std::uint64_t request_count) { request_ = request_count; }
  // The one of that number has come. True where its result is still wanted.
  [[nodiscard]] bool has_come(int number);

  // Of the newest that was asked for: the request that it was, and the length of its strokes; of those that
  // were cleared since 0.
  [[nodiscard]] std::uint64_t request() const { return request_; }
  [[nodiscard]] double length_mm() const { return length_mm_; }
  // These very ones were asked of already, and nothing has changed since.
  [[nodiscard]] bool tried(const StrokeBook& strokes) const;
  // Whether to look for one that nobody asks for.
  [[nodiscard]] bool is_time_to_look(std::int64_t now_ns) { return looks_.is_time(now_ns); }

 private:
  int number_ = 0;
  std::uint64_t request_ = 0;
  double length_mm_ = 0;
  std::size_t tried_points_ = 0;  // that were drawn then, and the strokes that were not used
  std::set<int> tried_without_;
  bool is_under_way_ = false, is_wanted_ = false;
  NowAndThen looks_;
};

}  // namespace arthronaut::operation
