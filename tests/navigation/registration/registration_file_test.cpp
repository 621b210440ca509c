#include "navigation/registration/registration_file.h"

#include <gtest/gtest.h>

#include "navigation/registration/provenance.h"
#include "navigation/tools/tool_set.h"
#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::registration {
namespace {

RegistrationSummary some_registration() {
  RegistrationSummary summary;
  summary.has_pose = summary.reliable = true;
  summary.reasons.clear();
  summary.marker_from_bone = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(3, 2, 1).normalized())), {1.0 / 3, -2, 30}};
  summary.covariance = geometry::Matrix6d::Identity() / 7;
  summary.predicted_tre_mm = 1.0 / 3;
  summary.stroke_scale = {1.0 / 3, 1.0 / 7};
  return summary;
}

// What it is of comes back, but for the placement, which no file can vouch for.
TEST(RegistrationFile, WhatItIsOfComesBack) {
  const test::TemporaryFolder folder;
  const Provenance of{"ab12", bones::BoneKind::Tibia,   1, 3, "the camera", "the tools",
                      1.3345, sources::SourceKind::Live};
  write_registration_file(folder / "registration.json", some_registration(), &of);
  const RegistrationRecord record = read_registration_record(folder / "registration.json");
  ASSERT_TRUE(record.of);
  EXPECT_EQ(record.of->placement, 0);
  Provenance expected = of;
  expected.placement = 0;
  EXPECT_FALSE(mismatch_of(*record.of, expected));
  EXPECT_EQ(record.of->camera, of.camera);
  EXPECT_EQ(record.of->tools, of.tools);
  EXPECT_EQ(record.of->mesh_sha256, of.mesh_sha256);
  EXPECT_EQ(record.registration.marker_from_bone.translation_mm,
            some_registration().marker_from_bone.translation_mm);
  EXPECT_EQ(record.registration.covariance, some_registration().covariance);
  EXPECT_EQ(record.registration.stroke_scale.ratio, some_registration().stroke_scale.ratio);
  EXPECT_EQ(record.registration.stroke_scale.sigma, some_registration().stroke_scale.sigma);
  write_registration_file(folder / "plain.json", some_registration());
  EXPECT_FALSE(read_registration_record(folder / "plain.json").of) << "it does not say";
}

// What was found on another bone is not taken for this one's; a surface that was mended is still this bone's.
TEST(RegistrationFile, TheSurfaceThatItWasFoundOnComesBack) {
  const test::TemporaryFolder folder;
  const geometry::TriangleMesh bone = test::ellipsoid({40, 30, 25}, 2);
  write_registration_file(folder / "registration.json", some_registration(), registered_mesh(bone));
  const RegistrationRecord record = read_registration_record(folder / "registration.json");
  ASSERT_TRUE(record.mesh);
  EXPECT_FALSE(record.of);
  EXPECT_TRUE(may_be(*record.mesh, bone));
  EXPECT_TRUE(may_be(*record.mesh, test::ellipsoid({40.5, 30, 25}, 3)));
  EXPECT_FALSE(may_be(*record.mesh, test::ellipsoid({42, 30, 25}, 2)));
}

// However many digits the medium has, what was registered in it is of it.
TEST(RegistrationFile, TheMediumComesBackToTheLastDigit) {
  const test::TemporaryFolder folder;
  const Provenance of{"ab12",     bones::BoneKind::Femur,        0, 0, "", "",
                      1.33451234, sources::SourceKind::Recording};
  write_registration_file(folder / "registration.json", some_registration(), &of);
  const RegistrationRecord record = read_registration_record(folder / "registration.json");
  EXPECT_EQ(record.of.value().refractive_index, of.refractive_index);
}

