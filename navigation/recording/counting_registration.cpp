#include "navigation/recording/counting_registration.h"

#include <utility>

namespace arthronaut::recording {

void CountingRegistration::follow(const SessionEvent& event) {
  // What verified the one before says nothing of this one.
  // What that event takes away, the one right after it says.
  const bool says_out = event.kind == kMarkerOutEvent && event.text.empty();
  const bool was_taken_away = std::exchange(marker_goes_out_, says_out) && !newest_.file.empty();
  if (is_registration(event)) {
    last_file_ = event.text;
    if (!was_taken_away) newest_ = {event.text};
  }
  if (event.kind == kVerifiedEvent) newest_.was_verified = true;
  if (event.kind == kVerificationLostEvent) newest_.was_verified = false;
  if (event.kind == kVoidEvent) {
    newest_.is_void = true;
    newest_.was_verified = false;
  }
  drilled_by_.follow(event, newest_);
}

}  // namespace arthronaut::recording
