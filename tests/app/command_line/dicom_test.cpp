// dicom on a knee that came from a hospital's CT, and on the built-in one.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "app/scene/image.h"
#include "navigation/recording/session.h"
#include "navigation/sources/exercise_source.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string text(DcmDataset& dataset, const DcmTagKey& key) {
  OFString value;
  return dataset.findAndGetOFStringArray(key, value).good() ? std::string(value.c_str()) : "(absent)";
}

std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder))
    contents[entry.path().filename().string()] = files::read_text(entry.path());
  return contents;
}

class DicomCommand : public ::testing::Test {
 protected:
  // A case of one bone by the import that a user types.
  void import_ct(const test::DicomSeriesForm& form = {}) const {
    test::write_dicom_series(folder_ / "ct", test::ellipsoid_ct(), form);
    const auto result = run_program({"import", folder_ / "ct", "-o", folder_ / "knee.arthro", "--bone",
                                     "femur", "--side", "right", "--threshold", "300"});
    // An ellipsoid is doubted to be a femur, and written all the same.
    ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 4) << result.output << result.errors;
  }
  void take_phantom() const {
    cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4.0}), "Phantom");
    cases::save_case(folder_ / "knee.arthro", knee);
    fs::create_directory(folder_ / "knee.arthro/pictures");
    scene::write_png(folder_ / "knee.arthro/pictures/a.png",
                     {.width = 2, .height = 1, .rgb = {255, 0, 0, 0, 0, 255}});
  }
  [[nodiscard]] test::ProgramResult run(const std::string& output,
                                        std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"dicom", folder_ / "knee.arthro", "-o", folder_ / output});
    return run_program(options);
  }
  // What a person reads in the report.
  [[nodiscard]] std::string report_text(const std::string& output) const {
    DcmFileFormat format;
    const Uint8* bytes = nullptr;
    unsigned long length = 0;
    if (format.loadFile((folder_ / output / "report.dcm").c_str()).bad() ||
        format.getDataset()->findAndGetUint8Array(DCM_EncapsulatedDocument, bytes, &length).bad())
      return "(none)";
    const fs::path pdf = folder_ / "report.pdf", words = folder_ / "report.txt";
    files::write_atomically(pdf, std::string_view(reinterpret_cast<const char*>(bytes), length));
    if (std::system(("pdftotext " + pdf.string() + " " + words.string()).c_str()) != 0) return "(no PDF)";
    return files::read_text(words);
  }

  // As dciodvfy reads them, errors and what kind of object each is.
  void expect_as_the_standard_asks(const std::string& output) const {
    ASSERT_EQ(std::system("command -v dciodvfy > /dev/null"), 0)
        << "dciodvfy (package dicom3tools) is needed";
    for (const auto& entry : fs::directory_iterator(folder_ / output)) {
      const fs::path found = folder_ / "found.txt";
      (void)std::system(
          ("dciodvfy -new " + entry.path().string() + " > " + found.string() + " 2>&1").c_str());
      const std::string lines = files::read_text(found);
      EXPECT_THAT(lines, Not(HasSubstr("Error"))) << entry.path();
      EXPECT_THAT(lines, testing::AnyOf(HasSubstr("EncapsulatedSTL"), HasSubstr("EncapsulatedPDF"),
                                        HasSubstr("SpatialFiducials"), HasSubstr("SCImage")))
          << entry.path();
    }
  }

  const test::TemporaryFolder folder_;
};

TEST_F(DicomCommand, PutsTheCaseBesideItsImages) {
  import_ct();
  const auto result = run("out");
  ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
  for (const char* name : {"femur.dcm", "report.dcm"}) {
    DcmFileFormat slice, object;
    ASSERT_TRUE(slice.loadFile((folder_ / "ct/slice1000.dcm").c_str()).good());
    ASSERT_TRUE(object.loadFile((folder_ / "out" / name).c_str()).good()) << name;
    for (const DcmTagKey& key : {DCM_PatientName, DCM_PatientID, DCM_StudyInstanceUID, DCM_AccessionNumber})
      EXPECT_EQ(text(*object.getDataset(), key), text(*slice.getDataset(), key));
    const std::string frame =
        name == std::string("femur.dcm") ? text(*slice.getDataset(), DCM_FrameOfReferenceUID) : "(absent)";
    EXPECT_EQ(text(*object.getDataset(), DCM_FrameOfReferenceUID), frame);
  }
  EXPECT_THAT(report_text("out"), HasSubstr("Muster, Anna"));
  EXPECT_THAT(result.output, HasSubstr("They name the patient"));
}

