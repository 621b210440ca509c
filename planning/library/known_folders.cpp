#include "planning/library/known_folders.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"

namespace arthronaut::library {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kFoldersFormat = "arthronaut.case_folders";
constexpr int kFoldersVersion = 1;

// A name may be any bytes, JSON is UTF-8: what is none is written as %XX, and so is the % itself.
bool is_plain(const std::string& name) {
  return name.find('%') == std::string::npos &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= 0x20 && c < 0x7F; });
}

std::string escaped(const std::string& name) {
  if (is_plain(name)) return name;
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F && byte != '%')
      text += c;
    else
      text += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return text;
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string unescaped(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code =
        text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    name += is_code ? static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
    if (is_code) i += 2;
  }
  return name;
}

}  // namespace

fs::path known_folders_file(const fs::path& data_folder) { return data_folder / "case_folders.json"; }

std::vector<fs::path> load_known_folders(const fs::path& data_folder) {
  std::vector<fs::path> folders;
  const fs::path file = known_folders_file(data_folder);
  if (!fs::exists(file)) return folders;
  for (const std::string& text : files::read_json(file, kFoldersFormat, kFoldersVersion).texts("folders"))
    folders.emplace_back(unescaped(text));
  return folders;
}

LibraryTurn::LibraryTurn(const fs::path& data_folder)
    : descriptor_(
          ::open((data_folder / "library.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR)) {
  if (descriptor_ >= 0) (void)::flock(descriptor_, LOCK_EX);
}

LibraryTurn::~LibraryTurn() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void change_known_folders(const fs::path& data_folder, std::span<const fs::path> added,
                          std::span<const fs::path> forgotten, const LibraryTurn& /*turn*/) {
  std::vector<fs::path> folders = load_known_folders(data_folder);
  const std::size_t before = folders.size();
  const std::set<fs::path> leaving(forgotten.begin(), forgotten.end());
  std::erase_if(folders, [&](const fs::path& folder) { return leaving.contains(folder); });
  bool is_changed = folders.size() != before;
  std::set<fs::path> there(folders.begin(), folders.end());
  for (const fs::path& folder : added) {
    if (!there.insert(folder).second) continue;
    folders.push_back(folder);
    is_changed = true;
  }
  if (!is_changed) return;
  auto names = nlohmann::ordered_json::array();
  for (const fs::path& folder : folders) names.push_back(escaped(folder.string()));
  files::create_private_folder(data_folder);
  files::write_json(
      known_folders_file(data_folder),
      {{"format", kFoldersFormat}, {"version", kFoldersVersion}, {"folders", std::move(names)}});
}

}  // namespace arthronaut::library
