#include "planning/library/case_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planning/cases/case.h"
#include "planning/cases/case_note.h"
#include "planning/cases/identity.h"
#include "planning/geometry/error.h"
#include "planning/library/case_record_json.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

using ::testing::HasSubstr;

class CaseRecordTest : public ::testing::Test {
 protected:
  [[nodiscard]] CaseRecord read() const {
    return read_case_record(knee_, [this](const std::filesystem::path& session) {
      SessionFacts facts;
      facts.id = session.filename();
      facts.is_exercise = exercises_.contains(facts.id);
      return facts;
    });
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path knee_ = folder_ / "Knee.arthro";
  std::set<std::string> exercises_;
};

TEST_F(CaseRecordTest, SaysWhatTheFolderHolds) {
  test::make_case(knee_, {.name = "Knie Ä", .side = "right"});
  cases::save_note_over(knee_, "revision?", "");
  for (const char* session : {"0002-20260201-120000", "0001-20260131-120000"})
    std::filesystem::create_directories(knee_ / "sessions" / session);
  const CaseRecord record = read();
  EXPECT_EQ(record.name, "Knie Ä");
  EXPECT_EQ(record.side, bones::Side::Right);
  EXPECT_EQ(record.created_utc, "2026-01-31T12:00:00Z");
  EXPECT_THAT(record.bones, ::testing::ElementsAre(bones::BoneKind::Femur, bones::BoneKind::Tibia));
  EXPECT_THAT(record.planned, ::testing::ElementsAre(bones::BoneKind::Femur));
  EXPECT_EQ(record.plan_in_words(), "femur planned, tibia not");
  EXPECT_FALSE(record.is_planned_whole());
  EXPECT_EQ(record.note, "revision?");
  ASSERT_EQ(record.sessions.size(), 2U);
  EXPECT_EQ(record.sessions[0].id, "0001-20260131-120000") << "oldest first";
  EXPECT_EQ(record.state(), CaseState::Navigated);
}

// Hazard 40: an exercise is no session that is counted, shown as the last, or trended.
TEST_F(CaseRecordTest, Hazard40ExercisesDoNotCount) {
  test::make_case(knee_);
  for (const char* session : {"0001-20260131-120000", "0002-20260201-120000"})
    std::filesystem::create_directories(knee_ / "sessions" / session);
  exercises_ = {"0002-20260201-120000"};
  ASSERT_EQ(read().sessions.size(), 1U);
  EXPECT_EQ(read().last_session()->id, "0001-20260131-120000");
  exercises_.insert("0001-20260131-120000");
  EXPECT_EQ(read().state(), CaseState::Planned) << "nobody navigated";
}

// A case as save_case() writes it, which the made ones imitate.
TEST_F(CaseRecordTest, ReadsWhatIsSavedByTheCase) {
  cases::Case knee;
  knee.name = "Saved";
  knee.side = bones::Side::Left;
  cases::save_case(knee_, knee);
  const CaseRecord record = read();
  EXPECT_EQ(record.problem, "");
  EXPECT_EQ(record.name, "Saved");
  EXPECT_EQ(record.state(), CaseState::NotPlanned);
}

TEST_F(CaseRecordTest, ABrokenCaseIsUnreadableWithItsReason) {
  test::make_case(knee_);
  test::write_text(knee_ / "case.json", R"({"format": "arthronaut.case", "version": 99})");
  const CaseRecord record = read();
  EXPECT_EQ(record.state(), CaseState::Unreadable);
  EXPECT_THAT(record.problem, HasSubstr("case.json"));
  EXPECT_EQ(record.name, "Knee") << "the folder's name stands for it";
}

// A broken note or comparison made the whole case unreadable, and its sessions were in no trend and no
// cohort.
TEST_F(CaseRecordTest, ABrokenPartTakesNothingElseAway) {
  for (const char* part : {"achieved.json", "note.json"}) {
    SCOPED_TRACE(part);
    const std::filesystem::path knee = folder_ / (std::string(part) + ".arthro");
    test::make_case(knee);
    std::filesystem::create_directories(knee / "sessions/0001-20260131-120000");
    test::write_text(knee / part, "{");
    const CaseRecord record = read_case_record(knee, [](const std::filesystem::path& session) {
      SessionFacts facts;
      facts.id = session.filename();
      return facts;
    });
    EXPECT_EQ(record.problem, "");
    EXPECT_THAT(record.part_problem, HasSubstr(part));
    EXPECT_EQ(record_from(to_json(record)).part_problem, record.part_problem);
    EXPECT_EQ(record.sessions.size(), 1U);
    EXPECT_EQ(record.state(), CaseState::Navigated);
    EXPECT_EQ(record.plan_in_words(), "femur planned, tibia not");
  }
}

TEST_F(CaseRecordTest, AFolderThatIsGoneIsMissing) {
  const CaseRecord record = read();
  EXPECT_FALSE(record.is_there);
  EXPECT_EQ(record.state(), CaseState::Missing);
  EXPECT_EQ(fingerprint_of(knee_), 0);
}

TEST_F(CaseRecordTest, ReadsWhatTheComparisonFound) {
  test::make_case(knee_);
  test::write_text(knee_ / "achieved.json", R"({"format": "arthronaut.achieved", "version": 1, "bones": [],
    "tunnels": [{"bone": "femur", "offset_mm": 1.5, "angle_deg": 2.5, "diameter_mm": 9, "reliable": true},
                {"bone": "tibia", "offset_mm": null, "angle_deg": null, "diameter_mm": null, "reliable": false},
                {"bone": "tibia", "bundle": "am", "offset_mm": 1, "angle_deg": 2, "diameter_mm": 7, "reliable": false,
                 "reliable_quantities": ["entry", "direction"]}]})");
  const CaseRecord record = read();
  ASSERT_EQ(record.postoperative.size(), 3U);
  EXPECT_TRUE(record.postoperative[2].is_known(tunnels::Quantity::Entry));
  EXPECT_FALSE(record.postoperative[2].is_known(tunnels::Quantity::Diameter));
  EXPECT_TRUE(record.postoperative[0].is_known(tunnels::Quantity::Diameter));
  EXPECT_EQ(record.postoperative[0].entry_offset_mm, 1.5);
  EXPECT_TRUE(record.postoperative[0].is_reliable);
  EXPECT_FALSE(record.postoperative[1].entry_offset_mm.has_value());
  EXPECT_EQ(record.state(), CaseState::Drilled);
}

