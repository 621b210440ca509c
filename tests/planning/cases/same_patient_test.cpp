#include "planning/cases/same_patient.h"

#include <gtest/gtest.h>

namespace arthronaut::cases {

// Another number or date of birth is another patient, whatever the name; capitals, blanks, a date's way of
// writing and what is not said are not.
TEST(SamePatient, IsToldByWhatBothSay) {
  const Identity anna{"Muster^Anna", "4711", "19900131"};
  for (const Identity& same :
       {Identity{"MUSTER^ANNA", "4711 ", "1990-01-31"}, Identity{"Muster^Anna", "4711", ""},
        Identity{"", "4711", ""}, Identity{"Beispiel^Anna", "4711", "19900131"}, Identity{}}) {
    EXPECT_FALSE(is_another_patient(anna, same)) << same.in_words();
    EXPECT_FALSE(is_another_patient(same, anna)) << same.in_words();
  }
  for (const Identity& other :
       {Identity{"Muster^Anna", "4712", "19900131"}, Identity{"Muster^Anna", "4711", "19900130"},
        Identity{"Muster^Bert", "4711", ""}, Identity{"Muster^Bert", "", ""}}) {
    EXPECT_TRUE(is_another_patient(anna, other)) << other.in_words();
    EXPECT_TRUE(is_another_patient(other, anna)) << other.in_words();
  }
}

// Of the names, where no more is said by both: umlauts in capitals, without their dots, or as two letters.
TEST(SamePatient, NamesAreTheSameHoweverAScannerWritesThem) {
  const Identity joerg{"Müller^Jörg", "4711", ""};
  for (const char* name : {"MÜLLER^JÖRG", "MULLER^JORG", "Mueller^Joerg", "MUELLER JOERG"})
    EXPECT_FALSE(is_another_patient(joerg, Identity{name, "", "19500101"})) << name;
  for (const char* name : {"Miller^Jörg", "Müller^Jürg"})
    EXPECT_TRUE(is_another_patient(joerg, Identity{name, "", "19500101"})) << name;
}

// That somebody has no number, or another birthday, is no reason to take him for a patient of that number.
TEST(SamePatient, IsOnlyWhoseNumberBothSay) {
  const Identity anna{"Muster^Anna", "4711", "19900131"};
  EXPECT_TRUE(is_same_patient(anna, {"MUSTER^ANNA", "4711 ", ""}));
  EXPECT_FALSE(is_same_patient(anna, {"Muster^Anna", "", "19900131"}));
  EXPECT_FALSE(is_same_patient(anna, {"Muster^Anna", "4711", "19500101"}));
  EXPECT_FALSE(is_same_patient({}, {}));
}

}  // namespace arthronaut::cases
