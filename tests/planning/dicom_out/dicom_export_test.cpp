#include "planning/dicom_out/dicom_export.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/plan_file.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "planning/phantom/phantom_case.h"
#include "planning/plan_export/drilled_bone.h"
#include "tests/message_of.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/temporary_folder.h"

namespace arthronaut::dicom_out {
namespace {

namespace fs = std::filesystem;
using bones::BoneKind;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  return item.findAndGetOFStringArray(key, value).good() ? std::string(value.c_str()) : "(absent)";
}

struct Dicom {
  explicit Dicom(const fs::path& file) {
    if (format.loadFile(file.c_str()).bad()) throw std::runtime_error("cannot be loaded: " + file.string());
  }
  [[nodiscard]] std::string operator[](const DcmTagKey& key) { return text(*format.getDataset(), key); }
  [[nodiscard]] std::string in(const DcmTagKey& sequence, long number, const DcmTagKey& key) {
    DcmItem* item = nullptr;
    return format.getDataset()->findAndGetSequenceItem(sequence, item, number).good() ? text(*item, key)
                                                                                      : "(no item)";
  }
  [[nodiscard]] std::string document() {
    const Uint8* bytes = nullptr;
    Uint32 length = 0;
    if (format.getDataset()->findAndGetUint8Array(DCM_EncapsulatedDocument, bytes).bad()) return "(absent)";
    (void)format.getDataset()->findAndGetUint32(DCM_EncapsulatedDocumentLength, length);
    return {reinterpret_cast<const char*>(bytes), length};
  }

  DcmFileFormat format;
};

std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder))
    contents[entry.path().filename().string()] = files::read_text(entry.path());
  return contents;
}

class DicomExport : public testing::Test {
 protected:
  DicomExport() {
    contents_.knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4.0}), "Phantom");
    contents_.knee.created_utc = "2026-01-31T12:34:56Z";
    contents_.moment_utc = "2026-02-01T07:08:09Z";
    contents_.report_pdf = "%PDF-1.4 odd";
    contents_.report_pdf += '\n';  // an odd length, which DICOM fills up
    contents_.pictures = {
        {"Picture 1", 3, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18}}};
  }
  // As import leaves it after a series that says all there is to be said.
  void be_of_images() {
    test::write_dicom_series(folder_ / "ct", test::ellipsoid_ct());
    images::VolumeFileOptions options;
    images::DicomOrigin origin;
    options.on_origin = [&](const images::DicomOrigin& found) { origin = found; };
    const images::Volume volume = images::read_volume(folder_ / "ct", options);
    contents_.identity = {volume.patient.name, volume.patient.id, volume.patient.birth_date};
    contents_.studies = {{BoneKind::Femur, origin}, {BoneKind::Tibia, origin}};
  }
  ExportSummary write(const std::string& name = "out") { return export_dicom(contents_, folder_ / name); }
  [[nodiscard]] Dicom read(const std::string& name) const { return Dicom(folder_ / ("out/" + name)); }
  [[nodiscard]] static std::vector<std::string> all_names() {
    return {"femur.dcm", "tibia.dcm",  "femur_drilled.dcm", "tibia_drilled.dcm",
            "plan.dcm",  "report.dcm", "image_001.dcm"};
  }

  ExportContents contents_;
  const test::TemporaryFolder folder_;
};

TEST_F(DicomExport, WritesEveryObjectAndNothingElse) {
  const ExportSummary summary = write();
  std::vector<std::string> names;
  for (const fs::path& file : summary.files) names.push_back(file.filename().string());
  EXPECT_EQ(names, all_names());
  EXPECT_THAT(summary.doubts, IsEmpty());
  EXPECT_EQ(contents_of(folder_ / "out").size(), 7U);
  EXPECT_THAT(folder_.names(), ElementsAre("out"));
  EXPECT_EQ(fs::status(folder_ / "out").permissions() & fs::perms::mask, fs::perms{0700});
  EXPECT_EQ(fs::status(folder_ / "out/femur.dcm").permissions() & fs::perms::mask, fs::perms{0600});
}

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