// Hazard 19: the patient's name stands in identity.json alone; what the library keeps does not hold it.
TEST_F(CaseRecordTest, Hazard19DoesNotNameThePatient) {
  test::make_case(knee_);
  const auto before = fingerprint_of(knee_);
  cases::save_identity(knee_, {"Muster^Anna", "4711", "19900131"});
  const CaseRecord record = read();
  EXPECT_EQ(record.name + record.note + record.problem, "Knee 1");
  EXPECT_EQ(fingerprint_of(knee_), before) << "nor does it look at that file";
}

// Whatever is read changes the fingerprint; what is not does not.
TEST_F(CaseRecordTest, TheFingerprintFollowsEveryFileThatIsRead) {
  test::make_case(knee_);
  std::int64_t last = fingerprint_of(knee_);
  ASSERT_NE(last, 0);
  const auto expect_changed = [&](const std::string& what) {
    const std::int64_t now = fingerprint_of(knee_);
    EXPECT_NE(now, last) << what;
    last = now;
  };
  EXPECT_EQ(fingerprint_of(knee_), last);
  test::write_text(knee_ / "plan.json", "{}");
  expect_changed("plan");
  cases::save_note_over(knee_, "x", "");
  expect_changed("note");
  std::filesystem::create_directories(knee_ / "sessions" / "0001-20260131-120000");
  expect_changed("session");
  test::write_text(knee_ / "sessions" / "0001-20260131-120000" / "achieved.json", "{}");
  expect_changed("a file of a session");
  test::write_text(knee_ / "sessions" / "0001-20260131-120000" / "session.sqlite", "1");
  expect_changed("the record");
  std::ofstream(knee_ / "sessions" / "0001-20260131-120000" / "session.sqlite", std::ios::app) << "2";
  expect_changed("the record grows");
  test::write_text(knee_ / "femur.ply", "a mesh");
  EXPECT_EQ(fingerprint_of(knee_), last) << "meshes are not read";
}

