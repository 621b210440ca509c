// Whether a picture comes in time to guide by. What comes too late guides nobody: its numbers are hidden in
// the operation's state, so that screen, record, drilling and whoever listens have the same ones, or none.
#pragma once

#include <functional>

#include "navigation/guidance/guidance.h"
#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::operation {

enum class PictureTiming {
  InTime,
  Late,  // it is too old already
  Slow,  // so are most, before the next one is shown: for as long as that lasts none guides
};

// Asked once for each picture, when what it shows is known: by the clock of whoever took it, which no
// operation has. A record answers as it was then (timing_of).
using AskTiming = std::function<PictureTiming(const pipeline::FrameResult& frame)>;

// Why nothing guides; for InTime: Valid.
[[nodiscard]] inline guidance::GuidanceState hidden_as(PictureTiming timing) {
  using guidance::GuidanceState;
  switch (timing) {
    case PictureTiming::InTime:
      return GuidanceState::Valid;
    case PictureTiming::Late:
      return GuidanceState::PictureLate;
    case PictureTiming::Slow:
      return GuidanceState::PicturesSlow;
  }
  return GuidanceState::Valid;
}

// As the guidance of a recorded frame says it. In time, too, where something else was in its way: then
// nothing was to be hidden.
[[nodiscard]] inline PictureTiming timing_of(guidance::GuidanceState recorded) {
  for (const PictureTiming timing : {PictureTiming::Late, PictureTiming::Slow})
    if (recorded == hidden_as(timing)) return timing;
  return PictureTiming::InTime;
}

}  // namespace arthronaut::operation