TEST_F(DicomCommand, Hazard19DeidentifiedNamesNobody) {
  import_ct();
  const auto result = run("out", {"--deidentified"});
  ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
  EXPECT_THAT(report_text("out"), AllOf(HasSubstr("ACL reconstruction"), Not(HasSubstr("Muster"))));
  EXPECT_THAT(result.output, Not(HasSubstr("They name the patient")));
  for (const auto& [name, bytes] : contents_of(folder_ / "out"))
    for (const char* word : {"Muster", "19900131", "A-0815", "1.2.826.0.1.3680043.8.498"})
      EXPECT_EQ(bytes.find(word), std::string::npos) << name << ": " << word;
}

// Readers of other origin than DCMTK, which wrote them: pydicom and GDCM find the same patient and study,
// what is encapsulated byte for byte, and the picture's own colours.
TEST_F(DicomCommand, PydicomAndGdcmReadTheSame) {
  ASSERT_EQ(std::system("/usr/bin/python3 -c 'import pydicom, numpy' && command -v gdcmraw > /dev/null"), 0)
      << "the packages python3-pydicom, python3-numpy and libgdcm-tools are needed";
  take_phantom();
  ASSERT_EQ(run("out").exit_code, 0);
  const fs::path raw = folder_ / "raw", by_pydicom = folder_ / "by_pydicom", said = folder_ / "said.txt";
  std::size_t encapsulated = 0, pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    const std::string file = entry.path().string();
    SCOPED_TRACE(file);
    DcmFileFormat own;
    ASSERT_TRUE(own.loadFile(file.c_str()).good());
    ASSERT_EQ(
        std::system(("/usr/bin/python3 -c \"import pydicom; d = pydicom.dcmread('" + file +
                     "'); print(d.SOPClassUID, d.StudyInstanceUID, d.PatientID, sep='|', end=''); "
                     "open('" +
                     by_pydicom.string() +
                     "', 'wb').write(d.EncapsulatedDocument[:d.EncapsulatedDocumentLength] if "
                     "'EncapsulatedDocument' in d else d.pixel_array.tobytes() if 'PixelData' in d else "
                     "b'')\" > " +
                     said.string())
                        .c_str()),
        0);
    EXPECT_EQ(files::read_text(said), text(*own.getDataset(), DCM_SOPClassUID) + "|" +
                                          text(*own.getDataset(), DCM_StudyInstanceUID) + "|" +
                                          text(*own.getDataset(), DCM_PatientID));
    ASSERT_EQ(std::system(("gdcmdump " + file + " > " + said.string()).c_str()), 0);
    EXPECT_THAT(files::read_text(said), HasSubstr(text(*own.getDataset(), DCM_StudyInstanceUID)));
    const bool is_document = own.getDataset()->tagExists(DCM_EncapsulatedDocument);
    const bool is_picture = own.getDataset()->tagExists(DCM_PixelData);
    if (!is_document && !is_picture) continue;
    ASSERT_EQ(std::system(("gdcmraw -t " + std::string(is_document ? "42,11" : "7fe0,10") + " -i " + file +
                           " -o " + raw.string())
                              .c_str()),
              0);
    std::string by_gdcm = files::read_text(raw);
    const std::string expected = files::read_text(by_pydicom);
    // A value is padded to an even length.
    EXPECT_LE(by_gdcm.size() - expected.size(), 1U);
    by_gdcm.resize(expected.size());
    EXPECT_TRUE(by_gdcm == expected);
    encapsulated += is_document;
    pictures += is_picture;
    if (entry.path().filename() == "report.dcm") {
      EXPECT_THAT(expected, testing::StartsWith("%PDF-"));
    }
    if (is_picture && expected.size() == 6) {
      EXPECT_EQ(expected, (std::string{'\xff', 0, 0, 0, 0, '\xff'}));
    }
  }
  EXPECT_EQ(encapsulated, 5U) << "two bones, the same drilled, the report";
  EXPECT_GE(pictures, 1U);
}

