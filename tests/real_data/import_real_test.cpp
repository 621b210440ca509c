#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <sstream>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/images/dicom_slice.h"
#include "planning/images/volume_file.h"
#include "planning/import/bone_import.h"
#include "planning/landmarks/propose.h"
#include "tests/message_of.h"
#include "tests/real_data/real_data.h"

namespace arthronaut::importing {

using namespace images;  // volumes and slices are looked at beside the bones that come of them
namespace {

using bones::BoneKind;
using bones::Side;
using test::message_of;
using testing::HasSubstr;
using testing::Not;

// What every imported bone must be, whatever it came from.
void expect_sound(const ImportedBone& imported) {
  EXPECT_TRUE(imported.repair.is_closed);
  EXPECT_TRUE(imported.doubts.empty()) << (imported.doubts.empty() ? "" : imported.doubts.front());
  const geometry::TriangleMesh& mesh = imported.bone.mesh;
  const double volume_ml = geometry::signed_volume_mm3(mesh) / 1000;
  // A distal femur or a proximal tibia of an adult, as far as a knee scan shows it.
  EXPECT_GT(volume_ml, 40);
  EXPECT_LT(volume_ml, 500);
  const geometry::Surface surface(mesh);
  const geometry::Bounds bounds = geometry::bounds_of(mesh);
  EXPECT_GT(surface.signed_distance_mm(bounds.max_mm + Eigen::Vector3d::Constant(5)), 5);
  for (const auto& line : imported.lines) std::cout << "    " << line << '\n';
}

// The four bones from MRI: names that say side and bone, open edges in one femur and in the tibia.
TEST(ImportRealBones, FemoraAndTibiaFromMri) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/mri-femora");
  for (const char* name : {"1_RIGHT_femur_Nov_02_2021.vtk", "3_RIGHT_femur_Nov_02_2021.vtk",
                           "femur_mesh_10k_pts.vtk", "tibia_smoothed_image_10k_pts_thick_regions.vtk"}) {
    SCOPED_TRACE(name);
    std::cout << name << '\n';
    BoneImportOptions options;
    options.side = Side::Right;
    const BoneImport import = import_bones(folder / name, options);
    ASSERT_EQ(import.bones.size(), 1U);
    expect_sound(import.bones[0]);
    EXPECT_EQ(import.bones[0].bone.kind,
              std::string(name).starts_with("tibia") ? BoneKind::Tibia : BoneKind::Femur);
    // A fin on one edge is all that these files have: nothing of the bone may go with it.
    EXPECT_NEAR(static_cast<double>(import.bones[0].repair.triangles_now),
                static_cast<double>(import.bones[0].repair.triangles_found), 10);
  }
  EXPECT_EQ(side_in_name(folder / "3_RIGHT_femur_Nov_02_2021.vtk"), Side::Right);
}

// Metres: refused with the way out, then right; and the published attachment points lie on the bone that
// comes of it.
TEST(ImportRealBones, BonesInMetres) {
  ARTHRONAUT_REQUIRE_DATA(folder, "bones/lenhart2015");
  for (const char* name : {"lenhart2015-R-femur-bone.stl", "lenhart2015-R-tibia-bone.stl"}) {
    SCOPED_TRACE(name);
    std::cout << name << '\n';
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(folder / name); }), HasSubstr("--unit m "));
    BoneImportOptions options;
    options.unit = bones::LengthUnit::Metre;
    const BoneImport import = import_bones(folder / name, options);
    EXPECT_EQ(import.side, Side::Right);
    // Its y is up, not backwards: noticed by the shape.
    EXPECT_TRUE(import.bones.at(0).repair.is_closed);
    EXPECT_THAT(import.bones.at(0).doubts, testing::Contains(HasSubstr("axes of the file")));
    EXPECT_TRUE(import.bones.at(0).repair.lines().empty());
  }
  BoneImportOptions options;
  options.unit = bones::LengthUnit::Metre;
  const geometry::Surface femur(
      import_bones(folder / "lenhart2015-R-femur-bone.stl", options).bones.at(0).bone.mesh);
  std::ifstream points(folder / "acl_pcl_attachments.csv");
  std::string line;
  int count = 0;
  while (std::getline(points, line)) {
    if (line.find("femur") == std::string::npos || line.find("ACL") == std::string::npos) continue;
    std::vector<double> numbers;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      if (end != cell.c_str() && *end == '\0') numbers.push_back(value);
    }
    if (numbers.size() < 3) continue;
    const Eigen::Vector3d p = 1000 * Eigen::Vector3d(numbers.data() + numbers.size() - 3);
    // The data's own note: 0.02 mm inside to 0.25 mm outside.
    EXPECT_LT(std::abs(femur.signed_distance_mm(p)), 0.4) << line;
    ++count;
  }
  EXPECT_EQ(count, 12);
}

