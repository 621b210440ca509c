#include "app/folders/typed_path.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <vector>

namespace arthronaut::folders {

namespace {

namespace fs = std::filesystem;

std::string without(std::string text, const std::string& around) {
  const auto first = text.find_first_not_of(around);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(around) - first + 1);
}

fs::path absolute_path(const std::string& text, const fs::path& from) {
  const char* const home = std::getenv("HOME");
  if ((text == "~" || text.starts_with("~/")) && home != nullptr)
    return fs::path(home) / (text.size() > 2 ? text.substr(2) : "");
  return from / text;  // an absolute one takes the place of `from`
}

// As other programs copy one: "/data/Knee%201.arthro".
std::string of_address(const std::string& address) {
  std::string path;
  for (std::size_t i = 0; i < address.size(); ++i) {
    unsigned value = 0;
    const char* const digits = address.data() + i + 1;
    const bool is_coded = address[i] == '%' && i + 2 < address.size() &&
                          std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    path += is_coded ? static_cast<char>(value) : address[i];
    if (is_coded) i += 2;
  }
  return path;
}

}  // namespace

TypedPath typed_path(const std::string& text, const fs::path& from) {
  std::string meant = without(text, " \t\r\n\"'");
  constexpr std::string_view kScheme = "file://";
  if (meant.starts_with(kScheme)) meant = of_address(meant.substr(kScheme.size()));
  if (meant.empty()) return {from, "Type a folder or a file"};
  TypedPath typed{absolute_path(meant, from).lexically_normal(), ""};
  std::error_code error;
  const bool is_there = fs::exists(typed.path, error);
  if (error)
    typed.problem = typed.path.string() + ": " + error.message();
  else if (!is_there) {
    // The part that is there says where to look on.
    fs::path there = typed.path.parent_path();
    while (there.has_relative_path() && !fs::exists(there, error)) there = there.parent_path();
    typed.problem = "There is no " + typed.path.string() + ". As far as " + there.string() + " it is there";
  } else if (::access(typed.path.c_str(), R_OK) != 0) {
    typed.problem = typed.path.string() + " may not be read by you";
  }
  return typed;
}

std::string completed_path(const std::string& text, const fs::path& from) {
  const auto slash = text.rfind('/');
  const std::string begun = slash == std::string::npos ? "" : text.substr(0, slash + 1),
                    last = text.substr(begun.size());
  if (begun.empty() && last.starts_with("~")) return last == "~" ? "~/" : text;
  std::optional<std::string> common;
  std::size_t count = 0;
  bool is_folder = false;
  std::error_code error;
  for (fs::directory_iterator entry(absolute_path(begun, from), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(last) || (name.starts_with(".") && !last.starts_with("."))) continue;
    std::error_code unknown;
    is_folder = entry->is_directory(unknown);
    ++count;
    if (!common) {
      common = name;
      continue;
    }
    auto alike = static_cast<std::size_t>(std::ranges::mismatch(*common, name).in1 - common->begin());
    // No half of a letter that takes several bytes.
    while (alike > 0 && alike < name.size() && (static_cast<unsigned char>(name[alike]) & 0xC0U) == 0x80U)
      --alike;
    common->resize(alike);
  }
  if (!common || common->size() < last.size()) return text;
  return begun + *common + (count == 1 && is_folder ? "/" : "");
}

}  // namespace arthronaut::folders
