#include "planning/dicom_out/lawful.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <functional>

namespace arthronaut::dicom_out {

namespace {

constexpr std::size_t kShort = 16, kLong = 64;  // characters of SH; of LO and of an alphabet's PN

bool is_later_byte(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

// The backslash parts values, of which there is one here; a control character is of no text.
std::string as_one_value(std::string text) {
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; });
  std::ranges::replace(text, '\\', ' ');
  return trimmed(text);
}

std::string cut(const std::string& utf8, std::size_t most) {
  std::size_t end = 0;
  for (std::size_t count = 0; end < utf8.size(); ++end)
    if (!is_later_byte(utf8[end]) && ++count > most) break;
  return trimmed(utf8.substr(0, end));
}

std::string short_text(const std::string& text) { return cut(as_one_value(text), kShort); }

std::string whole_short_text(const std::string& text) { return short_text(text) == text ? text : ""; }

std::vector<std::string> parts_of(const std::string& text, char parted_by) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == parted_by)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// "Muster^Anna=...": what a sixth part would be goes on in the fifth.
std::string person_name(const std::string& text) {
  constexpr std::size_t kAlphabets = 3, kParts = 5;
  std::vector<std::string> alphabets = parts_of(as_one_value(text), '=');
  if (alphabets.size() > kAlphabets) alphabets.resize(kAlphabets);
  std::string name;
  for (std::size_t i = 0; i < alphabets.size(); ++i) {
    const std::vector<std::string> parts = parts_of(alphabets[i], '^');
    std::string joined;
    for (std::size_t p = 0; p < parts.size(); ++p)
      joined += (p == 0 ? "" : p < kParts ? "^" : " ") + parts[p];
    name += (i == 0 ? "" : "=") + cut(joined, kLong);
  }
  return name;
}

bool are_digits(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

int number_at(const std::string& digits, std::size_t at, std::size_t count) {
  int number = 0;
  std::from_chars(digits.data() + at, digits.data() + at + count, number);
  return number;
}

std::string date(std::string text) {
  if (text.size() == 10 && text[4] == text[7] && (text[4] == '-' || text[4] == '.'))
    text = text.substr(0, 4) + text.substr(5, 2) + text.substr(8);
  if (text.size() != 8 || !are_digits(text)) return "";
  const std::chrono::year_month_day day(std::chrono::year(number_at(text, 0, 4)),
                                        std::chrono::month(static_cast<unsigned>(number_at(text, 4, 2))),
                                        std::chrono::day(static_cast<unsigned>(number_at(text, 6, 2))));
  return day.ok() ? text : "";
}

// Hours, and what is known below them: "08", "0815", "081500.25", each once with colons.
std::string time_of_day(std::string text) {
  for (const std::size_t colon : {std::size_t{5}, std::size_t{2}})
    if (text.size() > colon && text[colon] == ':') text.erase(colon, 1);
  const std::size_t point = text.find('.');
  const std::string whole = text.substr(0, point);
  if (whole.size() > 6 || whole.size() % 2 != 0 || !are_digits(whole)) return "";
  constexpr int kMost[] = {23, 59, 60};  // a second may be a leap second
  for (std::size_t at = 0; at < whole.size(); at += 2)
    if (number_at(whole, at, 2) > kMost[at / 2]) return "";
  if (point == std::string::npos) return whole;
  const std::string fraction = text.substr(point + 1, 6);
  return whole.size() == 6 && are_digits(fraction) ? whole + "." + fraction : whole;
}

std::string sex(const std::string& text) {
  if (text == "F" || text == "f") return "F";
  if (text == "M" || text == "m") return "M";
  return text == "O" || text == "o" ? "O" : "";
}

// No component begins with a zero that is not all of it, and none is empty.
bool is_lawful_uid(const std::string& uid) {
  return std::ranges::all_of(parts_of(uid, '.'), [](const std::string& component) {
    return are_digits(component) && (component.size() == 1 || component.front() != '0');
  });
}

}  // namespace

std::vector<std::string> make_lawful(Belonging& belonging) {
  std::vector<std::string> notes;
  const auto make = [&](const char* name, std::string& value,
                        const std::function<std::string(const std::string&)>& rule) {
    const std::string lawful = rule(value);
    if (lawful == value) return;
    notes.push_back(
        std::string(name) + " is not as DICOM allows it to be: " +
        (lawful.empty() ? "left out." : "written as far as it may be, or in the form that it has to have."));
    value = lawful;
  };
  images::DicomOrigin& study = belonging.study;
  make("PatientName", belonging.patient.patient_name, person_name);
  make("PatientBirthDate", belonging.patient.birth_date, date);
  make("PatientSex", study.patient_sex, sex);
  make("StudyDate", study.study_date, date);
  make("StudyTime", study.study_time, time_of_day);
  make("StudyID", study.study_id, short_text);
  make("AccessionNumber", study.accession_number, whole_short_text);
  make("ReferringPhysicianName", study.referring_physician, person_name);
  const auto keep = [&](const char* name, bool is_lawful) {
    if (!is_lawful)
      notes.push_back(std::string(name) +
                      " is not as DICOM allows it to be, and stays as it came: the images are filed by it.");
  };
  const auto is_long_text = [](const std::string& text) { return cut(as_one_value(text), kLong) == text; };
  keep("PatientID", is_long_text(belonging.patient.patient_id));
  keep("IssuerOfPatientID", is_long_text(study.patient_id_issuer));
  keep("StudyInstanceUID", is_lawful_uid(study.study_uid));
  keep("FrameOfReferenceUID", is_lawful_uid(study.frame_of_reference_uid));
  const bool is_of_an_image = !study.series_uid.empty() && !study.sop_instance_uids.empty();
  keep("A UID of the images",
       !is_of_an_image || (is_lawful_uid(study.series_uid) && is_lawful_uid(study.sop_class_uid) &&
                           std::ranges::all_of(study.sop_instance_uids, is_lawful_uid)));
  return notes;
}

}  // namespace arthronaut::dicom_out
