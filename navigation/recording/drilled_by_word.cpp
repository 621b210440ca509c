#include "navigation/recording/drilled_by_word.h"

#include "navigation/operation/achieved_tunnel.h"

namespace arthronaut::recording {

bool tells_of_drilling(const SessionEvent& event) {
  return event.kind == kDrilledByWordEvent || event.kind == kDrilledEvent ||
         event.kind == kSaidTooEarlyEvent || event.kind == kDrilledTakenBackEvent;
}

std::string name_of_tunnel_in(const std::string& achieved_file, bones::BoneKind bone) {
  for (const auto bundle :
       {norms::Bundle::Whole, norms::Bundle::Anteromedial, norms::Bundle::Posterolateral}) {
    const tunnels::TunnelKey key(bone, bundle);
    if (operation::achieved_file_name(key) == achieved_file) return tunnels::name_of(key);
  }
  return "";
}

std::vector<DrilledByWord> drilled_by_word(const std::vector<SessionEvent>& events, bones::BoneKind bone) {
  constexpr std::string_view kWhy = ": ";
  std::vector<DrilledByWord> said;
  for (const SessionEvent& event : events) {
    const auto forget = [&](const std::string& tunnel) {
      std::erase_if(said, [&](const DrilledByWord& one) { return one.tunnel == tunnel; });
    };
    if (event.kind == kDrilledByWordEvent) {
      const std::size_t at = event.text.find(kWhy);
      const std::string tunnel = event.text.substr(0, at);
      forget(tunnel);
      said.push_back(
          {tunnel, at == std::string::npos ? "" : event.text.substr(at + kWhy.size()), event.timestamp_ns});
    }
    if (event.kind == kDrilledEvent) forget(name_of_tunnel_in(event.text, bone));
    if (event.kind == kSaidTooEarlyEvent) forget(event.text);
    // In older records: the word that was said last.
    if (event.kind == kDrilledTakenBackEvent && event.text.empty() && !said.empty()) said.pop_back();
  }
  return said;
}

std::vector<std::string> said_too_early(const std::vector<SessionEvent>& events) {
  std::vector<std::string> tunnels;
  for (const SessionEvent& event : events)
    if (event.kind == kSaidTooEarlyEvent) tunnels.push_back(event.text);
  return tunnels;
}

}  // namespace arthronaut::recording
