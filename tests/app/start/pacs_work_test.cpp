#include "app/start/pacs_work.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::start {
namespace {

namespace fs = std::filesystem;
using State = PacsNews::State;
using Kind = PacsJob::Kind;
using ::testing::HasSubstr;

class PacsWorkTest : public ::testing::Test {
 protected:
  [[nodiscard]] PacsPeer known(const test::Orthanc& orthanc) const {
    return {.name = "Orthanc", .peer = orthanc.peer(), .connection = test::quick_connection()};
  }
  // As the window polls it.
  static PacsNews finished(PacsWork& work) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(3);
    while (work.is_busy() && std::chrono::steady_clock::now() < until) {
      (void)work.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return work.news();
  }
  const test::TemporaryFolder folder_;
};

TEST_F(PacsWorkTest, AsksFindsAndFetches) {
  const test::Orthanc orthanc;
  test::write_and_send(orthanc, folder_ / "made");
  std::atomic<int> woken = 0;
  PacsWork work([&] { ++woken; });
  EXPECT_EQ(work.news().state, State::Idle);
  work.start({.kind = Kind::Echo, .peer = known(orthanc)});
  EXPECT_TRUE(work.is_busy());
  PacsNews news = finished(work);
  EXPECT_EQ(news.state, State::Done);
  EXPECT_THAT(news.words, HasSubstr("answers"));
  EXPECT_GT(woken, 0);

  work.start({.kind = Kind::Find, .peer = known(orthanc), .keys = {.patient_id = "4711"}});
  news = finished(work);
  ASSERT_EQ(news.state, State::Done) << news.words;
  ASSERT_EQ(news.found.patients.size(), 1U);
  const pacs::FoundStudy& study = news.found.patients[0].studies.at(0);

  // Stopped, and gone on with: nothing is fetched twice, and the folder appears with the last image.
  const fs::path got = fetched_folder(folder_.path(), study.series.at(0));
  const PacsJob fetch{
      .kind = Kind::Fetch,
      .peer = known(orthanc),
      .request = {.series_uid = study.series.at(0).uid, .study_uid = study.uid, .folder = got}};
  work.start(fetch);
  while (work.is_busy() && work.news().progress.done < 5) (void)work.poll();
  work.cancel();
  news = finished(work);
  ASSERT_EQ(news.state, State::Stopped) << news.words;
  EXPECT_FALSE(fs::exists(got));
  work.start(fetch);
  news = finished(work);
  ASSERT_EQ(news.state, State::Done) << news.words;
  EXPECT_GE(news.retrieved.kept_count, 5);
  EXPECT_EQ(test::pixels_of(got), test::pixels_of(folder_ / "made"));
}

// While nobody answers it says so, and which try it is; not that it goes on as before.
TEST_F(PacsWorkTest, SaysThatItTriesAgain) {
  PacsPeer nobody{.name = "Nobody",
                  .peer = {.ae_title = "NOBODY", .host = "127.0.0.1", .port = 1},
                  .connection = test::quick_connection()};
  nobody.connection.first_pause_s = 0.2;
  std::set<std::string> said;
  PacsWork work([] {});
  work.start({.kind = Kind::Find, .peer = nobody, .keys = {.patient_id = "4711"}});
  while (work.is_busy()) {
    said.insert(work.news().words);
    (void)work.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_THAT(said, ::testing::Contains(
                        ::testing::AllOf(HasSubstr("cannot be reached"), HasSubstr("tried again, 1 of 2"))));
  EXPECT_THAT(said, ::testing::Contains(HasSubstr("tried again, 2 of 2")));
  EXPECT_EQ(work.news().state, State::Failed);
  EXPECT_THAT(work.news().words, HasSubstr("tried 3 times"));
}

// The same over DICOMweb: asked, sent, found and fetched; what the server says it has stored is done.
TEST_F(PacsWorkTest, DoesTheSameOverDicomWeb) {
  const test::Orthanc orthanc({.offers_web = true});
  PacsPeer server{.name = "Web", .peer = {}, .connection = test::quick_connection()};
  server.web.url = orthanc.web_url();
  test::write_dicom_series(folder_ / "made", test::ellipsoid_ct());
  EXPECT_EQ(do_pacs_job({.kind = Kind::Echo, .peer = server}, ARTHRONAUT_PROGRAM).state, State::Done);
  PacsJob send{.kind = Kind::Send, .peer = server};
  send.files = pacs::files_to_send({folder_ / "made"});
  const PacsNews sent = do_pacs_job(send, ARTHRONAUT_PROGRAM);
  EXPECT_EQ(sent.state, State::Done) << sent.words;
  const PacsNews found =
      do_pacs_job({.kind = Kind::Find, .peer = server, .keys = {.patient_id = "4711"}}, ARTHRONAUT_PROGRAM);
  ASSERT_EQ(found.found.patients.size(), 1U) << found.words;
  const pacs::FoundStudy& study = found.found.patients[0].studies.at(0);
  const fs::path got = fetched_folder(folder_.path(), study.series.at(0));
  const PacsNews fetched =
      do_pacs_job({.kind = Kind::Fetch,
                   .peer = server,
                   .request = {.series_uid = study.series.at(0).uid, .study_uid = study.uid, .folder = got}},
                  ARTHRONAUT_PROGRAM);
  EXPECT_EQ(fetched.state, State::Done) << fetched.words;
  EXPECT_EQ(test::pixels_of(got), test::pixels_of(folder_ / "made"));
}

TEST_F(PacsWorkTest, SaysWhyNot) {
  PacsWork work([] {});
  PacsPeer nobody{.name = "Nobody", .peer = {"PACS", "127.0.0.1", test::free_port()}, .connection = {}};
  nobody.connection.retries = 0;
  work.start({.kind = Kind::Echo, .peer = nobody});
  PacsNews news = finished(work);
  EXPECT_EQ(news.state, State::Failed);
  EXPECT_THAT(news.words, HasSubstr("cannot be reached"));
  work.start({.kind = Kind::Find, .peer = nobody});
  news = finished(work);
  EXPECT_EQ(news.state, State::Failed);
  EXPECT_THAT(news.words, HasSubstr("names no patient"));
}

// What `arthronaut dicom` writes of a case, listed with whom it names, then sent.
TEST_F(PacsWorkTest, WritesListsAndSendsResults) {
  const test::Orthanc orthanc;
  const cases::Case knee =
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3}), "Knee of a test");
  cases::save_case(folder_ / "Knee.arthro", knee);
  PacsJob write{.kind = Kind::WriteResults, .peer = known(orthanc)};
  write.case_folder = folder_ / "Knee.arthro";
  write.results_folder = folder_ / "data/outgoing";
  write.is_deidentified = true;
  const PacsNews written = do_pacs_job(write, ARTHRONAUT_PROGRAM);
  ASSERT_TRUE(written.state == State::Done || written.state == State::Unreliable) << written.words;
  ASSERT_FALSE(written.files.empty());
  std::set<std::string> titles;
  for (const pacs::SentFile& file : written.files) {
    titles.insert(file.title);
    EXPECT_EQ(file.patient_id, written.files.front().patient_id);
  }
  // In words that tell one from the other.
  EXPECT_TRUE(titles.contains("Model: Femur of a right knee")) << *titles.begin();
  EXPECT_TRUE(titles.contains("Document: ACL reconstruction: plan and report"));
  EXPECT_EQ(titles.size(), written.files.size());
  // The same again takes the place of the first.
  const PacsNews again = do_pacs_job(write, ARTHRONAUT_PROGRAM);
  EXPECT_EQ(again.files.size(), written.files.size()) << again.words;
  PacsJob send{.kind = Kind::Send, .peer = known(orthanc)};
  send.files = again.files;
  const PacsNews sent = do_pacs_job(send, ARTHRONAUT_PROGRAM);
  EXPECT_EQ(sent.sent.outcome, pacs::SendSummary::Outcome::Stored) << sent.words;
  // Orthanc calls back to report, and has no port to call here: stored, but nobody has promised anything.
  EXPECT_EQ(sent.state, State::Unreliable);

  write.case_folder = folder_ / "none";
  const PacsNews refused = do_pacs_job(write, ARTHRONAUT_PROGRAM);
  EXPECT_EQ(refused.state, State::Failed);
  EXPECT_THAT(refused.words, HasSubstr("none"));
  EXPECT_FALSE(fs::exists(write.results_folder));
}

TEST(PacsFetchedFolder, IsTheSeriesOwn) {
  pacs::FoundSeries series;
  series.uid = "1.2.3";
  series.modality = "../CT";
  const fs::path folder = fetched_folder("/data", series);
  EXPECT_EQ(folder.parent_path(), "/data/fetched");
  EXPECT_TRUE(folder.filename().string().starts_with("CT-"));
  EXPECT_EQ(fetched_folder("/data", series), folder);
  series.uid = "1.2.4";
  EXPECT_NE(fetched_folder("/data", series), folder);
}

}  // namespace
}  // namespace arthronaut::start