TEST_F(DicomExport, ModelsAreTheBonesInMillimetres) {
  write();
  for (const bool is_drilled : {false, true}) {
    for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
      const std::string name(bones::to_text(kind));
      Dicom model = read(name + (is_drilled ? "_drilled.dcm" : ".dcm"));
      EXPECT_EQ(model[DCM_SOPClassUID], UID_EncapsulatedSTLStorage);
      EXPECT_EQ(model[DCM_Modality], "M3D");
      EXPECT_EQ(model[DCM_MIMETypeOfEncapsulatedDocument], "model/stl");
      EXPECT_EQ(model.in(DCM_MeasurementUnitsCodeSequence, 0, DCM_CodeValue), "mm");
      EXPECT_EQ(model.in(DCM_MeasurementUnitsCodeSequence, 0, DCM_CodingSchemeDesignator), "UCUM");
      EXPECT_EQ(model[DCM_ModelModification], is_drilled ? "YES" : "NO");
      EXPECT_EQ(model[DCM_ModelMirroring], "NO");
      EXPECT_EQ(model[DCM_BurnedInAnnotation], "NO");
      EXPECT_EQ(model[DCM_ImageLaterality], "R");
      for (const DcmTagKey& key : {DCM_ManufacturerModelName, DCM_DeviceSerialNumber, DCM_SoftwareVersions,
                                   DCM_InstanceNumber, DCM_DocumentTitle})
        EXPECT_FALSE(model[key].empty());
      // A reader of STL finds the triangles where they were, to a float's precision (less than 1e-5 mm here).
      files::write_atomically(folder_ / "model.stl", model.document());
      const geometry::TriangleMesh found = bones::read_mesh(folder_ / "model.stl");
      const cases::Case& knee = contents_.knee;
      const geometry::TriangleMesh expected =
          is_drilled ? plan_export::drill(knee.bones.at(kind).mesh, knee.plan.tunnels.at(kind)).mesh
                     : knee.bones.at(kind).mesh;
      ASSERT_EQ(found.triangles.size(), expected.triangles.size());
      double worst_mm = 0;
      for (std::size_t t = 0; t < expected.triangles.size(); ++t) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const auto a = static_cast<std::size_t>(found.triangles[t][corner]);
          const auto b = static_cast<std::size_t>(expected.triangles[t][corner]);
          worst_mm = std::max(worst_mm, (found.vertices_mm[a] - expected.vertices_mm[b]).norm());
        }
      }
      EXPECT_LT(worst_mm, 1e-5);
    }
  }
}

// Entry, exit and axis of both tunnels, to the 0.0001 mm that a decimal string holds.
TEST_F(DicomExport, ThePlanIsThereAsFiducials) {
  be_of_images();
  contents_.studies.at(BoneKind::Tibia).frame_of_reference_uid = "1.2.3";
  write();
  Dicom plan = read("plan.dcm");
  EXPECT_EQ(plan[DCM_SOPClassUID], UID_SpatialFiducialsStorage);
  EXPECT_EQ(plan[DCM_Modality], "FID");
  EXPECT_EQ(plan[DCM_ContentLabel], "TUNNEL_PLAN");
  // By which report, session and tables name it; a long string has room for 64 characters.
  const std::string hash = cases::short_plan_hash(cases::with_named_meshes(contents_.knee));
  EXPECT_THAT(plan[DCM_ContentDescription], HasSubstr("plan " + hash));
  EXPECT_LE(plan[DCM_ContentDescription].size(), 64U);
  EXPECT_THAT(read("femur_drilled.dcm")[DCM_DocumentTitle], HasSubstr("plan " + hash));
  EXPECT_EQ(plan[DCM_Laterality], "R");
  for (const auto& [key, tunnel] : contents_.knee.plan.tunnels) {
    const BoneKind kind = key.bone;
    DcmItem* set = nullptr;
    const long number = kind == BoneKind::Femur ? 0 : 1;
    ASSERT_TRUE(
        plan.format.getDataset()->findAndGetSequenceItem(DCM_FiducialSetSequence, set, number).good());
    EXPECT_EQ(text(*set, DCM_FrameOfReferenceUID), contents_.studies.at(kind).frame_of_reference_uid);
    DcmItem *entry = nullptr, *exit = nullptr, *axis = nullptr;
    ASSERT_TRUE(set->findAndGetSequenceItem(DCM_FiducialSequence, entry, 0).good());
    ASSERT_TRUE(set->findAndGetSequenceItem(DCM_FiducialSequence, exit, 1).good());
    ASSERT_TRUE(set->findAndGetSequenceItem(DCM_FiducialSequence, axis, 2).good());
    EXPECT_EQ(text(*entry, DCM_FiducialIdentifier), kind == BoneKind::Femur ? "FEMUR_ENTRY" : "TIBIA_ENTRY");
    EXPECT_EQ(text(*entry, DCM_ShapeType), "POINT");
    EXPECT_EQ(text(*axis, DCM_ShapeType), "LINE");
    EXPECT_EQ(text(*axis, DCM_ContourData),
              text(*entry, DCM_ContourData) + "\\" + text(*exit, DCM_ContourData));
    Eigen::Vector3d point;
    for (unsigned long i = 0; i < 3; ++i)
      EXPECT_TRUE(entry->findAndGetFloat64(DCM_ContourData, point[static_cast<int>(i)], i).good());
    EXPECT_LT((point - tunnel.entry_mm).norm(), 1e-4);
    for (unsigned long i = 0; i < 3; ++i)
      EXPECT_TRUE(exit->findAndGetFloat64(DCM_ContourData, point[static_cast<int>(i)], i).good());
    EXPECT_LT((point - tunnel.entry_mm).normalized().cross(tunnel.direction.normalized()).norm(), 1e-4);
  }
}