// Import without identity keeps no study either.
TEST_F(DicomCommand, Hazard19WhatWasNotKeptIsNotTold) {
  test::write_dicom_series(folder_ / "ct", test::ellipsoid_ct());
  (void)run_program({"import", folder_ / "ct", "-o", folder_ / "knee.arthro", "--bone", "femur", "--side",
                     "right", "--threshold", "300", "--without-identity"});
  EXPECT_FALSE(fs::exists(folder_ / "knee.arthro/study.json"));
  const auto result = run("out");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("a new one was made"));
}

TEST_F(DicomCommand, TheSameCaseGivesTheSameBytes) {
  take_phantom();
  ASSERT_EQ(run("a").exit_code, 0);
  ASSERT_EQ(run("b").exit_code, 0);
  const auto written = contents_of(folder_ / "a");
  EXPECT_EQ(written.size(), 9U);
  EXPECT_EQ(written, contents_of(folder_ / "b"));
}

// What goes into the archive is told as `plan --export` tells it: a tunnel out through the joint surface, and
// bones of the other knee.
TEST_F(DicomCommand, TellsAPlanThatIsWrong) {
  take_phantom();
  const fs::path folder = folder_ / "knee.arthro";
  cases::Case knee = cases::load_case(folder);
  knee.plan.tunnels.at(bones::BoneKind::Femur).direction =
      Eigen::Vector3d(-0.77, 0.3, 0.44).normalized();  // out at the back
  cases::save_case(folder, knee);
  const auto wrong = run("wrong");
  EXPECT_EQ(wrong.exit_code, 0) << wrong.errors;
  EXPECT_THAT(wrong.output,
              HasSubstr("Wrong, and written all the same: femur: Exit: through the joint surface"));
  cases::save_bone_doubts(
      folder, {{bones::BoneKind::Femur,
                {cases::SideDoubt{cases::SideWitness::Fibula, bones::Side::Left, bones::Side::Right}}}});
  const auto other = run("other");
  EXPECT_EQ(other.exit_code, 4);
}

// A case that nobody operated on yet has pictures, too: of its plan.
TEST_F(DicomCommand, PicturesShowThePlan) {
  take_phantom();
  fs::remove_all(folder_ / "knee.arthro/pictures");
  ASSERT_EQ(run("out").exit_code, 0);
  for (const char* name : {"image_001.dcm", "image_002.dcm"}) {
    DcmFileFormat picture;
    ASSERT_TRUE(picture.loadFile((folder_ / "out" / name).c_str()).good()) << name;
    EXPECT_EQ(text(*picture.getDataset(), DCM_SOPClassUID), UID_SecondaryCaptureImageStorage);
    EXPECT_EQ(text(*picture.getDataset(), DCM_Columns), "1024");
  }
  EXPECT_FALSE(fs::exists(folder_ / "out" / "image_003.dcm"));
}

