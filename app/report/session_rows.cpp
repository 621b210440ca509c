#include "app/report/session_rows.h"

#include <filesystem>

#include "navigation/sources/frame_source.h"

namespace arthronaut::report {

std::string neutral_source(const std::string& source) {
  if (sources::is_stream_address(source)) return source;  // its numbers are no extension
  const std::string extension = std::filesystem::path(source).extension().string();
  return extension.empty() ? source : "recording (" + extension.substr(1) + ")";
}

std::string kind_in_words(const recording::SessionHeader& header) {
  const auto kind = sources::source_kind_from_text(header.source_kind);
  if (!kind) return "not recorded";
  return *kind == sources::SourceKind::Live        ? "live: a camera, as it came"
         : *kind == sources::SourceKind::Recording ? "recording: a video that was made before"
                                                   : "simulation: nobody's knee";
}

std::string guided_bundles(const recording::RecordedSession& session) {
  std::string names, last;
  for (const recording::SessionEvent& event : session.events()) {
    if (event.kind != recording::kPlanEvent) continue;
    const auto plan = session.plan_of(event).plan;
    if (!plan || plan->bundle == norms::Bundle::Whole) continue;
    const std::string name = tunnels::name_of(plan->key());
    if (name != last) names += (names.empty() ? "" : ", ") + name;
    last = name;
  }
  return names;
}

std::vector<std::vector<std::string>> safety_rows(const recording::RecordedSession& session) {
  bool is_verified = false, was_verified = false, was_skipped = false, is_confirmed = false;
  std::string alarms, guide;
  for (const recording::SessionEvent& event : session.events()) {
    const bool is_another =
        event.kind == recording::kRegistrationEvent || event.kind == recording::kGivenRegistrationEvent;
    is_verified = event.kind == recording::kVerifiedEvent || (is_verified && !is_another);
    was_verified = was_verified || is_verified;
    was_skipped = was_skipped || event.kind == recording::kVerificationSkippedEvent;
    is_confirmed = is_confirmed || event.kind == recording::kTimeOutConfirmedEvent;
    if (event.kind == recording::kGuideCheckedEvent) guide = event.text;
    if (event.kind == recording::kAlarmEvent || event.kind == recording::kVoidEvent)
      alarms += (alarms.empty() ? "" : "; ") + (event.text.empty() ? "over" : event.text);
  }
  const std::string verified =
      is_verified    ? "verified by touches"
      : was_verified ? "verified by touches earlier; of the last registration nothing is recorded"
      : was_skipped  ? "SKIPPED"
                     : "not verified";
  const std::string& kind = session.header().source_kind;
  const bool is_live = kind == sources::to_text(sources::SourceKind::Live);
  return {{"Verification", verified + (was_skipped ? "; guidance began without it" : "")},
          {"Time-out", is_confirmed   ? "confirmed"
                       : is_live      ? "not confirmed in this session"
                       : kind.empty() ? "not recorded"
                                      : "not asked: no live source"},
          {"Check of a nominal guide", guide.empty() ? "none in this session" : guide},
          {"Alarms, void registrations", alarms.empty() ? "none" : alarms}};
}

}  // namespace arthronaut::report
