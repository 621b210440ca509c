// Looking through a folder in a process of its own: what images::find_series says, and nothing worse.
#include "planning/import/series_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>

#include "planning/geometry/error.h"
#include "planning/import/import_messages.h"
#include "tests/message_of.h"
#include "tests/planning/images/large_volume.h"
#include "tests/planning/import/child_script.h"
#include "tests/temporary_folder.h"

namespace arthronaut::importing {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using State = SeriesProcess::State;

class SeriesProcessTest : public testing::Test {
 protected:
  [[nodiscard]] SeriesRequest request(const std::filesystem::path& source) const {
    return {.source = source, .with_pictures = true, .program = ARTHRONAUT_IMPORT_CHILD};
  }
  // A child that sends these messages and then does what the line says.
  [[nodiscard]] SeriesRequest request_to(const std::string& messages, const std::string& line) const {
    test::write_bytes(folder_ / "messages", messages);
    SeriesRequest asked = request("disc");
    asked.program =
        test::child_script(folder_.path(), "cat " + (folder_ / "messages").string() + " >&0\n" + line);
    return asked;
  }
  void write_slices(const std::string& name, const std::string& uid, std::size_t count) const {
    std::filesystem::create_directories(folder_ / name);
    for (auto& [file, slice] : test::dicom_slices(test::oblique_volume())) {
      if (count-- == 0) return;
      test::DicomSliceForm form = slice;
      form.series_uid = uid;
      test::write_bytes(folder_ / name / file, test::dicom(form));
    }
  }

  TemporaryFolder folder_;
};

images::SeriesList list_of(std::size_t count) {
  images::SeriesList list;
  for (std::size_t i = 0; i < count; ++i)
    list.series.push_back({.uid = std::to_string(i), .format = "DICOM", .files = {"disc/slice"}});
  return list;
}
const SeriesPicture kPicture{{.width = 2, .height = 1, .grey = {0, 255}}, ""};

// A whole series, one with a single slice, a broken file, another volume, and what is nothing of an image:
// word for word and byte for byte as in this process.
TEST_F(SeriesProcessTest, GivesTheSameListAndPicturesAsInThisProcess) {
  write_slices("disc/whole", "1.2.3.4", 4);
  write_slices("disc/scout", "1.2.3.5", 1);
  test::write_bytes(folder_ / "disc/cut.dcm",
                    test::dicom(test::dicom_slices(test::oblique_volume()).begin()->second).substr(0, 300));
  test::write_bytes(folder_ / "disc/volume.nrrd", test::nrrd(test::oblique_volume(), false, true));
  test::write_bytes(folder_ / "disc/broken.nrrd", "NRRD0004\n");
  test::write_bytes(folder_ / "disc/readme.txt", "hello");
  SeriesProcess process(request(folder_ / "disc"));
  ASSERT_EQ(process.finish(), State::Done) << process.message();
  EXPECT_EQ(process.process_id(), -1);
  const images::SeriesList here = images::find_series(folder_ / "disc");
  ASSERT_EQ(here.series.size(), 4U);
  EXPECT_EQ(message_of(*process.list()), message_of(here));  // all of it
  ASSERT_EQ(process.pictures().size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const SeriesPicture& picture = process.pictures()[i];
    SCOPED_TRACE(here.series[i].uid + here.series[i].description);
    if (here.series[i].description == "broken.nrrd") {
      EXPECT_FALSE(picture.is_there());
      EXPECT_EQ(picture.refusal, test::message_of<InvalidInput>([&] { (void)thumbnail_of(here.series[i]); }));
      continue;
    }
    const images::Thumbnail made = thumbnail_of(here.series[i]);
    EXPECT_EQ(picture.thumbnail.width, made.width);
    EXPECT_EQ(picture.thumbnail.height, made.height);
    EXPECT_EQ(picture.thumbnail.grey, made.grey);
    EXPECT_EQ(picture.refusal, "");
  }
}

TEST_F(SeriesProcessTest, WithoutPicturesTheListIsAll) {
  write_slices("disc", "1.2.3.4", 4);
  SeriesRequest asked = request(folder_ / "disc");
  asked.with_pictures = false;
  SeriesProcess process(asked);
  ASSERT_EQ(process.finish(), State::Done) << process.message();
  EXPECT_EQ(process.list()->series.size(), 1U);
  EXPECT_TRUE(process.pictures().empty());
}

TEST_F(SeriesProcessTest, ARefusalComesBackInTheSameWords) {
  test::write_bytes(folder_ / "notes.txt", "hello");
  SeriesProcess process(request(folder_ / "notes.txt"));
  ASSERT_EQ(process.finish(), State::Failed);
  EXPECT_EQ(process.message(),
            test::message_of<InvalidInput>([&] { (void)images::find_series(folder_ / "notes.txt"); }));
  EXPECT_FALSE(process.list());
  SeriesProcess absent(request(folder_ / "absent"));
  ASSERT_EQ(absent.finish(), State::Failed);
  EXPECT_THAT(absent.message(), HasSubstr("absent: does not exist"));
}

// A volume of 60 MB in a file of 60 kB, where 50 MB are allowed: it is refused by its header, and has no
// picture.
TEST_F(SeriesProcessTest, AVolumeThatNeedsTooMuchMemoryIsListedWithItsReason) {
  test::write_bytes(folder_ / "bomb.nrrd", test::uniform_nrrd({250, 250, 250}, 700));
  SeriesRequest asked = request(folder_ / "bomb.nrrd");
  asked.memory_limit_gib = 0.05;
  SeriesProcess process(asked);
  ASSERT_EQ(process.finish(), State::Done) << process.message();
  EXPECT_THAT(process.list()->series.at(0).refusal,
              AllOf(HasSubstr("250 x 250 x 250"), HasSubstr("limit is 0.05 GiB")));
  EXPECT_FALSE(process.pictures().at(0).is_there());
  EXPECT_THAT(process.pictures().at(0).refusal, HasSubstr("memory"));
}

// Where there is no memory for anything, that is said.
TEST_F(SeriesProcessTest, WithoutMemoryItFailsByTheNameOfTheFolder) {
  write_slices("disc", "1.2.3.4", 4);
  SeriesRequest asked = request(folder_ / "disc");
  asked.memory_limit_gib = 0.001;
  SeriesProcess process(asked);
  EXPECT_EQ(process.finish(), State::Failed);
  EXPECT_THAT(process.message(), HasSubstr((folder_ / "disc").string() + ": "));
}

TEST_F(SeriesProcessTest, AChildThatDiesIsAClearError) {
  SeriesProcess crashed(request_to("", "kill -SEGV $$"));
  EXPECT_EQ(crashed.finish(), State::Failed);
  EXPECT_THAT(crashed.message(), AllOf(HasSubstr("disc: "), HasSubstr("signal 11")));
  EXPECT_FALSE(crashed.list());
  SeriesProcess ended(request_to("", "exit 7"));
  EXPECT_EQ(ended.finish(), State::Failed);
  EXPECT_THAT(ended.message(), HasSubstr("code 7"));
}

// Of three series the second one's picture is the death of it.
TEST_F(SeriesProcessTest, WhatDiesAtAPictureLeavesTheListAndThePicturesBeforeIt) {
  SeriesProcess process(request_to(message_of(list_of(3)) + message_of(kPicture), "kill -SEGV $$"));
  EXPECT_EQ(process.finish(), State::Failed);
  EXPECT_THAT(process.message(), AllOf(HasSubstr("disc: "), HasSubstr("signal 11")));
  ASSERT_TRUE(process.list());
  EXPECT_EQ(process.list()->series.size(), 3U);
  ASSERT_EQ(process.pictures().size(), 1U);
  EXPECT_EQ(process.pictures()[0].thumbnail.grey, kPicture.thumbnail.grey);
}

TEST_F(SeriesProcessTest, AChildThatHangsIsEndedAndSaid) {
  SeriesRequest asked = request_to(message_of(list_of(1)), "exec sleep 60");
  asked.longest_silence_s = 0.5;
  const auto start = std::chrono::steady_clock::now();
  SeriesProcess process(asked);
  EXPECT_EQ(process.finish(), State::Failed);
  EXPECT_THAT(process.message(), AllOf(HasSubstr("disc: "), HasSubstr("nothing was heard")));
  EXPECT_EQ(process.process_id(), -1);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));  // it would sleep for 60
}

