#include "navigation/sources/recording_time.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <ctime>

#include "navigation/sources/libav.h"

namespace arthronaut::sources {

namespace {

constexpr std::string_view kForm = "2026-01-31T12:00:00Z";

std::string said_by_container(const std::filesystem::path& file) {
  av_log_set_level(AV_LOG_QUIET);  // a file that is no container has a time, too
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, file.c_str(), nullptr, nullptr) < 0) return "";
  const LibavPtr<AVFormatContext> container(opened);
  const AVDictionaryEntry* const entry = av_dict_get(container->metadata, "creation_time", nullptr, 0);
  std::string text = entry != nullptr ? entry->value : "";
  // "2026-01-31T12:00:00.000000Z": in UTC, with fractions.
  if (text.size() < kForm.size() || text.back() != 'Z') return "";
  text = text.substr(0, kForm.size() - 1) + "Z";
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    const bool must_be_digit = kForm[i] >= '0' && kForm[i] <= '9';
    if (must_be_digit ? text[i] < '0' || text[i] > '9' : text[i] != kForm[i]) return "";
  }
  return text;
}

std::string said_by_file(const std::filesystem::path& file) {
  struct stat status {};
  std::tm utc{};
  if (::stat(file.c_str(), &status) != 0 || ::gmtime_r(&status.st_mtime, &utc) == nullptr) return "";
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

}  // namespace

std::optional<std::string> recorded_utc(const std::filesystem::path& file, const std::string& now_utc) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  std::optional<std::string> earliest;
  for (const std::string& time : {said_by_container(file), said_by_file(file)}) {
    // Of one form and one length, they are in the order of their letters.
    if (time.size() != kForm.size() || time < "2000" || time > now_utc) continue;
    if (!earliest || time < *earliest) earliest = time;
  }
  return earliest;
}

}  // namespace arthronaut::sources
