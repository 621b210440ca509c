#include "planning/cases/identity.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "planning/cases/private_json.h"
#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kIdentityFormat = "arthronaut.identity";
constexpr int kIdentityVersion = 1;

// "Muster^Anna^^Dr." as "Muster, Anna, Dr."; a second alphabet ("=") is left out.
std::string name_of(const std::string& dicom_name) {
  std::string words, part;
  for (const char c : dicom_name.substr(0, dicom_name.find('=')) + "^") {
    if (c != '^') {
      part += c;
      continue;
    }
    if (!part.empty()) words += (words.empty() ? "" : ", ") + part;
    part.clear();
  }
  return words;
}

}  // namespace

std::string date_in_words(const std::string& date) {
  const bool is_dicom =
      date.size() == 8 && std::all_of(date.begin(), date.end(), [](char c) { return c >= '0' && c <= '9'; });
  // "00010101" and the like is what a program leaves that took the patient's data out.
  constexpr std::string_view kEarliestYear = "1850";
  if (date.substr(0, kEarliestYear.size()) < kEarliestYear) return "";
  return is_dicom ? date.substr(0, 4) + "-" + date.substr(4, 2) + "-" + date.substr(6) : date;
}

std::string Identity::name_in_words() const { return name_of(patient_name); }

std::string Identity::birth_date_in_words() const { return date_in_words(birth_date); }

std::string Identity::in_words() const {
  std::string words;
  for (const std::string& part : {name_in_words(), patient_id, birth_date_in_words()}) {
    if (!part.empty()) words += (words.empty() ? "" : " · ") + part;
  }
  return words;
}

fs::path identity_file(const fs::path& case_folder) { return case_folder / "identity.json"; }

std::optional<Identity> load_identity(const fs::path& case_folder) {
  const fs::path file = identity_file(case_folder);
  if (!fs::exists(file)) return std::nullopt;
  const auto root = files::read_json(file, kIdentityFormat, kIdentityVersion);
  return Identity{root.text("patient_name"), root.text("patient_id"), root.text("birth_date")};
}

void save_identity(const fs::path& case_folder, const Identity& identity) {
  const fs::path file = identity_file(case_folder);
  if (identity.is_empty()) return files::remove_file(file);
  write_private_json(file, {{"format", kIdentityFormat},
                            {"version", kIdentityVersion},
                            {"patient_name", identity.patient_name},
                            {"patient_id", identity.patient_id},
                            {"birth_date", identity.birth_date}});
}

}  // namespace arthronaut::cases