TEST(SessionFactsTest, TellItsOutcomeInWords) {
  SessionFacts facts;
  EXPECT_EQ(facts.outcome(), "not registered, cut off");
  facts.was_finished = true;
  EXPECT_EQ(facts.outcome(), "not registered");
  facts.registration_is_reliable = false;
  EXPECT_EQ(facts.outcome(), "registration not reliable");
  facts.registration_is_reliable = true;
  EXPECT_EQ(facts.outcome(), "registered, not drilled");
  facts.is_drilled_by_word = true;
  EXPECT_EQ(facts.outcome(), "registered, drilled by word alone");
  facts.entry_offset_mm = 1.24;
  facts.angle_deg = 0.8;
  EXPECT_EQ(facts.outcome(), "drilled, 1.2 mm and 0.8\u00B0 from the plan");
}

// Beside the outcome: what it was, as far as it is known, and each doubt once.
TEST(SessionFactsTest, TellWhatItWasAndWhatIsDoubtful) {
  SessionFacts facts;
  EXPECT_EQ(facts.what(), "");
  EXPECT_TRUE(facts.doubts().empty()) << "that it was cut off stands in the outcome";
  facts.bone = bones::BoneKind::Tibia;
  facts.source_kind = "simulation";
  facts.length_min = 2.04;
  EXPECT_EQ(facts.what(), "simulation, tibia, 2.0 min");
  facts.is_exercise = true;
  EXPECT_EQ(facts.what(), "exercise, tibia, 2.0 min");
  facts.length_min = 0.06;
  EXPECT_EQ(facts.what(), "exercise, tibia, 4 s") << "and not 0.1 min";
  facts.entry_offset_mm = 1;
  facts.alarm_count = 1;
  EXPECT_EQ(facts.doubts(), (std::vector<std::string>{"not registered", "1 alarm", "cut off"}));
  facts.registration_is_reliable = facts.was_finished = true;
  EXPECT_EQ(facts.doubts(), (std::vector<std::string>{"not verified", "1 alarm"}));
  EXPECT_TRUE(facts.is_in_doubt());
  facts.was_verified = true;
  facts.alarm_count = 0;
  EXPECT_TRUE(facts.doubts().empty());
  EXPECT_FALSE(facts.is_in_doubt());
  facts.registration_is_reliable = false;
  facts.entry_offset_mm.reset();
  EXPECT_TRUE(facts.doubts().empty()) << "it stands in the outcome";
  EXPECT_TRUE(facts.is_in_doubt());
  facts.registration_is_reliable = true;
  facts.entry_offset_mm = 1;
  facts.problem = "/knees/a.arthro/sessions/0001/session.json: version: is 99";
  CaseRecord record;
  record.folder = "/knees/a.arthro";
  record.is_there = true;
  record.sessions = {facts};
  record.sessions[0].entry_offset_mm.reset();
  EXPECT_EQ(record.last_outcome(), "cannot be read: sessions/0001/session.json: version: is 99");
  facts.problem = "session.json: version: is 99";
  EXPECT_EQ(facts.doubts(), (std::vector<std::string>{"cannot be read whole: session.json: version: is 99"}));
}

// Two programs write a note: the second is told, and nothing is lost.
TEST_F(CaseRecordTest, ANoteIsNotWrittenOverAnother) {
  test::make_case(knee_);
  cases::save_note_over(knee_, "first", "");
  EXPECT_THROW(cases::save_note_over(knee_, "second", ""), InvalidInput);
  EXPECT_EQ(cases::load_note(knee_).text, "first");
  cases::save_note_over(knee_, "second", "first");
  EXPECT_EQ(cases::load_note(knee_).text, "second");
  const auto rights = std::filesystem::status(cases::note_file(knee_)).permissions();
  EXPECT_EQ(rights, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  cases::save_note_over(knee_, "", "second");
  EXPECT_FALSE(std::filesystem::exists(cases::note_file(knee_)));
  EXPECT_THROW(cases::save_note_over(folder_ / "none", "x", ""), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::library
