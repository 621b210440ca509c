// From nothing to an open case, as a hand works it: the start, the browser of folders, the import.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "planning/bones/mesh_file.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/cases/identity.h"
#include "planning/images/volume_writer.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/display.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

class StartWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
  }
  static cases::Case knee() {
    return phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee of a test");
  }
  // Takes seconds to open: its landmarks are looked for.
  static cases::Case slow_knee() {
    cases::Case slow = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 0.8}), "Slow knee");
    slow.landmarks.clear();
    return slow;
  }
  void write_meshes() const {
    std::filesystem::create_directory(folder_ / "given");
    const cases::Case made = knee();
    for (const auto& [kind, bone] : made.bones)
      bones::write_mesh_stl(folder_ / "given" / (std::string(bones::to_text(kind)) + ".stl"), bone.mesh);
  }
  const TemporaryFolder folder_;
};

// A case that takes long to open is left by Esc: the start is there again, with nothing to complain of, and
// the case can be opened then.
TEST_F(StartWindow, AnOpeningIsStoppedByEsc) {
  cases::save_case(folder_ / "Slow.arthro", slow_knee());
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Slow.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "opening", 120));
  ASSERT_TRUE(app.wait_for_widget("app.stop_opening"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("case", "none", 60));
  EXPECT_EQ(app.state("screen"), "start");
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(60), 0);
  EXPECT_TRUE(cases::CaseLock(folder_ / "Slow.arthro").is_held()) << "it holds the case no longer";
}

// A folder with two meshes: named on the command line, looked into, made, the side asked for, written, open.
// Next time the case is the first of the list, and Enter opens it.
TEST_F(StartWindow, ImportsAFolderAsksForTheSideAndFindsTheCaseAgain) {
  write_meshes();
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path(), {(folder_ / "given").string()});
    ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
    EXPECT_EQ(app.state("case"), "none");
    ASSERT_TRUE(app.wait_for_widget("start.source.1"));
    EXPECT_FALSE(app.widgets().contains("start.left")) << "the side is asked for once, with a picture";
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("import", "asking", 240));
    EXPECT_TRUE(app.wait_for_state("made_bones", "shown"));
    ASSERT_TRUE(app.wait_for_widget("start.sketch_left"));
    for (const char* side : {"left", "right"}) {
      const Area sketch = app.widgets().at(std::string("start.sketch_") + side),
                 words = app.widgets().at(std::string("start.sketch_words_") + side);
      EXPECT_GE(words.x, sketch.x) << side;
      EXPECT_LE(words.x + words.width, sketch.x + sketch.width) << side;
    }
    // The shapes alone told a side: Enter does not pass that by.
    ASSERT_TRUE(app.state("import_side").starts_with("look: ")) << app.state("import_side");
    app.press("Return");
    app.press("l");
    ASSERT_TRUE(app.wait_for_state("import_side", "good: left, as you say") ||
                app.state("import_side").starts_with("look: left, as you say"));
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("case", "open", 240));
    ASSERT_TRUE(app.wait_for_state("screen", "mode"));
    ASSERT_TRUE(app.wait_for_state("mode", "plan"));
    app.press("ctrl+q");
    EXPECT_EQ(app.wait_for_exit(30), 0);
  }
  std::filesystem::path made;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "arthronaut" / "cases"))
    made = entry.path();
  EXPECT_EQ(cases::load_case(made).side, bones::Side::Left);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
  ASSERT_TRUE(app.wait_for_widget("start.case.0"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_EQ(app.state("screen"), "mode");
}

// By keys alone through the folders to a case; F5 and Esc go to the list and back; another case takes the
// place of the first, whose name is gone as soon as the other is being opened.
TEST_F(StartWindow, FindsACaseInTheFoldersByKeys) {
  std::filesystem::create_directory(folder_ / "cases");
  cases::save_case(folder_ / "cases" / "A.arthro", slow_knee());
  cases::save_case(folder_ / "cases" / "B.arthro", knee());
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "cases" / "B.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("screen", "start"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("screen", "mode"));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("screen", "start"));
  app.press("o");
  ASSERT_TRUE(app.wait_for_state("start", "browse"));
  // The browser begins in the user's home, which is the test's folder.
  ASSERT_TRUE(app.wait_for_widget("start.entry.cases"));
  const auto select = [&](const std::string& entry) {
    app.click("start.entry." + entry);
    ASSERT_TRUE(app.wait_for_state("selected", entry));
  };
  select("cases");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_widget("start.entry.A.arthro"));
  app.press("Down");
  ASSERT_TRUE(app.wait_for_state("selected", "B.arthro"));
  app.press("Up");
  ASSERT_TRUE(app.wait_for_state("selected", "A.arthro"));
  EXPECT_NE(app.state("whose"), "");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("case", "opening"));
  EXPECT_EQ(app.state("whose"), "");
  ASSERT_TRUE(app.wait_for_state("folder", (folder_ / "cases" / "A.arthro").string(), 120));
  EXPECT_EQ(app.state("case"), "open");
}

