// Which study a series is of, as the reader passes it on.
#include "planning/images/dicom_origin.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/images/volume_file.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/images/volume_forms.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

struct Read {
  Volume volume;
  int count = 0;
  DicomOrigin origin;
};
Read read(const std::filesystem::path& source) {
  Read read;
  VolumeFileOptions options;
  options.on_origin = [&](const DicomOrigin& origin) {
    ++read.count;
    read.origin = origin;
  };
  read.volume = read_volume(source, options);
  return read;
}

TEST(DicomOrigin, IsThatOfTheSeriesWithAllItsImages) {
  const test::TemporaryFolder folder;
  test::DicomSeriesForm form;
  test::write_dicom_series(folder.path(), test::oblique_volume(), form);
  const Read found = read(folder.path());
  EXPECT_EQ(found.count, 1);
  for (int k = 0; k < 4; ++k)
    form.origin.sop_instance_uids.push_back(form.origin.series_uid + "." + std::to_string(k));
  // The volume may begin at either end.
  DicomOrigin origin = found.origin;
  std::sort(origin.sop_instance_uids.begin(), origin.sop_instance_uids.end());
  EXPECT_EQ(origin, form.origin);
}

// Names are in UTF-8 whatever the hospital writes: Latin 1 here.
TEST(DicomOrigin, NamesAreInUtf8) {
  const test::TemporaryFolder folder;
  test::DicomSeriesForm form;
  form.patient.name = "M\xfcller^J\xf6rg";
  form.origin.referring_physician = "H\xe4user";
  form.character_set = "ISO_IR 100";
  test::write_dicom_series(folder.path(), test::oblique_volume(), form);
  const Read found = read(folder.path());
  EXPECT_EQ(found.volume.patient.name, "Müller^Jörg");
  EXPECT_EQ(found.origin.referring_physician, "Häuser");
}

std::string name_in_utf8(const std::string& name, const std::string& character_set) {
  const test::TemporaryFolder folder;
  test::DicomSeriesForm form;
  form.patient.name = name;
  form.character_set = character_set;
  test::write_dicom_series(folder.path(), test::oblique_volume(), form);
  return read(folder.path()).volume.patient.name;
}

// The names of the standard's own examples (PS3.5, annexes H and I): kanji by escape sequences, after ASCII
// and after katakana; hangul.
TEST(DicomOrigin, NamesOfEastAsiaAreInUtf8) {
  EXPECT_EQ(
      name_in_utf8("Yamada^Tarou=\x1b$B;3ED\x1b(B^\x1b$BB@O:\x1b(B=\x1b$B$d$^$@\x1b(B^\x1b$B$?$m$&\x1b(B",
                   "\\ISO 2022 IR 87"),
      "Yamada^Tarou=山田^太郎=やまだ^たろう");
  EXPECT_EQ(name_in_utf8("\xd4\xcf\xc0\xde^\xc0\xdb\xb3=\x1b$B;3ED\x1b(J^\x1b$BB@O:\x1b(J",
                         "ISO 2022 IR 13\\ISO 2022 IR 87"),
            "ﾔﾏﾀﾞ^ﾀﾛｳ=山田^太郎");
  EXPECT_EQ(name_in_utf8("Hong^Gildong=\x1b$)C\xfb\xf3^\x1b$)C\xd1\xce\xd4\xd7", "\\ISO 2022 IR 149"),
            "Hong^Gildong=洪^吉洞");
}

// Where the data set names no character set, or another than it is, nobody knows which letter was meant; what
// is shown, stored and sent on is text all the same.
TEST(DicomOrigin, LettersOfAnUnknownCharacterSetAreQuestionMarks) {
  EXPECT_EQ(name_in_utf8("M\xfcller", "ISO_IR 4711"), "M?ller");
  EXPECT_EQ(name_in_utf8("\x1b$B;", "\\ISO 2022 IR 87"), "$B;");
  EXPECT_EQ(name_in_utf8("M\xc3\xbcller", "ISO_IR 4711"), "Müller");
}

// Some scanners mark each image, some the series; "B" and nothing are no side, nor are both.
TEST(DicomSide, IsTheOneThatTheImagesAreMarkedWith) {
  const auto side_where = [](const std::function<void(DcmDataset&, int k)>& change) {
    const test::TemporaryFolder folder;
    test::DicomSeriesForm form;
    form.change = change;
    test::write_dicom_series(folder.path(), test::oblique_volume(), form);
    return read(folder.path()).volume.side;
  };
  const auto put = [](DcmDataset& dataset, const DcmTagKey& key, const char* value) {
    ASSERT_TRUE(dataset.putAndInsertString(key, value).good());
  };
  using bones::Side;
  EXPECT_EQ(side_where(nullptr), std::nullopt);
  EXPECT_EQ(side_where([&](DcmDataset& d, int) { put(d, DCM_Laterality, "L"); }), Side::Left);
  EXPECT_EQ(side_where([&](DcmDataset& d, int) { put(d, DCM_ImageLaterality, "R"); }), Side::Right);
  EXPECT_EQ(side_where([&](DcmDataset& d, int) { put(d, DCM_Laterality, "B"); }), std::nullopt);
  EXPECT_EQ(side_where([&](DcmDataset& d, int k) {
              if (k == 2) put(d, DCM_Laterality, "R");
            }),
            Side::Right)
      << "what the others leave out";
  EXPECT_EQ(side_where([&](DcmDataset& d, int k) { put(d, DCM_ImageLaterality, k == 2 ? "R" : "L"); }),
            std::nullopt)
      << "of two none is believed";
  EXPECT_EQ(side_where([&](DcmDataset& d, int) {
              put(d, DCM_Laterality, "L");
              put(d, DCM_ImageLaterality, "R");
            }),
            Side::Right)
      << "the image itself before its series";
}

TEST(DicomOrigin, OtherVolumesHaveNone) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "a.nrrd", test::nrrd(test::oblique_volume(), false, false));
  EXPECT_EQ(read(folder / "a.nrrd").count, 0);
}

}  // namespace
}  // namespace arthronaut::images
