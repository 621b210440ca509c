// Review as a user works it: a recorded session on its time line, marks, and a comparison that cannot be
// made.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "navigation/recording/session_marks.h"
#include "planning/cases/case.h"
#include "planning/cases/plan_file.h"
#include "planning/files/format.h"
#include "planning/postop/achieved_file.h"
#include "tests/app/window/built_in_case.h"
#include "tests/app/window/display.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::RunningWorkstation;
using test::VirtualDisplay;

constexpr int kFrames = 180;

class ReviewWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = test::missing_for_window_tests(); !missing.empty())
      GTEST_SKIP() << missing;
    test::put_built_in_case(case_folder_);
    session_ = cases::create_session_folder(case_folder_);
    recording::SessionHeader header = test::session_header();
    header.side = bones::Side::Right;  // as the case is
    recording::SessionRecorder recorder(session_, header, test::scripted_options());
    for (int i = 0; i < kFrames; ++i) {
      recorder.append_picture(std::make_shared<camera::Frame>(test::plain_frame(i, 80)));
      recorder.append(test::frame_result(i));
      if (i == 60) recorder.add_event({test::frame_result(i).timestamp_ns, "alarm", "the marker has moved"});
    }
    recorder.finish();
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path case_folder_ = folder_ / "knee.arthro";
  std::filesystem::path session_;
};

// A session of which a table was changed is shown, and said not to be what was recorded.
TEST_F(ReviewWindow, SaysThatARecordWasChanged) {
  std::ofstream(session_ / "poses.csv", std::ios::app) << "180,3,0,1,0,0,0,1,2,3,0.1,\n";
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("review_picture", "shown"));
  EXPECT_TRUE(app.wait_for_state("record", "broken"));
  const std::string line = "session_line." + session_.filename().string();
  EXPECT_TRUE(app.state(line).starts_with("NOT AS RECORDED: poses.csv: ")) << app.state(line);
}

// The case's bone was replaced since: nothing of the session is drawn on the new one.
TEST_F(ReviewWindow, DrawsNothingOnABoneThatTheSessionWasNotOf) {
  nlohmann::json header = nlohmann::json::parse(std::ifstream(session_ / "session.json"));
  header["mesh_sha256"] = "of another surface";
  std::ofstream(session_ / "session.json") << header;
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  EXPECT_TRUE(app.wait_for_state("review_bone", "another surface"));
}

// A folder that cannot be looked into is a sentence on the screen; the workstation goes on. By key that is
// found before a frame is drawn, by a button in the middle of drawing one.
TEST_F(ReviewWindow, AFolderThatCannotBeReadEndsNothing) {
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  const auto sessions = case_folder_ / "sessions", aside = folder_ / "aside";
  std::filesystem::rename(sessions, aside);
  std::filesystem::create_symlink("sessions", sessions);  // leads to itself
  const auto fault = [&] {
    for (int i = 0; i < 100 && app.state("frame_fault").empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return app.state("frame_fault");
  };
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("mode", "review"));
  EXPECT_NE(fault().find("sessions"), std::string::npos);
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  ASSERT_TRUE(app.wait_for_state("frame_fault", "", 30));
  app.click("mode.review");
  EXPECT_NE(fault().find("sessions"), std::string::npos);
  std::filesystem::remove(sessions);
  std::filesystem::rename(aside, sessions);
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  app.press("F3");
  EXPECT_TRUE(app.wait_for_state("session", session_.filename().string()));
}