// Where nothing is planned there is nothing to look back at: such a case opens in Plan, another one in the
// mode that is open.
TEST_F(StartWindow, ACaseWithoutAPlanOpensInPlan) {
  cases::Case bare = knee();
  bare.plan = {};
  cases::save_case(folder_ / "Planned.arthro", knee());
  cases::save_case(folder_ / "Other.arthro", knee());
  cases::save_case(folder_ / "Bare.arthro", bare);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "Planned.arthro").string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  for (const auto& [name, mode] : {std::pair("Other.arthro", "review"), std::pair("Bare.arthro", "plan")}) {
    app.press("F3");
    ASSERT_TRUE(app.wait_for_state("mode", "review"));
    app.press("F5");
    ASSERT_TRUE(app.wait_for_state("start", "cases"));
    app.press("o");
    ASSERT_TRUE(app.wait_for_state("start", "browse"));
    app.press("ctrl+l");
    ASSERT_TRUE(app.wait_for_widget("start.entry_path"));
    app.type((folder_ / name).string());
    ASSERT_TRUE(app.wait_for_state("typed_path", (folder_ / name).string(), 10));
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("folder", (folder_ / name).string(), 120));
    EXPECT_TRUE(app.wait_for_state("mode", mode, 10)) << app.state("mode");
  }
}

// A whole path that is typed or pasted takes the place of the folder that stands in the field, also the
// second time; what was not there is mended instead.
TEST_F(StartWindow, ATypedPathTakesThePlaceOfWhatStandsThere) {
  for (const char* name : {"one", "two", "three"}) std::filesystem::create_directories(folder_ / "at" / name);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {"--frames", "0"});
  ASSERT_TRUE(app.wait_for_state("start", "cases", 60));
  app.press("o");
  ASSERT_TRUE(app.wait_for_state("start", "browse"));
  const std::string at = (folder_ / "at").string();
  const auto typed = [&](const std::string& text) {
    app.press("ctrl+l");
    EXPECT_TRUE(app.wait_for_widget("start.entry_path"));
    app.type(text);
    return app.wait_for_state("typed_path", text, 10);
  };
  for (const char* name : {"/one", "/two"}) {
    ASSERT_TRUE(typed(at + name)) << app.state("typed_path");
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("typed_path", ""));
  }
  ASSERT_TRUE(typed(at + "/thre"));
  app.press("Return");
  ASSERT_TRUE(
      app.wait_for_state("typed_problem", "There is no " + at + "/thre. As far as " + at + " it is there"));
  app.type("e");
  EXPECT_TRUE(app.wait_for_state("typed_path", at + "/three", 10)) << app.state("typed_path");
}

