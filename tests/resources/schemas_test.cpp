// The schemas say what the files are that the program writes and reads.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "navigation/calibration/fluid_file.h"
#include "navigation/camera/doubted_camera_file.h"
#include "navigation/recording/declined_resume.h"
#include "navigation/recording/session_files.h"
#include "navigation/recording/session_marks.h"
#include "navigation/registration/registration.h"
#include "navigation/registration/registration_file.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/cases/case_note.h"
#include "planning/cases/case_sides.h"
#include "planning/cases/identity.h"
#include "planning/cases/measurements.h"
#include "planning/cases/step_history.h"
#include "planning/cases/study.h"
#include "planning/geometry/error.h"
#include "planning/library/cohort.h"
#include "planning/phantom/phantom_case.h"
#include "planning/postop/achieved_file.h"
#include "tests/resources/described.h"
#include "tests/resources/json_schema.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Schemas : public ::testing::Test {
 protected:
  static json read(const fs::path& file) {
    std::ifstream in(file);
    return json::parse(in);
  }
  static json schema_of(const std::string& name) {
    return read(fs::path(ARTHRONAUT_SCHEMAS) / (name + ".schema.json"));
  }
  // As written it fits; without any of what the schema calls required it fits no more, and the reader refuses
  // it.
  template <class Read>
  void expect_described(const fs::path& file, const std::string& name, const Read& read_again) {
    const json written = read(file);
    EXPECT_EQ(test::undescribed(written, name), "") << name;
    for (const std::string key : schema_of(name).at("required")) {
      json broken = written;
      broken.erase(key);
      EXPECT_NE(test::undescribed(broken, name), "") << key;
      std::ofstream(file) << broken;
      EXPECT_THROW(read_again(), InvalidInput) << name << " without " << key;
    }
    std::ofstream(file) << written;
    EXPECT_NO_THROW(read_again());
  }

  const test::TemporaryFolder folder_;
};

// A camera with everything a calibration knows, and one in a fluid that has a number only.
TEST_F(Schemas, DescribeTheCamera) {
  const fs::path file = folder_ / "camera.json";
  camera::CalibrationRecord record;
  record.calibration.image_size_px = {1920, 1080};
  record.calibration.focal_px = 980;
  record.calibration.principal_point_px = {955, 542};
  record.calibration.distortion_xi = -0.4;
  record.calibration.rotation_center_px = {960, 540};
  record.calibration.boundary = {{960, 540}, 520};
  record.calibration.covariance = camera::CameraCovariance::Identity();
  record.rms_px = 0.2;
  for (const double index : {1.0, 1.35}) {
    record.calibration.refractive_index = index;
    camera::write_camera_file(file, record);
    expect_described(file, "camera", [&] { (void)camera::read_camera_file(file); });
  }
  camera::write_doubted_camera_file(file, record, {"the lens was not turned"});
  expect_described(file, "camera", [&] { (void)camera::read_camera_file(file); });
}

// The built-in tools: with tips, with axes.
TEST_F(Schemas, DescribeTheTools) {
  const fs::path file = folder_ / "tools.json";
  tools::ToolSet set = tools::standard_tools();
  tools::write_tools_file(file, set);
  expect_described(file, "tools", [&] { (void)tools::read_tools_file(file); });
  // And with all that a calibration knows, and a drill.
  set.tools[0].tip_covariance_mm2 = Eigen::Matrix3d::Identity();
  set.tools[1].nominal = {true, true, true};
  set.tools[1].axis_point_sigma_mm = set.tools[1].axis_direction_sigma_deg = 0.1;
  set.tools[1].tip_mm = set.tools[1].axis->point_mm;
  set.tools[1].kind = tools::ToolKind::Drill;
  set.tracker =
      tools::OutsideTracker{"igtl://tracker:18944", 0.2, 0.1, {{"femur", "ReferenceToTracker"}}, true};
  tools::write_tools_file(file, set);
  expect_described(file, "tools", [&] { (void)tools::read_tools_file(file); });
}

// A verdict that trusts the camera, and one that does not.
TEST_F(Schemas, DescribeTheFluidCheck) {
  const fs::path file = folder_ / "fluid.json";
  calibration::FluidRecord record;
  record.refractive_index = 1.3345;
  record.provenance.calibrated_utc = "2026-11-21T10:00:00Z";
  for (const bool trusted : {true, false}) {
    record.is_trusted = trusted;
    if (trusted)
      record.reasons.clear();
    else
      record.reasons = {"too few frames"};
    calibration::write_fluid_file(file, record);
    expect_described(file, "fluid", [&] { (void)calibration::read_fluid_file(file); });
  }
}

