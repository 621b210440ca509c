// Who takes the second looks at the medium: at once, or beside the frames.
#pragma once

#include <memory>

#include "navigation/operation/medium_look.h"

namespace arthronaut::theatre {

class MediumLookService {
 public:
  virtual ~MediumLookService() = default;
  virtual void post(operation::MediumLookRequest request, const camera::FramePtr& picture) = 0;
  // The newest; null before the first.
  [[nodiscard]] virtual operation::MediumLookPtr latest() const = 0;
};

// In the caller's thread: what is posted is seen when post() returns. For tests.
[[nodiscard]] std::unique_ptr<MediumLookService> looks_at_once();
// On a thread of its own. One that is asked for while another is under way waits, the newest alone.
[[nodiscard]] std::unique_ptr<MediumLookService> looks_beside();

}  // namespace arthronaut::theatre