// Hazard 15: what writes into a case is not in front of one that another program has open.
TEST_F(StartWindow, Hazard15SetUpDoesNotStandOnAReadOnlyCase) {
  const auto mine = folder_ / "arthronaut" / "cases" / "Mine.arthro";
  const auto theirs = folder_ / "arthronaut" / "cases" / "Theirs.arthro";
  cases::Case made = knee();
  for (const auto& folder : {mine, theirs}) {
    made.name = folder.stem();
    cases::save_case(folder, made);
  }
  const cases::CaseLock lock(theirs);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {mine.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F4");
  ASSERT_TRUE(app.wait_for_state("mode", "set up"));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("cases_listed", "2"));
  app.press("f");
  app.type("theirs");
  ASSERT_TRUE(app.wait_for_state("case_selected", "Theirs"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("typing", "no"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("access", "read-only", 120));
  EXPECT_TRUE(app.wait_for_state("mode", "plan"));
  // Nor does it lead to a click that could change nothing.
  app.press("p");
  EXPECT_TRUE(app.wait_for_state("untaken_key", "P did nothing: there is nothing for it now"));
  EXPECT_EQ(app.state("placing"), "nothing");
}

// An import that waits for an answer is found again from any mode.
TEST_F(StartWindow, AnImportThatAsksIsNotLost) {
  write_meshes();
  const auto open = folder_ / "Knee.arthro";
  cases::save_case(open, knee());
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {open.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F5");
  app.press("o");
  ASSERT_TRUE(app.wait_for_widget("start.entry.given"));
  app.click("start.entry.given");
  ASSERT_TRUE(app.wait_for_state("selected", "given"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_widget("start.entry.femur.stl"));
  app.press("i");
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("import", "asking", 240));
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("screen", "mode"));
  app.press("F5");
  ASSERT_TRUE(app.wait_for_state("screen", "start"));
  EXPECT_TRUE(app.wait_for_state("import", "asking"));
}

// The volume that somebody clicks on, or goes to by the arrows, is the one that is taken: what is made next
// is made of it, and of no other.
TEST_F(StartWindow, TheVolumeThatIsGoneToIsTaken) {
  std::filesystem::create_directory(folder_ / "given");
  images::Volume volume;
  volume.size = {24, 24, 12};
  volume.values.assign(24 * 24 * 12, 100);
  for (const char* name : {"first.nrrd", "second.nrrd"})
    images::write_volume(folder_ / "given" / name, volume);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "given").string()});
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
  ASSERT_TRUE(app.wait_for_widget("start.source.1"));
  const auto taken_beside = [&](const std::string& title) {
    for (int i = 0; i < 250 && app.state("taken") == title; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return app.state("taken");
  };
  const std::string first = app.state("taken");
  app.click(app.state("selected") == "0" ? "start.source.1" : "start.source.0");
  const std::string second = taken_beside(first);
  EXPECT_NE(second, first);
  app.press("space");  // it is taken, and stays so
  app.press(app.state("selected") == "0" ? "Down" : "Up");
  EXPECT_EQ(taken_beside(second), first);
}

// Images of a patient whose case has a plan: one key opens that case, and compares them with its plan.
TEST_F(StartWindow, ImagesOfAPatientWithAPlanAreComparedWithIt) {
  const std::filesystem::path hers = folder_ / "arthronaut/cases/hers.arthro";
  cases::save_case(hers, knee());
  cases::save_identity(hers, {"Muster^Anna", "4711", "19900131"});
  write_dicom_series(folder_ / "after", ellipsoid_ct());
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "after").string()});
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
  ASSERT_TRUE(app.wait_for_state("planned_case", "hers.arthro"));
  ASSERT_TRUE(app.wait_for_widget("start.compare"));
  app.press("a");
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  ASSERT_TRUE(app.wait_for_state("mode", "review"));
  EXPECT_TRUE(app.wait_for_state("review_page", "achieved"));
  EXPECT_NE(app.state("postop"), "none");
}

// A femur in metres whose name says nothing: F says what it is, M its unit, and the bones are made.
TEST_F(StartWindow, AsksWhatAMeshIsAndInWhichUnit) {
  std::filesystem::create_directory(folder_ / "given");
  cases::Case made = knee();
  bones::write_mesh_stl(folder_ / "given" / "tibia.stl", made.bones.at(bones::BoneKind::Tibia).mesh);
  geometry::TriangleMesh& femur = made.bones.at(bones::BoneKind::Femur).mesh;
  for (Eigen::Vector3d& vertex : femur.vertices_mm) vertex /= 1000;
  bones::write_mesh_stl(folder_ / "given" / "part.stl", femur);
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "given").string()});
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 120));
  ASSERT_TRUE(app.wait_for_widget("start.source.0"));
  app.click("start.source.0");
  ASSERT_TRUE(app.wait_for_state("selected", "0"));
  app.press("f");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_widget("start.unit_m", 120));
  EXPECT_FALSE(app.widgets().contains("start.import")) << "there is one thing to do";
  app.press("m");
  ASSERT_TRUE(app.wait_for_state("import", "asking", 240));
}

// What is no case and holds no images is said, and the start stays.
TEST_F(StartWindow, SaysThatAFolderHoldsNothing) {
  std::filesystem::create_directory(folder_ / "empty");
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {(folder_ / "empty").string()});
  ASSERT_TRUE(app.wait_for_state("import", "choosing", 60));
  EXPECT_EQ(app.state("screen"), "start");
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("start", "cases"));
  app.press("b");
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

}  // namespace
}  // namespace arthronaut::test
