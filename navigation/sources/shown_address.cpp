#include <algorithm>

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

namespace {

constexpr std::string_view kEndsOfAddress = " \t\"'";

// Who logs in stands before the "@" of the host. A password may have a "/" in it, and "tower:554/a@b" be one
// of "554/a": where a colon leaves that open nothing before the last "@" is shown.
void leave_login_out(std::string& text, std::size_t host) {
  const std::size_t end = std::min(text.find_first_of(kEndsOfAddress, host), text.size());
  const std::size_t path = std::min(text.find_first_of("/?", host), end);
  const std::string_view authority = std::string_view(text).substr(host, path - host);
  const bool is_login = authority.find('@') != std::string_view::npos;
  const bool may_be_login = authority.find(':') != std::string_view::npos;
  const std::size_t at = text.rfind('@', (is_login || !may_be_login ? path : end) - 1);
  // In "udp://@:5000" nobody is before it: there it stands for every interface.
  if (at != std::string::npos && at > host && at < end) text.erase(host, at + 1 - host);
}

// "user-pw=secret", "...&password=secret".
void hide_values(std::string& text, std::string_view key) {
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at)) {
    at += key.size();
    const std::size_t end = std::min(text.find_first_of("& \t\"'!", at), text.size());
    text.replace(at, end - at, "***");
  }
}

}  // namespace

std::string shown_address(const std::string& address) {
  std::string shown = address;
  for (std::size_t at = shown.find("://"); at != std::string::npos; at = shown.find("://", at + 3))
    if (at + 3 < shown.size()) leave_login_out(shown, at + 3);
  for (const std::string_view key : {"user-pw=", "proxy-pw=", "password=", "passwd=", "pwd=", "passphrase="})
    hide_values(shown, key);
  return shown;
}

}  // namespace arthronaut::sources
