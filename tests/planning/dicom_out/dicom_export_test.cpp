#include "planning/dicom_out/dicom_export.h"

#include <gmock/gmock.h>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/plan_file.h"
#include "planning/geometry/error.h"
#include "planning/plan_export/drilled_bone.h"
#include "tests/message_of.h"
#include "tests/planning/dicom_out/exported_case.h"

namespace arthronaut::dicom_out {
namespace {

namespace fs = std::filesystem;
using bones::BoneKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
