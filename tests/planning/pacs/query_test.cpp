#include "planning/pacs/query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "planning/geometry/error.h"
#include "tests/planning/pacs/sent_series.h"

namespace arthronaut::pacs {
namespace {

using test::quick_connection;
using ::testing::HasSubstr;
using ::testing::SizeIs;

template <typename Call>
std::string failure_of(const Call& call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(PacsEcho, IsAnswered) {
  const test::Orthanc orthanc;
  EXPECT_GT(echo(orthanc.peer(), quick_connection()), 0);
}

TEST(PacsEcho, SaysWhyNot) {
  const test::Orthanc orthanc;
  Peer other = orthanc.peer();
  other.ae_title = "OTHER";
  EXPECT_THAT(failure_of([&] { (void)echo(other, quick_connection()); }),
              HasSubstr("does not answer to the AE title OTHER"));
  Peer nobody = orthanc.peer();
  nobody.port = test::free_port();
  const std::string failure = failure_of([&] { (void)echo(nobody, quick_connection()); });
  EXPECT_THAT(failure, HasSubstr(to_text(nobody)));
  EXPECT_THAT(failure, HasSubstr("Connection refused"));
  EXPECT_THAT(failure, HasSubstr("tried 3 times"));
}

// Before the first pause has passed.
TEST(PacsEcho, StopsWhileItWaits) {
  ConnectionOptions connection = quick_connection();
  connection.retries = 100;
  connection.first_pause_s = 60;
  std::stop_source stop;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop.request_stop();
  });
  EXPECT_LT(echo({"PACS", "127.0.0.1", test::free_port()}, connection, stop.get_token()), 0);
}

// A PACS that takes a connection of everybody and a question of those that it knows alone, as Orthanc does.
TEST(PacsFind, SaysThatWeMayNotBeKnown) {
  const test::Orthanc orthanc({.knows_us = false, .answers_anybody = false});
  ConnectionOptions connection = quick_connection();
  connection.our_ae_title = "NOBODY";
  EXPECT_THAT(failure_of([&] { (void)find(orthanc.peer(), connection, {.patient_id = "4711"}); }),
              HasSubstr("ended the connection; it may not know us as NOBODY"));
}

TEST(PacsFind, TellsStudiesAndSeriesWithTheirCounts) {
  const test::Orthanc orthanc;
  const test::TemporaryFolder folder;
  test::write_and_send(orthanc, folder / "ct");
  test::DicomSeriesForm second;
  second.origin.series_uid = "1.2.826.0.1.3680043.8.498.7";
  test::write_and_send(orthanc, folder / "second", second);
  test::DicomSeriesForm other;
  other.patient = {"Anders^Otto", "4712", "19500505"};
  other.origin.study_uid = "1.2.826.0.1.3680043.8.498.100";
  other.origin.series_uid = "1.2.826.0.1.3680043.8.498.101";
  test::write_and_send(orthanc, folder / "other", other);

  const auto found = find(orthanc.peer(), quick_connection(), {.patient_id = "4711"});
  ASSERT_THAT(found.patients, SizeIs(1));
  EXPECT_FALSE(found.is_cut);
  const FoundPatient& patient = found.patients[0];
  EXPECT_EQ(patient.name, "Muster^Anna");
  EXPECT_EQ(patient.id, "4711");
  EXPECT_EQ(patient.birth_date, "19900131");
  EXPECT_EQ(patient.sex, "F");
  ASSERT_THAT(patient.studies, SizeIs(1));
  const FoundStudy& study = patient.studies[0];
  EXPECT_EQ(study.uid, "1.2.826.0.1.3680043.8.498.1");
  EXPECT_EQ(study.date, "20260130");
  EXPECT_EQ(study.accession_number, "A-0815");
  EXPECT_THAT(study.modalities, testing::ElementsAre("CT"));
  EXPECT_EQ(study.series_count, 2);
  EXPECT_EQ(study.image_count, 2 * test::kImageCount);
  ASSERT_THAT(study.series, SizeIs(2));
  EXPECT_EQ(study.series[0].uid, "1.2.826.0.1.3680043.8.498.2");
  EXPECT_EQ(study.series[0].number, "3");
  EXPECT_EQ(study.series[0].modality, "CT");
  EXPECT_EQ(study.series[0].image_count, test::kImageCount);

  EXPECT_THAT(find(orthanc.peer(), quick_connection(), {.patient_name = "*t*"}).patients, SizeIs(2));
  EXPECT_THAT(find(orthanc.peer(), quick_connection(), {.patient_id = "47*"}, {.level = FindLevel::Study})
                  .patients[0]
                  .studies[0]
                  .series,
              SizeIs(0));
  const auto patients =
      find(orthanc.peer(), quick_connection(), {.patient_id = "47*"}, {.level = FindLevel::Patient}).patients;
  ASSERT_THAT(patients, SizeIs(2));
  EXPECT_EQ(patients[0].name, "Anders^Otto");  // by name
  EXPECT_EQ(patients[0].study_count, 1);
  EXPECT_THAT(patients[0].studies, SizeIs(0));
  const auto cut = find(orthanc.peer(), quick_connection(), {.patient_id = "47*"}, {.most_studies = 1});
  EXPECT_TRUE(cut.is_cut);
  EXPECT_THAT(cut.patients, SizeIs(1));
  EXPECT_THAT(find(orthanc.peer(), quick_connection(), {.patient_id = "4711", .modality = "MR"}).patients,
              SizeIs(0));
}

// Written in one character set, answered in another, asked for in a third.
TEST(PacsFind, ReadsNationalCharacters) {
  for (const std::string encoding : {"Latin1", "Utf8"}) {
    const test::Orthanc orthanc({.encoding = encoding});
    const test::TemporaryFolder folder;
    test::DicomSeriesForm form;
    form.character_set = "ISO_IR 100";
    form.patient.name = "M\xfcller^J\xf6rg";
    test::write_and_send(orthanc, folder / "ct", form);
    const auto found = find(orthanc.peer(), quick_connection(), {.patient_name = "Müller^J*"});
    ASSERT_THAT(found.patients, SizeIs(1)) << encoding;
    EXPECT_EQ(found.patients[0].name, "Müller^Jörg") << encoding;
  }
}

TEST(PacsFind, ReadsJapaneseNames) {
  const test::Orthanc orthanc({.encoding = "Utf8"});
  const test::TemporaryFolder folder;
  test::DicomSeriesForm form;
  form.character_set = "ISO_IR 192";
  form.patient.name = "Yamada^Tarou=山田^太郎";
  test::write_and_send(orthanc, folder / "ct", form);
  const auto found = find(orthanc.peer(), quick_connection(), {.patient_id = "4711"});
  ASSERT_THAT(found.patients, SizeIs(1));
  EXPECT_EQ(found.patients[0].name, "Yamada^Tarou=山田^太郎");
}

TEST(PacsFind, NothingIsAnAnswer) {
  const test::Orthanc orthanc;
  const auto found = find(orthanc.peer(), quick_connection(), {.patient_id = "NOBODY"});
  EXPECT_THAT(found.patients, SizeIs(0));
  EXPECT_FALSE(found.was_stopped);
}

TEST(PacsFind, RefusesASearchForEverythingAndWhatCannotBeAsked) {
  const Peer peer{"PACS", "127.0.0.1", 1};
  const auto refusal = [&](const FindKeys& keys) {
    return failure_of([&] { (void)find(peer, quick_connection(), keys); });
  };
  EXPECT_THAT(refusal({}), HasSubstr("names no patient"));
  EXPECT_THAT(refusal({.modality = "CT"}), HasSubstr("names no patient"));
  EXPECT_THAT(refusal({.patient_id = "1\\2"}), HasSubstr("backslash"));
  for (const char* date : {"last week", "2026", "20260131-2027", "-"})
    EXPECT_THAT(refusal({.study_date = date}), HasSubstr("is no date")) << date;
  EXPECT_THAT(refusal({.study_uid = "1.2.x"}), HasSubstr("is no UID"));
}

}  // namespace
}  // namespace arthronaut::pacs