// What is wrong with it is said with the file and the place; a medium may be a number.
TEST(RegistrationFile, WhatItIsOfIsRefusedWithItsPlace) {
  const test::TemporaryFolder folder;
  const Provenance of{"ab12", bones::BoneKind::Femur, 0, 0, "", "", 1.333, sources::SourceKind::Live};
  const std::filesystem::path file = folder / "registration.json";
  const auto refusal_of = [&](const std::string& was, const std::string& is) -> std::string {
    write_registration_file(file, some_registration(), &of);
    std::string text = files::read_text(file);
    text.replace(text.find(was), was.size(), is);
    files::write_atomically(file, text);
    try {
      EXPECT_EQ(read_registration_record(file).of.value().refractive_index, 1.333);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal_of("\"water\"", "1.333"), "");
  EXPECT_EQ(refusal_of("\"water\"", "\"watr\"").find(file.string() + ": of.medium: "), 0U);
  EXPECT_EQ(refusal_of("\"femur\"", "\"fibula\"").find(file.string() + ": of.bone: "), 0U);
}

// A kind of source that does not exist must not pass for a real one.
TEST(RegistrationFile, ABrokenOfIsRefused) {
  const test::TemporaryFolder folder;
  const Provenance of{"ab12", bones::BoneKind::Femur, 0, 0, "", "", 1, sources::SourceKind::Live};
  write_registration_file(folder / "registration.json", some_registration(), &of);
  std::string text = files::read_text(folder / "registration.json");
  const std::size_t at = text.find("\"live\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 6, "\"alive\"");
  files::write_atomically(folder / "registration.json", text);
  EXPECT_THROW((void)read_registration_record(folder / "registration.json"), InvalidInput);
}

// What touches are judged by on cartilage comes back; of a file that does not say it nothing is known there.
TEST(RegistrationFile, WhatWasMadeOfCartilageComesBack) {
  const test::TemporaryFolder folder;
  const auto file = folder / "registration.json";
  const CartilageRegion region{{{0, 0, 0}}, 4};
  const auto offset_mm = [&] { return cartilage_offset_mm(read_registration_file(file), region, {1, 0, 0}); };
  RegistrationSummary summary = some_registration();
  write_registration_file(file, summary);
  EXPECT_EQ(offset_mm(), 0.0);
  summary.cartilage_use = CartilageUse::Solved;
  summary.cartilage_thickness_mm = 7.0 / 3;
  write_registration_file(file, summary);
  EXPECT_EQ(offset_mm(), 7.0 / 3);
  const auto write_with = [&](const std::string& was, const std::string& is) {
    write_registration_file(file, summary);
    std::string text = files::read_text(file);
    ASSERT_NE(text.find(was), std::string::npos);
    files::write_atomically(file, text.replace(text.find(was), was.size(), is));
  };
  write_with("\"cartilage_use\"", "\"cartilage_used\"");
  EXPECT_EQ(offset_mm(), std::nullopt);
  write_with("\"solved\"", "\"dissolved\"");
  EXPECT_THROW((void)offset_mm(), InvalidInput);
  write_with("\"cartilage_thickness_mm\"", "\"thickness_mm\"");
  EXPECT_THROW((void)offset_mm(), InvalidInput);
  summary.cartilage_use = CartilageUse::LeftOut;
  write_registration_file(file, summary);
  EXPECT_EQ(offset_mm(), std::nullopt);
}

// What found nothing has no error: null, not one of 0 mm. Files of before, which say 0, are read likewise.
TEST(RegistrationFile, WithoutAPoseThereIsNoError) {
  const test::TemporaryFolder folder;
  const auto file = folder / "registration.json";
  write_registration_file(file, RegistrationSummary());
  const auto written = files::read_json(file, "arthronaut.registration", 1);
  EXPECT_FALSE(written.has("rms_mm"));
  EXPECT_FALSE(written.has("predicted_tre_mm"));
  EXPECT_FALSE(read_registration_file(file).has_pose);
  std::string text = files::read_text(file);
  for (const char* key : {"\"rms_mm\": null", "\"predicted_tre_mm\": null"})
    text.replace(text.find(key) + std::string_view(key).size() - 4, 4, "0.0");
  files::write_atomically(file, text);
  EXPECT_FALSE(read_registration_file(file).has_pose);
}

RegistrationSummary read_text_of(const test::TemporaryFolder& folder, const std::string& covariance) {
  files::write_atomically(folder / "registration.json", R"({"format": "arthronaut.registration", "version": 1,
    "marker_from_bone": {"q_wxyz": [1, 0, 0, 0], "t_mm": [0, 0, 0]}, "rms_mm": 0.1, "inlier_fraction": 1,
    "point_count": 5, "reliable": true, "reasons": [], "predicted_tre_mm": 0.6)" +
                                                            covariance + "}");
  return read_registration_file(folder / "registration.json");
}

// Another program's file has no covariance: as wrong as it says it is at the target, and not exact.
TEST(RegistrationFile, Hazard6ARegistrationWithoutCovarianceIsNotExact) {
  const test::TemporaryFolder folder;
  const RegistrationSummary read = read_text_of(folder, "");
  EXPECT_NEAR(predicted_error_mm(read, Eigen::Vector3d(40, -300, 25)), 0.6, 1e-9);
}

// One whose parts beside the diagonal are too large would predict an error of nothing.
TEST(RegistrationFile, RefusesWhatIsNoCovariance) {
  const test::TemporaryFolder folder;
  std::string values = "1";
  for (int i = 1; i < 36; ++i) values += i % 7 == 0 ? ", 1" : i == 4 || i == 24 ? ", 5" : ", 0";
  EXPECT_THROW((void)read_text_of(folder, R"(, "covariance": [)" + values + "]"), InvalidInput);
}

// Its frame may lie elsewhere under the same names.
TEST(Provenance, AnotherOutsideTrackerIsNotTheOneRegisteredWith) {
  const auto identity_at = [](const std::string& address) {
    tools::ToolSet tools;
    tools.tracker.emplace().address = address;
    return tools_identity(tools, bones::BoneKind::Femur, "Probe");
  };
  EXPECT_EQ(identity_at("igtl://one:18944"), identity_at("igtl://one:18944"));
  EXPECT_NE(identity_at("igtl://one:18944"), identity_at("igtl://two:18944"));
  EXPECT_NE(identity_at("igtl://one:18944"), identity_at("igtl://one:18945"));
}

}  // namespace
}  // namespace arthronaut::registration