// The phantom: both bones, their landmarks, both tunnels.
TEST_F(Schemas, DescribeTheCaseAndItsPlan) {
  cases::save_case(folder_.path(), phantom::case_of(phantom::make_phantom_knee(), "phantom"));
  for (const char* name : {"case", "plan"})
    expect_described(folder_ / (std::string(name) + ".json"), name,
                     [&] { (void)cases::load_case(folder_.path()); });
}

// As every import of a volume leaves it.
TEST_F(Schemas, DescribeTheCasesImages) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee(), "phantom");
  cases::CaseImage image;
  image.file = "images/1.nrrd";
  image.modality = "CT";
  image.source = "DICOM";
  image.size = {512, 512, 200};
  image.spacing_mm = {0.5, 0.5, 0.625};
  knee.images = {image};
  image.file = "images/2.nrrd";
  image.is_label_map = true;
  knee.images.push_back(image);
  cases::save_case(folder_.path(), knee);
  ASSERT_EQ(read(folder_ / "case.json").at("images").size(), 2U);
  expect_described(folder_ / "case.json", "case", [&] { (void)cases::load_case(folder_.path()); });
}

// Two bundles in one bone, and a single tunnel in the other.
TEST_F(Schemas, DescribeAPlanOfTwoBundles) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee(), "phantom");
  tunnels::Tunnel tunnel = knee.plan.tunnels.at(bones::BoneKind::Femur);
  for (const auto bundle : {norms::Bundle::Anteromedial, norms::Bundle::Posterolateral}) {
    tunnel.bundle = bundle;
    knee.plan.put(tunnel, "");
  }
  cases::save_case(folder_.path(), knee);
  expect_described(folder_ / "plan.json", "plan", [&] { (void)cases::load_case(folder_.path()); });
}

// Whose knee it is.
TEST_F(Schemas, DescribeTheIdentity) {
  cases::save_identity(folder_.path(), {"Muster^Anna", "4711", "19900131"});
  expect_described(cases::identity_file(folder_.path()), "identity",
                   [&] { (void)cases::load_identity(folder_.path()); });
}

// Of which study its images were.
TEST_F(Schemas, DescribeTheStudy) {
  images::DicomOrigin origin;
  origin.study_uid = "1.2.3";
  origin.sop_instance_uids = {"1.2.3.4"};
  cases::save_studies(folder_.path(), {{bones::BoneKind::Femur, origin}, {bones::BoneKind::Tibia, origin}});
  expect_described(cases::study_file(folder_.path()), "study",
                   [&] { (void)cases::load_studies(folder_.path()); });
}

// What was measured: a distance and an angle.
TEST_F(Schemas, DescribeTheMeasurements) {
  cases::save_measurements(folder_.path(), {{{{1, 2, 3}, {4, 5, 6}}}, {{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}}}});
  expect_described(cases::measurements_file(folder_.path()), "measurements",
                   [&] { (void)cases::load_measurements(folder_.path()); });
}

TEST_F(Schemas, DescribeTheBonesDoubts) {
  cases::save_bone_doubts(folder_.path(),
                          {{bones::BoneKind::Femur,
                            {"cut off", cases::FilledHoles{{{.at_mm = {1, 2, 3}, .across_mm = 12}}},
                             bones::ImageCut{.area_mm2 = 1234}, cases::SurfaceLookedAt{},
                             cases::SideDoubt{.looked_on = "2026-01-31"}}}});
  expect_described(cases::bone_doubts_file(folder_.path()), "bone_doubts",
                   [&] { (void)cases::load_bone_doubts(folder_.path()); });
}

// What a case had as a right knee, and that a change was cut off.
TEST_F(Schemas, DescribeTheOtherSide) {
  const cases::Case knee =
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Knee of a test");
  cases::save_case(folder_.path(), knee);
  cases::change_side(folder_.path(), bones::Side::Left,
                     {.plan = knee.plan,
                      .doubts = {{bones::BoneKind::Femur,
                                  {"cut off", cases::FilledHoles{{{.at_mm = {1, 2, 3}, .across_mm = 12}}},
                                   bones::ImageCut{.area_mm2 = 1234}, cases::SideDoubt{}}}}});
  expect_described(cases::sides_file(folder_.path()), "sides",
                   [&] { (void)cases::load_side(folder_.path(), knee, bones::Side::Right); });
  json cut_off = read(cases::sides_file(folder_.path()));
  cut_off["changing_to"] = "right";
  EXPECT_EQ(test::undescribed(cut_off, "sides"), "");
}

TEST_F(Schemas, DescribeTheSteps) {
  const cases::Case knee =
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Knee of a test");
  const cases::PlanState before{knee.plan, {}, knee.landmarks, knee.landmark_states};
  cases::PlanState after = before;
  after.measurements = {{{{1, 2, 3}, {4, 5, 6}}}};
  cases::save_step_history(folder_.path(), {{{"Measure a distance", before, after}}, 1});
  expect_described(cases::step_history_file(folder_.path()), "history",
                   [&] { (void)cases::load_step_history(folder_.path()); });
}

