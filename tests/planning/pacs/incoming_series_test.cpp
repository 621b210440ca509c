#include "planning/pacs/incoming_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace arthronaut::pacs {
namespace {

const IncomingSeries::Limits kLimits{std::int64_t{1} << 40, 0};

std::string uid_of(int image) { return "1.2.3.4." + std::to_string(image); }

void receive(IncomingSeries& series, int image) {
  const std::filesystem::path file = series.begin(uid_of(image));
  DcmFileFormat format;
  DcmDataset& dataset = *format.getDataset();
  const std::pair<DcmTagKey, std::string> texts[] = {{DCM_SOPClassUID, UID_CTImageStorage},
                                                     {DCM_SOPInstanceUID, uid_of(image)},
                                                     {DCM_SeriesInstanceUID, "1.2.3"},
                                                     {DCM_StudyInstanceUID, "1.2"}};
  for (const auto& [key, text] : texts) ASSERT_TRUE(dataset.putAndInsertString(key, text.c_str()).good());
  ASSERT_TRUE(format.saveFile(file.c_str(), EXS_LittleEndianExplicit).good());
  ASSERT_TRUE(series.keep(file, uid_of(image)));
}

// A peer that lists no images sends a series whole or not at all: one of many thin slices that broke off is
// sent from its beginning, and gone on with. Sent over and over it is refused all the same.
TEST(IncomingSeriesTest, ALongSeriesIsGoneOnWithFromAPeerThatListsNoImages) {
  constexpr int kHad = 1300, kAll = 1400, kMostRefused = 100, kMostAgain = 1000;
  const test::TemporaryFolder folder;
  {
    IncomingSeries broken_off(folder / "scan", "1.2.3", kLimits);
    for (int image = 1; image <= kHad; ++image) receive(broken_off, image);
  }
  IncomingSeries series(folder / "scan", "1.2.3", kLimits);
  ASSERT_EQ(series.count(), static_cast<std::size_t>(kHad));
  series.expect({"1.2", "", {}});
  for (int image = 1; image <= kAll; ++image) EXPECT_TRUE(series.admits(uid_of(image))) << image;
  EXPECT_FALSE(series.is_fed_up());
  for (int again = 0; again <= kMostAgain + kMostRefused; ++again) (void)series.admits(uid_of(1));
  EXPECT_TRUE(series.is_fed_up());
}

}  // namespace
}  // namespace arthronaut::pacs