// What it says is not believed: nonsense, pictures before their list, another kind's answer, a list twice.
TEST_F(SeriesProcessTest, AChildThatTalksNonsenseIsAClearError) {
  const std::string list = message_of(list_of(2));
  for (const std::string& messages :
       {std::string(100'000, '\0'), message_of(kPicture), message_of(BoneImport{}), list + list,
        list + message_of(ImportProgress{ImportStage::LookingThrough, 0.5})}) {
    SeriesProcess process(request_to(messages, "exec sleep 60"));
    EXPECT_EQ(process.finish(), State::Failed);
    EXPECT_THAT(process.message(), AllOf(HasSubstr("disc: "), HasSubstr("the importing process sent")));
    EXPECT_EQ(process.process_id(), -1);
  }
  // More pictures than series: those that are too many are nobody's.
  const std::string picture = message_of(kPicture);
  SeriesProcess talkative(request_to(list + picture + picture + picture, "exec sleep 60"));
  EXPECT_EQ(talkative.finish(), State::Done);
  EXPECT_EQ(talkative.pictures().size(), 2U);
}

// A window goes on with its frames beside it.
TEST_F(SeriesProcessTest, AChildThatNeverStopsTalkingHoldsNobodyUp) {
  std::string much;
  for (int i = 0; i < 20'000; ++i) much += message_of(ImportProgress{ImportStage::LookingThrough, 0.5});
  SeriesProcess process(
      request_to(much, "while :; do cat " + (folder_ / "messages").string() + "; done >&0"));
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(process.wait_for(1), State::Running) << process.message();
  EXPECT_EQ(process.looked_fraction(), 0.5);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST_F(SeriesProcessTest, CancelEndsTheChildAtOnce) {
  SeriesRequest asked = request_to(message_of(list_of(2)), "exec sleep 60");
  int process_id = -1;
  const auto is_gone = [&] { return ::kill(process_id, 0) != 0; };
  {
    SeriesProcess process(asked);
    process_id = process.process_id();
    while (!process.list()) ASSERT_EQ(process.wait_for(60), State::Running);
    EXPECT_FALSE(is_gone());
    process.cancel();
    EXPECT_TRUE(is_gone());
    EXPECT_EQ(process.poll(), State::Cancelled);
    EXPECT_EQ(process.list()->series.size(), 2U);
  }
  {
    const SeriesProcess process(asked);  // so does letting go of it
    process_id = process.process_id();
  }
  EXPECT_TRUE(is_gone());
}

TEST_F(SeriesProcessTest, WhatCannotBeStartedIsAnIoError) {
  SeriesRequest asked = request("disc");
  asked.program = folder_ / "absent";
  EXPECT_THAT(test::message_of<IoError>([&] { const SeriesProcess process(asked); }), HasSubstr("absent"));
  asked = request("disc");
  asked.memory_limit_gib = 0;
  EXPECT_THROW(SeriesProcess{asked}, InvalidInput);
}

}  // namespace
}  // namespace arthronaut::importing
