// Who works the registration's requests in: at once, or beside the frames.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "navigation/operation/registration_work.h"

namespace arthronaut::theatre {

// Makes the bone ready; may take seconds, may throw.
using BoneMaker = std::function<operation::SurfaceIndexPtr()>;

class RegistrationService {
 public:
  virtual ~RegistrationService() = default;
  // In order.
  virtual void post(std::vector<operation::RegistrationRequest> requests) = 0;
  // The newest outcome, whole; null before the first.
  [[nodiscard]] virtual operation::OutcomePtr latest() const = 0;
};

// In the caller's thread: what is posted is worked in when post() returns. For the command line and tests.
[[nodiscard]] std::unique_ptr<RegistrationService> registration_at_once(
    const BoneMaker& bone, const operation::RegistrationWorkOptions& options);
// On a thread of its own, which also makes the bone ready. on_news is called from it. What had waited while
// the bone was made ready, or while a search took long, is published as a whole, not step by step: nothing
// takes effect that strokes drawn meanwhile may disprove.
[[nodiscard]] std::unique_ptr<RegistrationService> registration_beside(
    BoneMaker bone, const operation::RegistrationWorkOptions& options, std::function<void()> on_news);

}  // namespace arthronaut::theatre
