// What the child says is not believed: whatever its bytes are, they are refused or are what they should be.
#include "planning/import/import_messages.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <tuple>

#include "planning/geometry/error.h"
#include "planning/import/message_limits.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::importing {
namespace {

std::string contents_of(std::string message) {
  const auto taken = take_message(message, 1 << 20);
  EXPECT_TRUE(taken && message.empty());
  return taken ? taken->contents : "";
}

images::SeriesList a_list() {
  images::ImageSeries series{.uid = "1.2.3",
                             .number = "4",
                             .format = "DICOM",
                             .modality = "CT",
                             .description = "Knee 0.6",
                             .image_count = 2,
                             .size = {512, 512, 2},
                             .spacing_mm = {0.4, 0.4, 0.6},
                             .files = {"/disc/a", "/disc/b"},
                             .refusal = "a slice is missing",
                             .warnings = {"2 slices only"}};
  return {.series = {series, {}}, .skipped = {{"/disc/report", "is no image"}}, .other_count = 3};
}

SeriesPicture a_picture() { return {{.width = 3, .height = 2, .grey = {0, 1, 2, 3, 4, 255}}, ""}; }

BoneImport an_import() {
  BoneImport import;
  import.bones.resize(1);
  import.bones[0].bone = {bones::BoneKind::Tibia, test::ellipsoid({40, 30, 25}, 0), "label 2"};
  import.bones[0].lines = {"20 triangles"};
  import.bones[0].image_cuts = {{.at_mm = {1, 2, 3}, .out = {0, -1, 0}, .area_mm2 = 1234 }};
  import.side = bones::Side::Left;
  import.image.emplace();
  return import;
}

void expect_same(const images::SeriesList& one, const images::SeriesList& other) {
  ASSERT_EQ(one.series.size(), other.series.size());
  for (std::size_t i = 0; i < one.series.size(); ++i) {
    const images::ImageSeries &a = one.series[i], &b = other.series[i];
    EXPECT_EQ(std::tie(a.uid, a.number, a.format, a.modality, a.description, a.image_count, a.files,
                       a.refusal, a.warnings),
              std::tie(b.uid, b.number, b.format, b.modality, b.description, b.image_count, b.files,
                       b.refusal, b.warnings));
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.spacing_mm, b.spacing_mm);
  }
  ASSERT_EQ(one.skipped.size(), other.skipped.size());
  for (std::size_t i = 0; i < one.skipped.size(); ++i) {
    EXPECT_EQ(one.skipped[i].file, other.skipped[i].file);
    EXPECT_EQ(one.skipped[i].reason, other.skipped[i].reason);
  }
  EXPECT_EQ(one.other_count, other.other_count);
}

// Each kind, read back; the readers say no to everything else by InvalidInput.
struct Kind {
  const char* name;
  std::string contents;
  void (*read)(std::string_view);
};

std::vector<Kind> kinds() {
  return {{"progress", contents_of(message_of(ImportProgress{ImportStage::LookingThrough, 0.5})),
           [](std::string_view c) { (void)progress_from(c); }},
          {"bones", contents_of(message_of(an_import())), [](std::string_view c) { (void)import_from(c); }},
          {"list", contents_of(message_of(a_list())),
           [](std::string_view c) {
             for (const images::ImageSeries& series : series_list_from(c).series) {
               EXPECT_GE(series.image_count, 0);
               EXPECT_GE(series.size.minCoeff(), 0);
               EXPECT_TRUE(series.spacing_mm.allFinite());
               EXPECT_LE(series.description.size(), kLongestText_bytes);
             }
           }},
          {"picture", contents_of(message_of(a_picture())), [](std::string_view c) {
             const images::Thumbnail picture = series_picture_from(c).thumbnail;
             EXPECT_EQ(picture.grey.size(), static_cast<std::size_t>(picture.width * picture.height));
             EXPECT_LE(std::max(picture.width, picture.height), kLongestPictureSide);
           }}};
}

bool is_refused(const Kind& kind, std::string_view contents) {
  try {
    kind.read(contents);
  } catch (const InvalidInput&) {
    return true;
  }
  return false;
}

TEST(ImportMessages, AListComesBackAsItWas) {
  expect_same(series_list_from(contents_of(message_of(a_list()))), a_list());
  expect_same(series_list_from(contents_of(message_of(images::SeriesList{}))), {});
}

TEST(ImportMessages, WhereTheImagesEndComesBackAsItWas) {
  EXPECT_EQ(import_from(contents_of(message_of(an_import()))).bones[0].image_cuts,
            an_import().bones[0].image_cuts);
  BoneImport askew = an_import();
  askew.bones[0].image_cuts[0].out *= 2;
  EXPECT_THROW((void)import_from(contents_of(message_of(askew))), InvalidInput);
}

TEST(ImportMessages, APictureComesBackAsItWas) {
  const SeriesPicture back = series_picture_from(contents_of(message_of(a_picture())));
  EXPECT_TRUE(back.is_there());
  EXPECT_EQ(back.thumbnail.width, 3);
  EXPECT_EQ(back.thumbnail.height, 2);
  EXPECT_EQ(back.thumbnail.grey, a_picture().thumbnail.grey);
  const SeriesPicture none = series_picture_from(contents_of(message_of(SeriesPicture{{}, "is broken"})));
  EXPECT_FALSE(none.is_there());
  EXPECT_EQ(none.refusal, "is broken");
}

