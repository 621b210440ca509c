// Whose the exported objects are, beside which study they lie, and what tells them apart.
#include <gmock/gmock.h>

#include <set>

#include "tests/planning/dicom_out/exported_case.h"

namespace arthronaut::dicom_out {
namespace {

namespace fs = std::filesystem;
using bones::BoneKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// What all of them say: patient, study, series and equipment, letter by letter as the images have it.
TEST_F(DicomExport, LiesBesideTheStudyOfTheImages) {
  be_of_images();
  write();
  Dicom slice(folder_ / "ct/slice1000.dcm");
  for (const std::string& name : all_names()) {
    Dicom object = read(name);
    for (const DcmTagKey& key : {DCM_PatientName, DCM_PatientID, DCM_IssuerOfPatientID, DCM_PatientBirthDate,
                                 DCM_PatientSex, DCM_StudyInstanceUID, DCM_StudyID, DCM_StudyDate,
                                 DCM_StudyTime, DCM_AccessionNumber, DCM_ReferringPhysicianName}) {
      EXPECT_EQ(object[key], slice[key]) << name;
      EXPECT_FALSE(object[key].empty());
    }
    EXPECT_NE(object[DCM_SeriesInstanceUID], slice[DCM_SeriesInstanceUID]);
    EXPECT_EQ(object[DCM_Manufacturer], "Arthronaut");
    EXPECT_EQ(object[DCM_SpecificCharacterSet], "ISO_IR 192");
    EXPECT_EQ(object[DCM_ContentDate], "20260201");
    EXPECT_EQ(object[DCM_ContentTime], "070809");
    EXPECT_EQ(object[DCM_PatientIdentityRemoved], "(absent)");
    EXPECT_EQ(object[DCM_TimezoneOffsetFromUTC], "(absent)");  // of the study's times nobody knows it
    EXPECT_EQ(object.format.getDataset()->getOriginalXfer(), EXS_LittleEndianExplicit);
    EXPECT_EQ(text(*object.format.getMetaInfo(), DCM_MediaStorageSOPInstanceUID), object[DCM_SOPInstanceUID]);
  }
  for (const char* name : {"femur.dcm", "tibia.dcm", "femur_drilled.dcm", "tibia_drilled.dcm"}) {
    Dicom model = read(name);
    EXPECT_EQ(model[DCM_FrameOfReferenceUID], slice[DCM_FrameOfReferenceUID]);
    EXPECT_EQ(model[DCM_SeriesInstanceUID], read("femur.dcm")[DCM_SeriesInstanceUID]);
    // All 44 images, and the series that they are of.
    EXPECT_EQ(model.in(DCM_ReferencedSeriesSequence, 0, DCM_SeriesInstanceUID), slice[DCM_SeriesInstanceUID]);
    EXPECT_EQ(model.in(DCM_SourceInstanceSequence, 0, DCM_ReferencedSOPClassUID), UID_CTImageStorage);
    EXPECT_THAT(model.in(DCM_SourceInstanceSequence, 43, DCM_ReferencedSOPInstanceUID),
                HasSubstr("1.2.826.0.1.3680043.8.498.2."));
    EXPECT_EQ(model.in(DCM_SourceInstanceSequence, 44, DCM_ReferencedSOPInstanceUID), "(no item)");
  }
}

// What says no offset from UTC is by the clock on the wall: beside images this machine's, else it is said.
TEST_F(DicomExport, TimesBesideImagesAreThoseOfTheWorkstation) {
  const char* const zone = std::getenv("TZ");
  const std::string before = zone != nullptr ? zone : "";
  const auto set_zone = [](const char* name) {
    if (name != nullptr)
      ::setenv("TZ", name, 1);
    else
      ::unsetenv("TZ");
    ::tzset();
  };
  set_zone("America/New_York");
  contents_.moment_utc = "2026-02-01T03:08:09Z";
  write();
  for (const std::string& name : all_names()) {
    Dicom object = read(name);
    EXPECT_EQ(object[DCM_ContentDate] + object[DCM_ContentTime], "20260201030809") << name;
    EXPECT_EQ(object[DCM_TimezoneOffsetFromUTC], "+0000") << name;
  }
  fs::remove_all(folder_ / "out");
  be_of_images();
  write();
  for (const std::string& name : all_names()) {
    Dicom object = read(name);
    EXPECT_EQ(object[DCM_ContentDate] + object[DCM_ContentTime], "20260131220809") << name;
    EXPECT_EQ(object[DCM_TimezoneOffsetFromUTC], "(absent)") << name;
  }
  set_zone(zone != nullptr ? before.c_str() : nullptr);
}

// Without images there is a study of the case's own, and nobody is made up.
TEST_F(DicomExport, ACaseOfNoStudyGetsOneOfItsOwn) {
  const ExportSummary summary = write();
  EXPECT_THAT(summary.notes, testing::Contains(HasSubstr("a new one was made")));
  const std::string study = read("femur.dcm")[DCM_StudyInstanceUID];
  EXPECT_THAT(study, HasSubstr("2.25."));
  for (const std::string& name : all_names()) {
    Dicom object = read(name);
    EXPECT_EQ(object[DCM_StudyInstanceUID], study);
    EXPECT_EQ(object[DCM_StudyDate], "20260131");
    EXPECT_EQ(object[DCM_StudyTime], "123456");
    for (const DcmTagKey& key : {DCM_PatientName, DCM_PatientID, DCM_PatientBirthDate, DCM_PatientSex,
                                 DCM_StudyID, DCM_AccessionNumber, DCM_ReferringPhysicianName})
      EXPECT_EQ(object[key], "") << name;
  }
  EXPECT_EQ(read("femur.dcm")[DCM_FrameOfReferenceUID], read("tibia.dcm")[DCM_FrameOfReferenceUID]);
  // Another plan of the same knee comes into the same study, as other objects.
  contents_.knee.plan.tunnels.at(BoneKind::Femur).diameter_mm += 1;
  write("later");
  Dicom later(folder_ / "later/femur_drilled.dcm");
  EXPECT_EQ(later[DCM_StudyInstanceUID], study);
  EXPECT_NE(later[DCM_SOPInstanceUID], read("femur_drilled.dcm")[DCM_SOPInstanceUID]);
  EXPECT_NE(later[DCM_SeriesInstanceUID], read("femur_drilled.dcm")[DCM_SeriesInstanceUID]);
}

// Nobody says that a mesh lies where the images do.
TEST_F(DicomExport, AMeshBesideImagesHasAFrameOfItsOwn) {
  be_of_images();
  contents_.studies.erase(BoneKind::Tibia);
  write();
  Dicom femur = read("femur.dcm"), tibia = read("tibia.dcm");
  EXPECT_EQ(tibia[DCM_StudyInstanceUID], femur[DCM_StudyInstanceUID]);
  EXPECT_NE(tibia[DCM_FrameOfReferenceUID], femur[DCM_FrameOfReferenceUID]);
  EXPECT_NE(tibia[DCM_SeriesInstanceUID], femur[DCM_SeriesInstanceUID]);
  EXPECT_EQ(tibia[DCM_SourceInstanceSequence], "(absent)");
}

// Under which the images are filed: a part of it would be another patient's, or nobody's.
TEST_F(DicomExport, Hazard20WhatIdentifiesIsWrittenAsItCame) {
  be_of_images();
  const std::string number(65, '7'), issuer(65, 'x');
  contents_.identity->patient_id = number;
  for (auto& [kind, study] : contents_.studies) {
    study.study_uid = "1.02.3";
    study.patient_id_issuer = issuer;
    study.accession_number = "12345678901234567";
  }
  const auto notes = write().notes;
  for (const char* name : {"PatientID", "IssuerOfPatientID", "StudyInstanceUID"})
    EXPECT_THAT(notes, testing::Contains(testing::StartsWith(std::string(name) + " is not as DICOM allows")));
  for (const std::string& name : all_names()) {
    Dicom object = read(name);
    EXPECT_EQ(object[DCM_PatientID], number);
    EXPECT_EQ(object[DCM_IssuerOfPatientID], issuer);
    EXPECT_EQ(object[DCM_StudyInstanceUID], "1.02.3");
    EXPECT_EQ(object[DCM_AccessionNumber], "");
  }
}

TEST_F(DicomExport, TheSameCaseGivesTheSameBytes) {
  be_of_images();
  write("a");
  write("b");
  EXPECT_EQ(contents_of(folder_ / "a"), contents_of(folder_ / "b"));
}

TEST_F(DicomExport, InstancesAreToldApart) {
  write();
  std::set<std::string> instances;
  for (const std::string& name : all_names()) instances.insert(read(name)[DCM_SOPInstanceUID]);
  EXPECT_EQ(instances.size(), 7U);
}

// Byte by byte: neither the patient nor anything that leads back to the study.
TEST_F(DicomExport, Hazard19DeidentifiedHoldsNoIdentity) {
  be_of_images();
  const images::DicomOrigin& origin = contents_.studies.at(BoneKind::Femur);
  contents_.is_deidentified = true;
  const ExportSummary summary = write();
  EXPECT_THAT(summary.notes, testing::Contains(HasSubstr("Pictures are left out")));
  const auto written = contents_of(folder_ / "out");
  EXPECT_EQ(written.size(), 6U);
  for (const auto& [name, bytes] : written) {
    for (const std::string& word :
         {std::string("Muster"), std::string("4711"), std::string("19900131"), std::string("20260131"),
          std::string("20260201"), std::string("Clinic"), origin.study_uid, origin.study_id,
          origin.accession_number, origin.referring_physician, origin.study_date, origin.series_uid,
          origin.frame_of_reference_uid})
      EXPECT_EQ(bytes.find(word), std::string::npos) << name << ": " << word;
    Dicom object = read(name);
    EXPECT_EQ(object[DCM_PatientIdentityRemoved], "YES");
    EXPECT_FALSE(object[DCM_DeidentificationMethod].empty());
    EXPECT_EQ(object[DCM_PatientName], "Anonymous^");
  }
  EXPECT_EQ(read("femur.dcm")[DCM_FrameOfReferenceUID], read("tibia.dcm")[DCM_FrameOfReferenceUID]);
  EXPECT_EQ(read("report.dcm")[DCM_BurnedInAnnotation], "NO");
}

}  // namespace
}  // namespace arthronaut::dicom_out