TEST(ImportRealBones, PatellaNeedsItsBoneNamed) {
  ARTHRONAUT_REQUIRE_DATA(file, "bones/lenhart2015/lenhart2015-R-patella-bone.stl");
  BoneImportOptions options;
  options.unit = bones::LengthUnit::Metre;
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)import_bones(file, options); }), HasSubstr("--bone"));
}

// A cartilage is a sheet: it can be closed, but not without a doubt.
TEST(ImportRealBones, CartilageRaisesADoubt) {
  ARTHRONAUT_REQUIRE_DATA(file, "bones/lenhart2015/lenhart2015-R-tibia-cartilage.stl");
  BoneImportOptions options;
  options.unit = bones::LengthUnit::Metre;
  const BoneImport import = import_bones(file, options);
  EXPECT_FALSE(import.bones.at(0).doubts.empty());
}

void expect_same_volume(const Volume& a, const Volume& b) {
  // The two files may run through the same patient the other way round: compare where the voxels are.
  const Eigen::Affine3d b_from_a = b.lps_from_index.inverse() * a.lps_from_index;
  ASSERT_EQ(a.size.prod(), b.size.prod());
  double worst_offset = 0, worst_value = 0;
  for (int k = 0; k < a.size.z(); ++k) {
    for (int j = 0; j < a.size.y(); ++j) {
      for (int i = 0; i < a.size.x(); ++i) {
        const Eigen::Vector3d exact = b_from_a * Eigen::Vector3d(i, j, k);
        const Eigen::Vector3i at = exact.array().round().cast<int>();
        ASSERT_TRUE((at.array() >= 0).all() && (at.array() < b.size.array()).all()) << at.transpose();
        worst_offset = std::max(worst_offset, (exact - at.cast<double>()).norm());
        worst_value = std::max(worst_value,
                               static_cast<double>(std::abs(a.at(i, j, k) - b.at(at.x(), at.y(), at.z()))));
      }
    }
  }
  // Header text of the one and 32-bit floats of the other.
  EXPECT_LT(worst_offset, 0.01);
  std::cout << "    worst difference: " << worst_value << " of value, " << worst_offset
            << " voxels of place\n";
  EXPECT_LT(worst_value, 0.51);  // the NIfTI was made before the values were rounded for DICOM
}

// The authors' NIfTI of the same volume, through another reader and another frame (RAS): voxel by voxel the
// same.
TEST(ImportRealVolumes, DicomAndNiftiOfTheSameCtAgree) {
  ARTHRONAUT_REQUIRE_DATA(dicom, "volumes/knee-ct-051/CT");
  ARTHRONAUT_REQUIRE_DATA(nifti, "volumes/STS_051_CT_image.nii.gz");
  const Volume a = read_volume(dicom), b = read_volume(nifti);
  EXPECT_EQ(a.size, Eigen::Vector3i(177, 162, 61));
  EXPECT_NEAR((a.spacing_mm() - Eigen::Vector3d(0.9765625, 0.9765625, 3.27)).norm(), 0, 0.01);
  EXPECT_EQ(a.modality, Modality::Ct);
  expect_same_volume(a, b);
}