// F12 puts screenshots into the case's screens: these are what a real operation has.
TEST_F(DicomCommand, ScreenshotsArePicturesOfTheOperation) {
  take_phantom();
  fs::create_directory(folder_ / "knee.arthro/screens");
  scene::write_png(folder_ / "knee.arthro/screens/20260131-120000.png",
                   {.width = 3, .height = 1, .rgb = {255, 0, 0, 0, 0, 255, 0, 255, 0}});
  test::write_file(folder_ / "knee.arthro/screens/20260131-120001.mkv", "a video is no picture");
  ASSERT_EQ(run("out").exit_code, 0);
  const auto columns_of = [&](const char* name) {
    DcmFileFormat picture;
    return picture.loadFile((folder_ / "out" / name).c_str()).good()
               ? text(*picture.getDataset(), DCM_Columns)
               : std::string("(none)");
  };
  EXPECT_EQ(columns_of("image_003.dcm"), "3");
  EXPECT_EQ(columns_of("image_004.dcm"), "2");
  EXPECT_EQ(columns_of("image_005.dcm"), "(none)");
  ASSERT_EQ(run("nobody", {"--deidentified"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "nobody/image_001.dcm"));
}

// Hazard 40: what is sent is of the moment of the last operation, whatever was practised since.
TEST_F(DicomCommand, Hazard40AnExerciseDatesNothing) {
  take_phantom();
  const auto add_session = [&](const char* name, const std::string& source) {
    const fs::path session = folder_ / "knee.arthro/sessions" / name;
    fs::create_directories(session);
    recording::SessionHeader header;
    header.id = name;
    header.source_kind = sources::SourceKind::Simulation;
    header.source = source;
    pipeline::PipelineOptions options;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    options.tools = tools::standard_tools();
    recording::SessionRecorder(session, header, options).finish();
  };
  const auto comments = [&](const char* folder) {
    DcmFileFormat picture;
    EXPECT_TRUE(picture.loadFile((folder_ / folder / "image_003.dcm").c_str()).good());
    return text(*picture.getDataset(), DCM_ImageComments);
  };
  ASSERT_EQ(run("none").exit_code, 0);
  EXPECT_THAT(comments("none"), HasSubstr("Picture of the operation"));
  add_session("0001-20260131-120000", "an operation");
  ASSERT_EQ(run("before").exit_code, 0);
  EXPECT_THAT(comments("before"), HasSubstr("SIMULATION")) << "nobody's knee in a hospital's archive";
  add_session("0002-20260315-080000", std::string(sources::kExerciseSource));
  ASSERT_EQ(run("after").exit_code, 0);
  EXPECT_EQ(contents_of(folder_ / "before"), contents_of(folder_ / "after"));
}

// By the validator of David Clunie's dicom3tools (installer/debian/packages.txt): no error in any object.
TEST_F(DicomCommand, EveryObjectIsWhatTheStandardAsksFor) {
  take_phantom();
  ASSERT_EQ(run("out").exit_code, 0);
  ASSERT_EQ(run("nobody", {"--deidentified"}).exit_code, 0);
  for (const char* output : {"out", "nobody"}) expect_as_the_standard_asks(output);
}

// And of a hospital whose images are not: each attribute that is taken over is too long, or of another form.
// In ASCII and one alphabet, as dciodvfy counts bytes of the whole value where the standard counts characters
// of an alphabet (dicom_export_test.cpp has those).
TEST_F(DicomCommand, WhatImagesSayAgainstTheStandardIsNotPassedOn) {
  test::DicomSeriesForm form;
  form.patient.name = std::string(80, 'M') + "^Anna^b^c^d^e^f";
  form.patient.birth_date = "1990.01.31";
  form.origin.study_id = "KNEE-678901234567";
  form.origin.accession_number = "A-08150815081508150815";
  form.origin.referring_physician = "Dr\\House^" + std::string(80, 'x');
  form.origin.study_date = "20260230";
  form.origin.study_time = "08:15:00";
  form.origin.patient_sex = "female";
  import_ct(form);
  const auto result = run("out");
  ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
  for (const char* name : {"PatientName", "PatientBirthDate", "PatientSex", "StudyDate", "StudyTime",
                           "StudyID", "AccessionNumber", "ReferringPhysicianName"})
    EXPECT_THAT(result.output, HasSubstr(std::string(name) + " is not as DICOM allows"));
  for (const char* word : {"MMMM", "female", "0815"})
    EXPECT_THAT(result.output, Not(HasSubstr(word))) << "what is said names nobody";
  expect_as_the_standard_asks("out");
  DcmFileFormat report;
  ASSERT_TRUE(report.loadFile((folder_ / "out/report.dcm").c_str()).good());
  EXPECT_EQ(text(*report.getDataset(), DCM_StudyInstanceUID), form.origin.study_uid);
  EXPECT_EQ(text(*report.getDataset(), DCM_PatientID), form.patient.id);
  EXPECT_EQ(text(*report.getDataset(), DCM_StudyID), "KNEE-67890123456");
}

TEST_F(DicomCommand, RefusesATakenFolderAndWhatIsNoCase) {
  take_phantom();
  fs::create_directory(folder_ / "out");
  test::write_file(folder_ / "out/letter.txt", "Dear colleague");
  const auto taken = run("out");
  EXPECT_EQ(taken.exit_code, 3);
  EXPECT_THAT(taken.errors, HasSubstr("exists and is not empty"));
  EXPECT_EQ(contents_of(folder_ / "out").size(), 1U);
  const auto none = run_program({"dicom", folder_ / "none.arthro", "-o", folder_ / "new"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.errors, HasSubstr("none.arthro"));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
  // A study that was spoilt is told, not left out.
  test::write_file(folder_ / "knee.arthro/study.json", "{\"format\": \"arthronaut.study\", \"version\": 2}");
  const auto newer = run("new");
  EXPECT_EQ(newer.exit_code, 3);
  EXPECT_THAT(newer.errors, HasSubstr("study.json"));
  EXPECT_FALSE(fs::exists(folder_ / "new"));
}

}  // namespace
}  // namespace arthronaut