TEST_F(Schemas, DescribeTheNote) {
  std::ofstream(folder_ / "case.json") << "{}";
  cases::save_note_over(folder_.path(), "look again #study", "");
  expect_described(cases::note_file(folder_.path()), "note", [&] { (void)cases::load_note(folder_.path()); });
}

TEST_F(Schemas, DescribeTheMarks) {
  recording::write_marks(folder_.path(), {{12, 200'000'000, "first touch"}, {30, 500'000'000, ""}});
  expect_described(recording::marks_file(folder_.path()), "marks",
                   [&] { (void)recording::read_marks(folder_.path()); });
}

TEST_F(Schemas, DescribeThatAnOperationIsNotToBeResumed) {
  recording::decline_resume(folder_.path());
  expect_described(recording::declined_file(folder_.path()), "declined",
                   [&] { EXPECT_TRUE(recording::is_resume_declined(folder_.path())); });
}

// Of a session that says little, and of one that says all, in two parts of video.
TEST_F(Schemas, DescribeTheSession) {
  pipeline::PipelineOptions options;
  options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
  options.tools = tools::standard_tools();
  recording::SessionHeader header;
  header.id = "0001-20260131-120000";
  header.started_utc = "2026-01-31T12:00:00Z";
  const fs::path file = folder_ / "session.json";
  recording::write_session_header(folder_.path(), header, options);
  expect_described(file, "session", [&] { (void)recording::read_session_header(folder_.path(), options); });
  header.source_kind = sources::SourceKind::Live;
  header.mesh_sha256 = header.build = "5f";
  header.continues = "0000-20260131-110000";
  header.registers_after_mm = 12;
  header.video_parts = {{.file = "video.mkv"}, {.file = "video_2.mkv", .first_picture = 300}};
  recording::write_session_header(folder_.path(), header, options);
  json written = read(file);
  EXPECT_EQ(test::undescribed(written, "session"), "");
  written["video_parts"][0]["pictures"] = "somehow";
  EXPECT_NE(test::undescribed(written, "session"), "");
}

// What `cases --json` writes: a case with everything, one that is gone, one that cannot be read.
TEST_F(Schemas, DescribeTheListOfCases) {
  const fs::path file = folder_ / "cases.json";
  std::vector<library::CaseRecord> records(3);
  for (library::CaseRecord& record : records) {
    record.folder = "/cases/A.arthro";
    record.name = "A";
  }
  records[0].side = bones::Side::Left;
  records[0].bones = records[0].planned = {bones::BoneKind::Femur, bones::BoneKind::Tibia};
  library::SessionFacts session;
  session.id = "0001-20260131-120000";
  session.registration_is_reliable = true;
  session.registration_rms_mm = session.predicted_error_mm = session.entry_offset_mm = session.angle_deg = 1;
  session.depth_mm = session.registering_min = session.verifying_min = session.drilling_min = 2;
  session.problem = "poses.csv: cut off";
  records[0].sessions = {session, library::SessionFacts{}};
  records[0].postoperative = {{.entry_offset_mm = 1, .angle_deg = 2, .diameter_mm = 9},
                              library::PostoperativeFacts()};
  records[0].postoperative[0].known = {tunnels::Quantity::Entry};
  records[0].postoperative[1].tunnel = bones::BoneKind::Tibia;
  records[1].is_there = false;
  records[2].problem = "case.json: broken";
  const library::Identities named{{records[0].folder, {"Muster^Anna", "4711", "19900131"}}};
  for (const library::Identities* identities : {static_cast<const library::Identities*>(nullptr), &named}) {
    library::write_cases_json(file, records, identities,
                              {{records[0].folder, {.wrong = {"femur: Wall: 0.4 mm"}, .look = {}}}});
    EXPECT_EQ(test::undescribed(read(file), "cases"), "");
  }
  json broken = read(file);
  broken["cases"][0]["state"] = "lost";
  EXPECT_NE(test::undescribed(broken, "cases"), "");
}