TEST(ImportRealVolumes, DicomAndNiftiOfTheSameMrAgree) {
  ARTHRONAUT_REQUIRE_DATA(dicom, "volumes/knee-ct-028/MR_T1");
  ARTHRONAUT_REQUIRE_DATA(nifti, "volumes/STS_028_MR_T1_image.nii.gz");
  expect_same_volume(read_volume(dicom), read_volume(nifti));
}

// A study folder with CT, MR and a contour: the series are listed, the contour is no image.
TEST(ImportRealVolumes, AStudyWithSeveralSeriesAsksWhich) {
  ARTHRONAUT_REQUIRE_DATA(folder, "volumes/knee-ct-028");
  const std::string message = message_of<InvalidInput>([&] { (void)read_volume(folder); });
  EXPECT_THAT(message, HasSubstr("2 series"));
  EXPECT_THAT(message, HasSubstr("--series"));
  ARTHRONAUT_REQUIRE_DATA(contour, "volumes/knee-ct-028/CT-rtstruct");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(contour); }), HasSubstr("no image"));
}

TEST(ImportRealVolumes, BonesOfTheCts) {
  for (const char* name : {"volumes/knee-ct-051/CT", "volumes/knee-ct-028/CT"}) {
    ARTHRONAUT_REQUIRE_DATA(folder, name);
    for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
      SCOPED_TRACE(std::string(name) + " " + std::string(bones::to_text(kind)));
      std::cout << name << ' ' << bones::to_text(kind) << '\n';
      BoneImportOptions options;
      options.kind = kind;
      options.side = Side::Left;
      const BoneImport import = import_bones(folder, options);
      EXPECT_TRUE(import.bones.at(0).repair.is_closed);
      for (const auto& line : import.bones.at(0).lines) std::cout << "    " << line << '\n';
      for (const auto& doubt : import.bones.at(0).doubts) {
        std::cout << "    doubt: " << doubt << '\n';
        EXPECT_THAT(doubt, Not(HasSubstr("patient's back")));  // both lie as DICOM says
      }
    }
  }
}

// The images of both end within the femur, in front. Of a long one that cut is told from the shaft's; of a
// short one it is not, and no landmarks are proposed, where they came out turned by a right angle.
TEST(ImportRealVolumes, AFemurThatIsCutOffInFrontGivesNoTurnedLandmarks) {
  ARTHRONAUT_REQUIRE_DATA(cut, "volumes/knee-ct-028/CT");
  ARTHRONAUT_REQUIRE_DATA(longer, "volumes/knee-ct-051/CT");
  const auto proposed_of = [](const std::filesystem::path& folder) {
    BoneImportOptions options;
    options.side = Side::Left;
    const BoneImport import = import_bones(folder, options);
    EXPECT_EQ(import.bones.at(0).bone.kind, BoneKind::Femur);
    return landmarks::propose(import.bones.at(0).bone.mesh, BoneKind::Femur, {.side = Side::Left});
  };
  const landmarks::Proposal of_cut = proposed_of(cut), of_longer = proposed_of(longer);
  EXPECT_FALSE(of_cut.is_usable());
  EXPECT_THAT(of_cut.reason, HasSubstr("cut off through the joint's end"));
  ASSERT_TRUE(of_longer.is_usable()) << of_longer.reason;
  EXPECT_GT(of_longer.axes.proximal.z(), 0.8);
  EXPECT_LT(of_longer.axes.anterior.y(), -0.8);
  EXPECT_GT(of_longer.axes.lateral.x(), 0.8);
}