// Two tunnels of a bone have fiducials with names of their own, and both are drilled out of the bone.
TEST_F(DicomExport, TwoBundlesAreNamedAndDrilled) {
  be_of_images();
  cases::Plan& plan = contents_.knee.plan;
  tunnels::Tunnel tunnel = plan.tunnels.at(BoneKind::Femur);
  const std::string mesh =
      plan.mesh_sha256.contains(BoneKind::Femur) ? plan.mesh_sha256.at(BoneKind::Femur) : "";
  tunnel.diameter_mm = 6;
  tunnel.bundle = norms::Bundle::Anteromedial;
  plan.put(tunnel, mesh);
  tunnel.bundle = norms::Bundle::Posterolateral;
  tunnel.entry_mm += 8 * tunnel.direction.unitOrthogonal();
  plan.put(tunnel, mesh);
  write();
  Dicom fiducials = read("plan.dcm");
  for (const auto& [number, name] : {std::pair(0L, "FEMUR_AM_ENTRY"), std::pair(1L, "FEMUR_PL_ENTRY")}) {
    DcmItem *set = nullptr, *entry = nullptr;
    ASSERT_TRUE(
        fiducials.format.getDataset()->findAndGetSequenceItem(DCM_FiducialSetSequence, set, number).good());
    ASSERT_TRUE(set->findAndGetSequenceItem(DCM_FiducialSequence, entry, 0).good());
    EXPECT_EQ(text(*entry, DCM_FiducialIdentifier), name);
  }
  Dicom drilled = read("femur_drilled.dcm");
  EXPECT_NE(std::string(drilled[DCM_DocumentTitle]).find("tunnels of 6.0 and 6.0 mm"), std::string::npos)
      << drilled[DCM_DocumentTitle];
}

TEST_F(DicomExport, TheReportIsThereByteByByte) {
  be_of_images();
  write();
  Dicom report = read("report.dcm");
  EXPECT_EQ(report[DCM_SOPClassUID], UID_EncapsulatedPDFStorage);
  EXPECT_EQ(report[DCM_Modality], "DOC");
  EXPECT_EQ(report[DCM_MIMETypeOfEncapsulatedDocument], "application/pdf");
  EXPECT_EQ(report[DCM_BurnedInAnnotation], "YES");  // it names the patient
  EXPECT_EQ(report[DCM_ConversionType], "WSD");
  EXPECT_EQ(report.document(), contents_.report_pdf);
}

TEST_F(DicomExport, ThePictureIsThereByteByByte) {
  write();
  Dicom picture = read("image_001.dcm");
  EXPECT_EQ(picture[DCM_SOPClassUID], UID_SecondaryCaptureImageStorage);
  EXPECT_EQ(picture[DCM_PhotometricInterpretation], "RGB");
  Uint16 rows = 0, columns = 0;
  EXPECT_TRUE(picture.format.getDataset()->findAndGetUint16(DCM_Rows, rows).good());
  EXPECT_TRUE(picture.format.getDataset()->findAndGetUint16(DCM_Columns, columns).good());
  EXPECT_EQ(rows, 2);
  EXPECT_EQ(columns, 3);
  const Uint8* bytes = nullptr;
  ASSERT_TRUE(picture.format.getDataset()->findAndGetUint8Array(DCM_PixelData, bytes).good());
  EXPECT_EQ(std::vector<std::uint8_t>(bytes, bytes + 18), contents_.pictures[0].rgb);
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

TEST_F(DicomExport, ATunnelOfAnotherSurfaceIsNotDrilled) {
  contents_.knee.plan.mesh_sha256[BoneKind::Femur] = std::string(64, '0');
  const ExportSummary summary = write();
  EXPECT_THAT(summary.doubts, ElementsAre(HasSubstr("femur")));
  EXPECT_FALSE(fs::exists(folder_ / "out/femur_drilled.dcm"));
  EXPECT_TRUE(fs::exists(folder_ / "out/tibia_drilled.dcm"));
}

TEST_F(DicomExport, WhatIsNotThereIsNotWritten) {
  contents_.report_pdf.clear();
  contents_.pictures.clear();
  contents_.knee.plan = {};
  EXPECT_EQ(write().files.size(), 2U);
}

TEST_F(DicomExport, ATakenFolderStaysAsItIs) {
  fs::create_directory(folder_ / "out");
  files::write_atomically(folder_ / "out/letter.txt", std::string_view("Dear colleague"));
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)write(); }),
              HasSubstr("out: exists and is not empty"));
  EXPECT_EQ(contents_of(folder_ / "out").size(), 1U);
  EXPECT_THAT(test::message_of<InvalidInput>([&] { (void)write("out/letter.txt"); }), HasSubstr("is a file"));
  // An empty one, as made for it, is taken.
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(write("empty/").files.size(), 7U);
  EXPECT_THAT(folder_.names(), ElementsAre("empty", "out"));
}

TEST_F(DicomExport, AFailureLeavesNothingBehind) {
  files::write_atomically(folder_ / "file", std::string_view("x"));
  EXPECT_THAT(test::message_of<IoError>([&] { (void)write("file/out"); }), HasSubstr("file/out"));
  contents_.pictures[0].width = 4;
  EXPECT_THROW((void)write(), InvalidInput);
  contents_.knee.bones.clear();
  EXPECT_THROW((void)write(), InvalidInput);
  EXPECT_THAT(folder_.names(), ElementsAre("file"));
}

}  // namespace
}  // namespace arthronaut::dicom_out
