// What the next step waits for, in the surgeon's words: "the probe is covered". A lamp says that something is
// missing; this says what, beside what is to be done. Pure, but for SteadyWords.
#pragma once

#include <string>

#include "app/navigate/operation_rail.h"
#include "navigation/theatre/source_watch.h"

namespace arthronaut::navigate {

// Of the bone's world marker, or of a tool by its name ("probe"), as the newest picture or the outside
// tracker sees it: "bone marker not seen"; empty while it is tracked.
[[nodiscard]] std::string why_not_tracked(const pipeline::FrameResult& result, int marker_id,
                                          const std::string& name);
// What is to be done next is done by the guide.
[[nodiscard]] bool needs_guide(const operation::OperationState& state);
// What in the newest picture keeps the next action from being done, the first thing where there are several;
// empty while nothing does. trouble: of the source. Of pictures that do not come it says nothing:
// words_without_pictures() does.
[[nodiscard]] std::string hindrance_of(const operation::OperationState& state,
                                       theatre::SourceTrouble trouble);
// What a step of the rail waits for where no picture tells: of one that the surgeon went back to everything,
// of the one of now what has to be done elsewhere first. Empty: nothing.
[[nodiscard]] std::string hindrance_of(const RailStep& step, bool is_looked_at);

// Words that change with single pictures, held still enough to be read: new ones are said once they have
// lasted, and none at once.
class SteadyWords {
 public:
  static constexpr double kLasted_s = 0.3;
  // Those to be shown at `now_s`.
  const std::string& follow(const std::string& words, double now_s);

 private:
  std::string shown_, coming_;
  double since_s_ = 0;  // that what comes has been the same
};

// What was said once, of something that was refused: it need not stand there all through an operation.
class PassingWords {
 public:
  static constexpr double kRead_s = 20;
  // True: these have stood there for as long as it takes to see and to read them.
  [[nodiscard]] bool are_read(const std::string& words, double now_s);

 private:
  std::string words_;
  double since_s_ = 0;
};

}  // namespace arthronaut::navigate