// Cut off anywhere, or with something behind it.
TEST(ImportMessages, AnotherLengthIsRefused) {
  for (const Kind& kind : kinds()) {
    EXPECT_FALSE(is_refused(kind, kind.contents)) << kind.name;
    for (std::size_t length = 0; length < kind.contents.size(); ++length)
      EXPECT_TRUE(is_refused(kind, std::string_view(kind.contents).substr(0, length)))
          << kind.name << " of " << length << " bytes";
    EXPECT_TRUE(is_refused(kind, kind.contents + '\0')) << kind.name;
  }
}

// Any number of a message may be a count. None of these is, and none is allocated.
TEST(ImportMessages, ACountThatIsTooLargeTakesNoMemory) {
  for (const Kind& kind : kinds()) {
    for (const std::uint64_t count : {std::numeric_limits<std::uint64_t>::max(), std::uint64_t{1} << 62,
                                      std::uint64_t{1} << 40, std::uint64_t{1} << 20}) {
      for (std::size_t at = 0; at + sizeof(count) <= kind.contents.size(); ++at) {
        std::string spoilt = kind.contents;
        std::memcpy(spoilt.data() + at, &count, sizeof(count));
        static_cast<void>(is_refused(kind, spoilt));  // or is sound, which read() looks at
      }
    }
  }
}

TEST(ImportMessages, WhateverTheBytesAreTheyAreRefusedOrSound) {
  std::mt19937 random(1);
  for (const Kind& kind : kinds()) {
    for (int trial = 0; trial < 3000; ++trial) {
      std::string spoilt = kind.contents;
      for (int changes = 1 + trial % 5; changes > 0; --changes)
        spoilt[random() % spoilt.size()] = static_cast<char>(random());
      static_cast<void>(is_refused(kind, spoilt));
    }
    std::string noise(512, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    EXPECT_TRUE(is_refused(kind, noise)) << kind.name;
  }
}

TEST(ImportMessages, APictureOfAnotherSizeThanItsPixelsIsRefused) {
  const auto is_taken = [](int width, int height, std::size_t pixels) {
    const SeriesPicture picture{{width, height, std::vector<std::uint8_t>(pixels)}, ""};
    const std::string contents = contents_of(message_of(picture));
    try {
      return series_picture_from(contents).thumbnail.width == width;
    } catch (const InvalidInput&) {
      return false;
    }
  };
  EXPECT_TRUE(is_taken(kLongestPictureSide, kLongestPictureSide, kLongestPictureSide * kLongestPictureSide));
  EXPECT_TRUE(is_taken(0, 0, 0));
  EXPECT_FALSE(is_taken(3, 2, 5));
  EXPECT_FALSE(is_taken(0, 2, 0));
  EXPECT_FALSE(is_taken(-3, -2, 6));
  EXPECT_FALSE(is_taken(1 << 16, 1 << 16, 0));  // whose product is 0 in an int
  EXPECT_FALSE(is_taken(kLongestPictureSide + 1, 1, kLongestPictureSide + 1));
}

TEST(ImportMessages, NumbersThatAreNoneAreRefused) {
  const auto is_taken = [](const images::SeriesList& list) {
    const std::string contents = contents_of(message_of(list));
    try {
      return series_list_from(contents).series.size() == list.series.size();
    } catch (const InvalidInput&) {
      return false;
    }
  };
  images::SeriesList list = a_list();
  EXPECT_TRUE(is_taken(list));
  list.series[0].image_count = -1;
  EXPECT_FALSE(is_taken(list));
  list.series[0].image_count = std::numeric_limits<int>::max();
  EXPECT_FALSE(is_taken(list));
  list = a_list();
  list.series[0].spacing_mm.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_taken(list));
  list = a_list();
  list.series[0].size.y() = -512;
  EXPECT_FALSE(is_taken(list));
}

// A description of a megabyte is cut off by the child, between two characters, and refused where it was not.
TEST(ImportMessages, ALongTextIsCutOffAndNotBelieved) {
  images::SeriesList list = a_list();
  list.series[0].description = "x";
  for (int i = 0; i < 10'000; ++i) list.series[0].description += "\u00E4";
  const std::string cut = series_list_from(contents_of(message_of(list))).series.at(0).description;
  EXPECT_EQ(cut.size(), kLongestText_bytes - 1);
  EXPECT_EQ(cut, list.series[0].description.substr(0, cut.size()));

  // The same with a text that nobody cut: its length lies before it in the message.
  list.series[0].description = std::string(kLongestText_bytes, 'x');
  std::string contents = contents_of(message_of(list));
  const std::size_t at = contents.find(list.series[0].description);
  const std::uint64_t longer = kLongestText_bytes + 1;
  contents.insert(at, 1, 'x');
  std::memcpy(contents.data() + at - sizeof(longer), &longer, sizeof(longer));
  EXPECT_THROW((void)series_list_from(contents), InvalidInput);
  EXPECT_LE(failure_from(contents_of(message_of(Failure{.words = std::string(1'000'000, 'x')}))).words.size(),
            kLongestText_bytes);
}

}  // namespace
}  // namespace arthronaut::importing
