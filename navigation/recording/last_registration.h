// The registration that guided at the end of a session, or of several of one operation, as it was found, and
// whether it may be brought back.
#pragma once

#include <optional>
#include <string>

#include "navigation/operation/command.h"
#include "navigation/recording/session.h"
#include "navigation/registration/registration_file.h"

namespace arthronaut::recording {

// "it is not reliable; too few points; ..."
[[nodiscard]] std::string doubt_of(const registration::RegistrationSummary& unreliable);

class LastRegistration {
 public:
  // In order. Throws what reading a registration's file throws.
  void follow(const RecordedSession& session);
  [[nodiscard]] const std::optional<registration::RegistrationSummary>& registration() const { return good_; }
  [[nodiscard]] const registration::Provenance& of() const { return of_; }
  [[nodiscard]] bool was_verified() const { return was_verified_; }
  [[nodiscard]] const std::string& alarm() const { return alarm_; }
  // Why it may not: "it was in doubt at the end: ...", "nothing was registered"; empty: it may.
  [[nodiscard]] std::string refusal() const;

 private:
  void follow(const RecordedSession& session, const SessionEvent& event);
  void take(const registration::RegistrationRecord& record);
  void take(const operation::Command& command);
  void take(const registration::RegistrationSummary& registration, const registration::Provenance& of);

  std::optional<registration::RegistrationSummary> good_;
  registration::Provenance of_;
  std::string alarm_, doubt_;
  bool was_verified_ = false;
};

}  // namespace arthronaut::recording
