// Whose knee a case is, kept apart from everything else: identity.json, which no export takes along unless it
// is asked to; what is written as DICOM for the hospital (dicom_out) is.
//
// A case that was imported without patient data (a mesh, a phantom) has none.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace arthronaut::cases {

// As the source of the import gives it; each may be empty.
struct Identity {
  std::string patient_name;  // for people to read; DICOM's "Muster^Anna" is kept as it came
  std::string patient_id;
  std::string birth_date;  // "19900131" or "1990-01-31", as it came

  [[nodiscard]] bool is_empty() const {
    return patient_name.empty() && patient_id.empty() && birth_date.empty();
  }
  [[nodiscard]] std::string name_in_words() const;        // "Muster, Anna"
  [[nodiscard]] std::string birth_date_in_words() const;  // "1990-01-31"; empty before 1850
  // "Muster, Anna · 4711 · 1990-01-31": what a title or a report shows.
  [[nodiscard]] std::string in_words() const;
  // This, and what it does not say as the other says it.
  [[nodiscard]] Identity filled_from(const Identity& other) const {
    const auto either = [](const std::string& mine, const std::string& theirs) {
      return mine.empty() ? theirs : mine;
    };
    return {either(patient_name, other.patient_name), either(patient_id, other.patient_id),
            either(birth_date, other.birth_date)};
  }
  bool operator==(const Identity&) const = default;
};

// DICOM's "20260131" as "2026-01-31"; anything else as it is.
[[nodiscard]] std::string date_in_words(const std::string& date);

[[nodiscard]] std::filesystem::path identity_file(const std::filesystem::path& case_folder);

// Nothing when the case has no identity.json. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] std::optional<Identity> load_identity(const std::filesystem::path& case_folder);

// Atomic; the file is 0600 whatever the folder is. An empty identity removes the file. Throws IoError; what
// was there is then as before.
void save_identity(const std::filesystem::path& case_folder, const Identity& identity);

}  // namespace arthronaut::cases
