#include "planning/dicom_out/lawful.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arthronaut::dicom_out {
namespace {

using images::DicomOrigin;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Beside images that keep every rule, to the last character that it allows.
Belonging lawful_belonging() {
  Belonging belonging;
  belonging.patient = {std::string(64, 'M') + "=" + std::string(64, 'N') + "=a^b^c^d^e", std::string(64, '7'),
                       "20240229"};
  belonging.study = {.study_uid = "1.2.0.3",
                     .study_id = "1234567890123456",
                     .accession_number = "1234567890123456",
                     .referring_physician = "Dr^House",
                     .study_date = "20260130",
                     .study_time = "0815",
                     .patient_sex = "O",
                     .patient_id_issuer = std::string(64, 'x'),
                     .series_uid = "1.2.0.4",
                     .frame_of_reference_uid = "1.2.0.5",
                     .sop_class_uid = "1.2.840.10008.5.1.4.1.1.2",
                     .sop_instance_uids = {"1.2.0.4.1"}};
  belonging.is_of_images = true;
  return belonging;
}

// What is written for it, which is told.
std::string written(std::string DicomOrigin::*text, const std::string& value) {
  Belonging belonging = lawful_belonging();
  belonging.study.*text = value;
  EXPECT_EQ(make_lawful(belonging).size(), 1U) << value;
  return belonging.study.*text;
}
std::string written(std::string cases::Identity::*text, const std::string& value) {
  Belonging belonging = lawful_belonging();
  belonging.patient.*text = value;
  EXPECT_EQ(make_lawful(belonging).size(), 1U) << value;
  return belonging.patient.*text;
}

TEST(Lawful, WhatKeepsTheRulesStaysAndIsNotTold) {
  Belonging belonging = lawful_belonging();
  EXPECT_THAT(make_lawful(belonging), IsEmpty());
  EXPECT_EQ(belonging.study, lawful_belonging().study);
  EXPECT_EQ(belonging.patient, lawful_belonging().patient);
  belonging.patient = {};
  belonging.study = {};
  belonging.study.study_uid = belonging.study.frame_of_reference_uid = "1.2";  // which are never empty
  EXPECT_THAT(make_lawful(belonging), IsEmpty());
}

// By characters, not by bytes.
TEST(Lawful, ShortTextsAreCutOrLeftOut) {
  EXPECT_EQ(written(&DicomOrigin::study_id, "12345678901234567"), "1234567890123456");
  EXPECT_EQ(written(&DicomOrigin::study_id, "123456789012345 7"), "123456789012345");
  EXPECT_EQ(written(&DicomOrigin::study_id, "12345678901234\u00E4\u00F67"), "12345678901234\u00E4\u00F6");
  EXPECT_EQ(written(&DicomOrigin::study_id, "a\\b\t"), "a b");
  EXPECT_EQ(written(&DicomOrigin::accession_number, "12345678901234567"), "");
  EXPECT_EQ(written(&DicomOrigin::accession_number, "12\\34"), "");
}

TEST(Lawful, NamesKeepWhatThereIsRoomFor) {
  EXPECT_EQ(written(&DicomOrigin::referring_physician, "a^b^c^d^e^f=g=h=i"), "a^b^c^d^e f=g=h");
  EXPECT_EQ(written(&cases::Identity::patient_name, std::string(70, 'M') + "^Anna=" + std::string(65, 'N')),
            std::string(64, 'M') + "=" + std::string(64, 'N'));
  EXPECT_EQ(written(&cases::Identity::patient_name, "Muster\\Anna"), "Muster Anna");
}

TEST(Lawful, DatesAndTimesAreOnesThatThereAre) {
  for (const auto& [came, expected] : {std::pair("2026.01.30", "20260130"),
                                       {"1990-01-31", "19900131"},
                                       {"20260230", ""},
                                       {"20230229", ""},
                                       {"in 1990", ""},
                                       {"2026013", ""}})
    EXPECT_EQ(written(&DicomOrigin::study_date, came), expected);
  EXPECT_EQ(written(&cases::Identity::birth_date, "1990-01-31"), "19900131");
  for (const auto& [came, expected] : {std::pair("08:15:00.25", "081500.25"),
                                       {"08:15", "0815"},
                                       {"081500.12345678", "081500.123456"},
                                       {"240000", ""},
                                       {"086000", ""},
                                       {"08150", ""},
                                       {"0815.5", "0815"},
                                       {"8:15", ""},
                                       {"noon", ""}})
    EXPECT_EQ(written(&DicomOrigin::study_time, came), expected);
}

TEST(Lawful, OfTheSexThereAreThreeWords) {
  EXPECT_EQ(written(&DicomOrigin::patient_sex, "f"), "F");
  EXPECT_EQ(written(&DicomOrigin::patient_sex, "m"), "M");
  EXPECT_EQ(written(&DicomOrigin::patient_sex, "female"), "");
}

TEST(Lawful, WhatIdentifiesStaysAndIsTold) {
  for (const char* uid : {"1.02.3", "1..2"})
    for (const auto text : {&DicomOrigin::study_uid, &DicomOrigin::frame_of_reference_uid,
                            &DicomOrigin::series_uid, &DicomOrigin::sop_class_uid})
      EXPECT_EQ(written(text, uid), uid);
  EXPECT_EQ(written(&cases::Identity::patient_id, std::string(65, '7')), std::string(65, '7'));
  EXPECT_EQ(written(&DicomOrigin::patient_id_issuer, "a\\b"), "a\\b");
}

// On a terminal, and in a log.
TEST(Lawful, Hazard19WhatIsToldNamesNobody) {
  Belonging belonging = lawful_belonging();
  belonging.patient = {"Muster\\Anna", std::string(70, '7'), "born 1990"};
  EXPECT_THAT(make_lawful(belonging),
              ElementsAre(StartsWith("PatientName is not as DICOM allows"),
                          "PatientBirthDate is not as DICOM allows it to be: left out.",
                          "PatientID is not as DICOM allows it to be, and stays as it came: the images are "
                          "filed by it."));
}

}  // namespace
}  // namespace arthronaut::dicom_out
