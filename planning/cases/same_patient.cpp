#include "planning/cases/same_patient.h"

#include <cctype>

#include "planning/files/folded_text.h"

namespace arthronaut::cases {

namespace {

// What one scanner writes in capitals, with blanks, or an umlaut as two letters (MUELLER), another one does
// not.
std::string letters_of(const std::string& text) {
  std::string letters;
  for (const char c : files::folded(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) == 0) continue;
    const char before = letters.empty() ? '\0' : letters.back();
    if (c == 'e' && (before == 'a' || before == 'o' || before == 'u')) continue;
    letters += c;
  }
  return letters;
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

bool is_same_patient(const Identity& a, const Identity& b) {
  return both_say(a.patient_id, b.patient_id) && !is_another_patient(a, b);
}

}  // namespace arthronaut::cases
