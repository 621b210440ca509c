// Whether the pictures fit the medium that is said to be before the lens (pipeline/medium_check.h), with the
// second looks that it asks for: one at a time, taken beside the frames (medium_look.h).
//
// All of it is of one source, its markers and its medium; with another source it begins anew, and a look that
// comes for the one before is not taken.
//
// Thread-free, deterministic.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "navigation/operation/medium_look.h"
#include "navigation/pipeline/medium_check.h"
#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::operation {

class MediumWatch {
 public:
  // Pictures through that camera and medium, of these markers. Throws InvalidInput as MediumCheck does; all
  // is then as before.
  void on_source(const pipeline::PipelineOptions& options);
  // No picture comes any more: nothing is asked for, and what was is not waited for. The verdict stays: it is
  // of what was seen.
  void on_source_end();

  // Every frame, in order of time. `options` as on_source() took them. Precondition: on_source() was called.
  void look(const pipeline::FrameResult& frame, const pipeline::PipelineOptions& options);
  // The picture of the newest frame is to be seen in the other medium; once for each.
  [[nodiscard]] std::optional<MediumLookRequest> take_request() {
    return std::exchange(request_, std::nullopt);
  }
  [[nodiscard]] bool awaits(const MediumLook& look) const {
    return look.source_number == source_number_ && awaited_ == look.view.frame_index;
  }
  // Precondition: it is awaited. One that failed has seen nothing, and another one is asked for as after any.
  void take(const MediumLook& look);

  // Of a source that runs or ran last; unknown before the first.
  [[nodiscard]] pipeline::MediumVerdict verdict() const;
  [[nodiscard]] bool contradicts() const { return verdict().fit == pipeline::MediumFit::Contradicts; }
  // Guidance waits for the pictures' word on the medium (MediumVerdict::is_held).
  [[nodiscard]] bool holds() const;
  // A frame of a record guided whose picture is not there to be seen again: the medium was confirmed by then.
  void confirmed_by_record() { is_confirmed_by_record_ = true; }

 private:
  std::optional<pipeline::MediumCheck> check_;
  bool is_confirmed_by_record_ = false;
  std::uint64_t source_number_ = 0;
  std::optional<MediumLookRequest> request_;
  std::optional<std::int64_t> awaited_;  // the frame whose picture is being seen again
};

}  // namespace arthronaut::operation
