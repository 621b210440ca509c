#include "planning/cases/same_patient.h"

#include <cctype>

namespace arthronaut::cases {

namespace {

// What one scanner writes in capitals, or with blanks, another one does not.
std::string letters_of(std::string text) {
  std::erase_if(text, [](unsigned char c) { return c < 0x80 && std::isalnum(c) == 0; });
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool both_say(const std::string& a, const std::string& b) {
  return !letters_of(a).empty() && !letters_of(b).empty();
}

bool differ(const std::string& a, const std::string& b) {
  return both_say(a, b) && letters_of(a) != letters_of(b);
}

}  // namespace

bool is_another_patient(const Identity& a, const Identity& b) {
  if (differ(a.patient_id, b.patient_id) || differ(a.birth_date, b.birth_date)) return true;
  const bool is_known = both_say(a.patient_id, b.patient_id) && both_say(a.birth_date, b.birth_date);
  return !is_known && differ(a.name_in_words(), b.name_in_words());
}

}  // namespace arthronaut::cases