// A registration that stands, and one that found nothing.
TEST_F(Schemas, DescribeTheRegistration) {
  const fs::path file = folder_ / "registration.json";
  registration::RegistrationSummary found;
  found.has_pose = found.reliable = true;
  found.reasons.clear();
  found.assumptions = {"the cartilage is 2 mm thick"};
  found.point_count = 400;
  found.inlier_fraction = 0.9;
  for (const registration::RegistrationSummary& summary : {found, registration::RegistrationSummary()}) {
    registration::write_registration_file(file, summary);
    EXPECT_EQ(test::undescribed(read(file), "registration"), "");
  }
  registration::write_registration_file(file, found);
  expect_described(file, "registration", [&] { (void)registration::read_registration_file(file); });
  registration::write_registration_file(file, found, registration::RegisteredMesh{"5f", {}});
  EXPECT_EQ(test::undescribed(read(file), "registration"), "");
  // And what it is of, as the sessions of an operation and `register` for a case write it.
  registration::Provenance of;
  of.mesh_sha256 = of.camera = of.tools = "5f";
  of.refractive_index = 1.3401;
  registration::write_registration_file(file, found, &of);
  json written = read(file);
  EXPECT_EQ(test::undescribed(written, "registration"), "");
  written["of"]["bone"] = "patella";
  EXPECT_NE(test::undescribed(written, "registration"), "");
}

// A tunnel and a bone that were found, and ones that were not.
TEST_F(Schemas, DescribeWhatWasAchieved) {
  const fs::path file = folder_ / "achieved.json";
  postop::Comparison found;
  found.bone.is_found = found.tunnel.is_found = true;
  found.tunnel.known = {tunnels::Quantity::Entry, tunnels::Quantity::Direction};
  found.tunnel.widths = {{.from_entry_mm = 2, .diameter_mm = 9.5, .sigma_mm = 0.1},
                         {.from_entry_mm = 6, .diameter_mm = 9.5}};
  postop::write_achieved_file(
      file, {{bones::BoneKind::Femur, found}, {bones::BoneKind::Tibia, {}}},
      {{bones::BoneKind::Femur, {.grid = {{"High to low", 35, 38}}, .wall_mm = 1.5}}});
  const json written = read(file);
  EXPECT_EQ(test::undescribed(written, "achieved"), "");
  EXPECT_TRUE(written.at("tunnels").at(1).at("entry_mm").is_null());
  for (const char* key : {"/tunnels/0/offset_mm", "/tunnels/1/reasons", "/tunnels/0/grid/0/planned_percent",
                          "/tunnels/0/reliable_quantities/1", "/bones/0/rms_mm", "/bones"}) {
    json broken = written;
    broken[json::json_pointer(key)] = "none";
    EXPECT_NE(test::undescribed(broken, "achieved"), "") << key;
  }
}

// Several markers on a tool and on a world; both ways to say it at once fit neither schema nor reader.
TEST_F(Schemas, DescribeBodiesOfSeveralMarkers) {
  const fs::path file = folder_ / "tools.json";
  tools::ToolSet set = tools::standard_tools();
  const geometry::RigidTransform beside{Eigen::Quaterniond::Identity(), {0, 9, 0}};
  set.tools[0].markers = {{2, 4.0, {}}, {12, 3.0, beside, 0.02, 0.1}};
  set.world_markers[0].markers = {{0, 4.0, {}}, {10, 4.0, beside}};
  tools::write_tools_file(file, set);
  expect_described(file, "tools", [&] { (void)tools::read_tools_file(file); });
  const json good = read(file);
  const auto broken = [&](const char* place, const json& value) {
    json document = good;
    document[json::json_pointer(place)] = value;
    std::ofstream(file) << document;
    EXPECT_THROW((void)tools::read_tools_file(file), InvalidInput) << place;
    return test::undescribed(document, "tools");
  };
  EXPECT_NE(broken("/tools/0/marker_id", 2), "");
  EXPECT_NE(broken("/tools/0/size_mm", 4), "");
  EXPECT_NE(broken("/tools/0/markers", json::array()), "");
  EXPECT_NE(broken("/world_markers/0/markers/1/tool_from_marker", json::object()), "");
  EXPECT_NE(broken("/tools/0/markers/1/sigma_deg", -1), "");
}

// The check itself: wrong types, numbers out of bounds, members that nobody described.
TEST_F(Schemas, CatchWhatIsWrong) {
  const fs::path file = folder_ / "tools.json";
  tools::write_tools_file(file, tools::standard_tools());
  const json good = read(file);
  const auto broken = [&](const char* place, const json& value) {
    json document = good;
    document[json::json_pointer(place)] = value;
    return test::undescribed(document, "tools");
  };
  EXPECT_NE(broken("/version", 2), "");
  EXPECT_NE(broken("/world_markers/0/size_mm", 0), "");
  EXPECT_NE(broken("/world_markers/0/marker_id", 50), "");
  EXPECT_NE(broken("/world_markers/0/bone", "patella"), "");
  EXPECT_NE(broken("/tools/0/name", 7), "");
  EXPECT_NE(broken("/tools/0/tip_mm", json::array({1, 2})), "");
  EXPECT_NE(broken("/tools/0/colour", "red"), "");
}

}  // namespace
}  // namespace arthronaut