// A case in whose sessions nobody may look is opened and planned in; nothing is practised in it.
TEST_F(ReviewWindow, ACaseWhoseSessionsCannotBeReadIsOpened) {
  const auto sessions = case_folder_ / "sessions";
  std::filesystem::rename(sessions, folder_ / "aside");
  std::filesystem::create_symlink("sessions", sessions);  // leads to itself
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  EXPECT_EQ(app.state("frame_fault"), "");
  for (const auto& [key, mode] :
       {std::pair{"F6", "train"}, std::pair{"F2", "navigate"}, std::pair{"F1", "plan"}}) {
    app.press(key);
    EXPECT_TRUE(app.wait_for_state("mode", mode));
  }
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

// Opened at the last moment with guidance; by keys to the beginning, to the alarm, a frame on; a mark with a
// note is on disk, undone and made again; a click on the time line shows the frame that lies there.
TEST_F(ReviewWindow, LeadsThroughASession) {
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("session", session_.filename().string()));
  ASSERT_TRUE(app.wait_for_state("review_picture", "shown"));
  EXPECT_EQ(app.state("frame"), "177");
  ASSERT_TRUE(app.wait_for_state("record", "unbroken"));
  app.press("Home");
  ASSERT_TRUE(app.wait_for_state("frame", "0"));
  app.press("n");
  ASSERT_TRUE(app.wait_for_state("frame", "60"));
  app.press("Right");
  ASSERT_TRUE(app.wait_for_state("frame", "61"));
  ASSERT_TRUE(app.wait_for_state("review_picture", "shown"));

  app.press("m");
  ASSERT_TRUE(app.wait_for_state("note_field", "open"));
  app.type("loose here");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("marks", "1"));
  EXPECT_EQ(recording::read_marks(session_),
            (recording::SessionMarks{{61, test::frame_result(61).timestamp_ns, "loose here"}}));
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("marks", "0"));
  EXPECT_TRUE(recording::read_marks(session_).empty());
  app.press("ctrl+y");
  ASSERT_TRUE(app.wait_for_state("marks", "1"));

  // A note is of the moment that it was begun for, also where one looks at another meanwhile; and on a
  // machine that is late all of it is typed before the click that came after it.
  app.press("Right");
  ASSERT_TRUE(app.wait_for_state("frame", "62"));
  app.press("m");
  ASSERT_TRUE(app.wait_for_state("note_field", "open"));
  app.while_frozen([&] {
    app.type("before");
    app.click("review.time_line");
  });
  for (int i = 0; i < 100 && app.state("frame") == "62"; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ASSERT_NE(app.state("frame"), "62");
  app.click("review.note");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("marks", "2"));
  EXPECT_EQ(recording::read_marks(session_).at(1),
            (recording::SessionMark{62, test::frame_result(62).timestamp_ns, "before"}));
  app.press("ctrl+z");
  ASSERT_TRUE(app.wait_for_state("marks", "1"));
  app.press("Home");
  ASSERT_TRUE(app.wait_for_state("frame", "0"));
  app.press("n");
  ASSERT_TRUE(app.wait_for_state("frame", "60"));
  app.press("Right");
  ASSERT_TRUE(app.wait_for_state("frame", "61"));

  // A note that was begun is let go by Esc: nothing is kept, and keys are keys again.
  app.press("Right");
  ASSERT_TRUE(app.wait_for_state("frame", "62"));
  app.press("m");
  ASSERT_TRUE(app.wait_for_state("note_field", "open"));
  app.type("no");
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("note_field", "closed"));
  EXPECT_EQ(app.state("marks"), "1");
  app.press("period");
  ASSERT_TRUE(app.wait_for_state("speed", "2 x"));
  app.press("l");
  ASSERT_TRUE(app.wait_for_state("loop", "begun"));
  app.press("End");
  ASSERT_TRUE(app.wait_for_state("frame", std::to_string(kFrames - 1)));
  app.press("l");
  ASSERT_TRUE(app.wait_for_state("loop", "on"));

  ASSERT_TRUE(app.wait_for_widget("review.time_line"));
  const test::Area line = app.widgets().at("review.time_line");
  app.click_at(line.x + 1, line.y + line.height / 2);
  ASSERT_TRUE(app.wait_for_state("frame", "0"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

// Images that are not there: the reason stands on the screen, the case keeps nothing, and the session is one
// key away.
TEST_F(ReviewWindow, SaysWhyNothingWasCompared) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("session", session_.filename().string()));
  app.press("c");
  ASSERT_TRUE(app.wait_for_state("review_page", "achieved"));
  ASSERT_TRUE(app.wait_for_widget("review.postop_path"));
  app.type("/nowhere/ct");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("postop", "failed"));
  EXPECT_FALSE(std::filesystem::exists(case_folder_ / "achieved.json"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("review_page", "session"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

// The folder that a hospital gives, found by looking for it, holds the scan by two kernels: it is asked which
// of them is meant, and the one that is pressed is compared. No bone of this patient is in it, which the
// answer says.
TEST_F(ReviewWindow, AsksWhichOfTwoCtsIsMeant) {
  for (const char* uid : {"1.2.3.1", "1.2.3.2"}) {
    test::DicomSeriesForm form;
    form.origin.series_uid = uid;
    test::write_dicom_series(folder_ / "ct" / uid, test::ellipsoid_ct(), form);
  }
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("session", session_.filename().string()));
  app.press("o");
  ASSERT_TRUE(app.wait_for_widget("review.folder.ct"));
  app.click("review.folder.ct");
  ASSERT_TRUE(app.wait_for_state("selected", "ct"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_widget("review.folder.1.2.3.2"));
  app.press("i");
  ASSERT_TRUE(app.wait_for_state("postop", "asks", 60));
  app.click("review.postop_series_1");
  EXPECT_TRUE(app.wait_for_state("postop", "compared", 120));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

// A case without a session that keeps a comparison: Review shows it, and not that a CT might be compared. It
// makes way for the session that the user chooses.
TEST_F(ReviewWindow, ShowsTheComparisonThatACaseKeeps) {
  const auto plan = cases::load_case(case_folder_).plan.tunnels.at(bones::BoneKind::Femur);
  postop::Comparison kept;
  kept.bone.is_found = kept.bone.reliable = kept.tunnel.is_found = kept.tunnel.reliable = true;
  kept.bone.reasons.clear();
  kept.tunnel.reasons.clear();
  kept.tunnel.tunnel = plan;
  kept.tunnel.length_mm = 30;
  postop::write_achieved_file(case_folder_ / "achieved.json", {{bones::BoneKind::Femur, kept}});
  const auto aside = folder_ / "aside";
  std::filesystem::rename(session_, aside);
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  EXPECT_TRUE(app.wait_for_state("review_page", "achieved"));
  EXPECT_TRUE(app.wait_for_state("postop", "kept"));
  for (const char* const picture : {"postop_picture_0", "postop_picture_1"})
    EXPECT_TRUE(app.wait_for_state(picture,
                                   "No picture: the case keeps the comparison and not its images. Compare "
                                   "again (C) to see them."));
  // What it calls planned is the plan of now.
  const auto planned_in_words = [&] {
    const auto tunnel = cases::load_case(case_folder_).plan.tunnels.at(bones::BoneKind::Femur);
    const Eigen::Vector3d &at = tunnel.entry_mm, &along = tunnel.direction;
    return files::format("%.2f %.2f %.2f along %.3f %.3f %.3f", at.x(), at.y(), at.z(), along.x(), along.y(),
                         along.z());
  };
  const std::string before = planned_in_words();
  EXPECT_TRUE(app.wait_for_state("postop_planned", before));
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  app.press("n");
  for (int i = 0; i < 300 && planned_in_words() == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ASSERT_NE(planned_in_words(), before) << "the test needs another plan";
  app.press("F3");
  EXPECT_TRUE(app.wait_for_state("postop_planned", planned_in_words()));

  std::filesystem::rename(aside, session_);
  app.press("F1");
  ASSERT_TRUE(app.wait_for_state("mode", "plan"));
  app.press("F3");
  const std::string shown = "review.session." + session_.filename().string();
  ASSERT_TRUE(app.wait_for_widget(shown));
  app.click(shown);
  EXPECT_TRUE(app.wait_for_state("review_page", "session"));
  // What is not seen does not move: the keys of the time line are the session's.
  app.press("Home");
  ASSERT_TRUE(app.wait_for_state("frame", "0"));
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("review_page", "achieved"));
  app.press("End");
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("review_page", "session"));
  EXPECT_TRUE(app.wait_for_state("frame", "0"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

// One key gives the report that the surgeon files, of the session that is looked at, and says where it lies.
TEST_F(ReviewWindow, WritesTheReport) {
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("session", session_.filename().string()));
  app.press("r");
  ASSERT_TRUE(app.wait_for_state("report", "written", 120));
  std::ifstream report(cases::export_folder(case_folder_, cases::load_case(case_folder_).plan) /
                       ("report_" + session_.filename().string() + ".pdf"));
  std::string begins(5, ' ');
  report.read(begins.data(), 5);
  EXPECT_EQ(begins, "%PDF-");
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

// Six sessions are in sight together, and each is chosen where it stands.
TEST_F(ReviewWindow, ShowsSixSessionsAndTakesTheOneThatIsPressed) {
  std::vector<std::string> names{session_.filename().string()};
  for (int i = 0; i < 5; ++i) {
    const auto copy = cases::create_session_folder(case_folder_);
    std::filesystem::copy(
        session_, copy,
        std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
    names.push_back(copy.filename().string());
  }
  const VirtualDisplay display(1920, 1080);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  ASSERT_TRUE(app.wait_for_state("session", names.back()));
  for (const std::string& name : names)
    ASSERT_TRUE(app.wait_for_widget("review.session." + name)) << name << " is out of sight";
  for (const std::string& name : names) {
    app.click("review.session." + name);
    EXPECT_TRUE(app.wait_for_state("session", name)) << name;
  }
}

// What each session was stands in the list: how long, how far, and that nobody registered.
TEST_F(ReviewWindow, SaysWhatEachSessionWas) {
  const VirtualDisplay display(1280, 720);
  RunningWorkstation app(display, folder_.path(), {case_folder_.string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  app.press("F3");
  EXPECT_TRUE(app.wait_for_state("session_line." + session_.filename().string(),
                                 "femur, 3 s; not registered; 1 alarm"))
      << app.state("session_line." + session_.filename().string());
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
}

}  // namespace
}  // namespace arthronaut