// An oblique label map: the bones must stand above each other in the patient, and have the size of a knee.
TEST(ImportRealVolumes, LabelsOfAnObliqueVolume) {
  ARTHRONAUT_REQUIRE_DATA(file, "volumes/labels/SAG_3D_DESS_RIGHT_bones_cart_men_fib-label.nrrd");
  const BoneImport unasked = import_bones(file);
  ASSERT_EQ(unasked.bones.size(), 2U) << "two labels alone have their shapes";
  EXPECT_EQ(unasked.bones[0].bone.source, "label 5 of NRRD");
  EXPECT_EQ(unasked.bones[1].bone.source, "label 6 of NRRD");
  BoneImportOptions options;
  options.labels = {{BoneKind::Femur, 5}, {BoneKind::Tibia, 6}};
  const BoneImport import = import_bones(file, options);
  EXPECT_EQ(import.side, Side::Right);
  ASSERT_EQ(import.bones.size(), 2U);
  for (const auto& imported : import.bones) expect_sound(imported);
  const auto femur = geometry::bounds_of(import.bones[0].bone.mesh),
             tibia = geometry::bounds_of(import.bones[1].bone.mesh);
  EXPECT_GT(femur.min_mm.z(), tibia.max_mm.z() - 25);  // the eminences reach into the notch
  EXPECT_NEAR(femur.center_mm().x(), tibia.center_mm().x(), 10);
  // 1.53 million voxels of 0.3646 x 0.3646 x 0.70 mm.
  const Volume volume = read_volume(file);
  for (const auto& [value, count] : labels_of(volume)) {
    if (value != 5) continue;
    const double labelled_mm3 =
        static_cast<double>(count) * std::abs(volume.lps_from_index.linear().determinant());
    EXPECT_NEAR(import.bones[0].repair.volume_mm3, labelled_mm3, 0.01 * labelled_mm3);
  }
}

// Eight echoes, big endian, 4 mm from slice to slice while the header's thickness says 3.
TEST(ImportRealVolumes, MultiEchoBigEndianSeries) {
  ARTHRONAUT_REQUIRE_DATA(folder, "volumes/mr-multi-echo-big-endian");
  const Volume volume = read_volume(folder);
  EXPECT_EQ(volume.size, Eigen::Vector3i(256, 256, 24));
  EXPECT_NEAR(volume.spacing_mm().z(), 4.0, 0.01);
  EXPECT_NEAR(volume.spacing_mm().x(), 0.625, 1e-3);
  bool said = false;
  for (const auto& note : volume.notes) said = said || note.find("echo") != std::string::npos;
  EXPECT_TRUE(said);
  // Values swapped by mistake would fill the 16 bits.
  EXPECT_LT(*std::max_element(volume.values.begin(), volume.values.end()), 20000);
}

// One slice in seven transfer syntaxes: the same pixels each time, or a refusal with the reason.
TEST(ImportRealVolumes, TransferSyntaxesDecodeOrAreRefused) {
  ARTHRONAUT_REQUIRE_DATA(folder, "volumes/transfer-syntaxes");
  std::map<std::string, std::string> outcomes;
  std::map<std::string, std::vector<float>> pixels;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".dcm") continue;
    const std::string name = entry.path().filename().string();
    try {
      const auto slices = read_dicom_slices(entry.path(), VolumeFileOptions{}.most_bytes);
      if (!slices || slices->empty()) {
        outcomes[name] = slices ? "no image" : "no DICOM";
        continue;
      }
      ASSERT_EQ(slices->size(), 1U) << name;
      append_pixels(slices->front(), pixels[name]);
      outcomes[name] = "read";
    } catch (const InvalidInput& error) {
      outcomes[name] = error.what();
    }
  }
  for (const auto& [name, outcome] : outcomes) std::cout << "    " << name << ": " << outcome << '\n';
  EXPECT_GE(outcomes.size(), 16U);
  for (const char* name :
       {"MR_small_RLE.dcm", "MR_small_bigendian.dcm", "MR_small_expb.dcm", "MR_small_implicit.dcm",
        "MR_small_jp2klossless.dcm", "MR_small_jpeg_ls_lossless.dcm", "MR_small_padded.dcm"}) {
    EXPECT_EQ(outcomes[name], "read");
    EXPECT_EQ(pixels[name], pixels["MR_small.dcm"]) << name;
  }
  EXPECT_EQ(pixels["MR_small.dcm"].size(), 64U * 64U);
  EXPECT_THAT(outcomes["MR_truncated.dcm"], HasSubstr("MR_truncated.dcm: "));
  EXPECT_EQ(outcomes["rtplan.dcm"], "no image");
}

}  // namespace
}  // namespace arthronaut::importing
