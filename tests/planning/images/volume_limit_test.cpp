// A header's claim is judged before anything of that size is allocated. The tests run with hardly any memory
// to spare, so that an allocation would end them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "tests/message_of.h"
#include "tests/planning/images/large_volume.h"
#include "tests/temporary_folder.h"

namespace arthronaut::images {
namespace {

using test::message_of;
using test::TemporaryFolder;
using test::write_bytes;
using testing::AllOf;
using testing::HasSubstr;

// What the process has now and so much more.
class SpareMemory {
 public:
  explicit SpareMemory(std::size_t bytes) {
    ::getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{static_cast<rlim_t>(pages * 4096 + bytes), before_.rlim_max};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  ~SpareMemory() { ::setrlimit(RLIMIT_AS, &before_); }
  SpareMemory(const SpareMemory&) = delete;
  SpareMemory& operator=(const SpareMemory&) = delete;

 private:
  rlimit before_{};
};
constexpr std::size_t kSpare_bytes = std::size_t{128} << 20;

// Incompressible, so that a file has the size that is meant.
std::string noise(std::size_t bytes) {
  std::string text(bytes, '\0');
  std::uint32_t state = 1;
  for (char& c : text) c = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  return text;
}

std::string refusal(const std::string& name, const std::string& contents) {
  const TemporaryFolder folder;
  write_bytes(folder / name, contents);
  const SpareMemory spare(kSpare_bytes);
  return message_of<InvalidInput>([&] { (void)read_volume(folder / name); });
}

TEST(VolumeLimit, ANrrdOfTwoMegabytesThatClaimsToBeHugeIsRefusedByItsHeader) {
  const std::string packed =
      test::nrrd_header({30000, 30000, 1400}, true) + test::deflated(noise(2 << 20), true);
  EXPECT_GT(packed.size(), std::size_t{2} << 20);
  EXPECT_THAT(refusal("bomb.nrrd", packed), AllOf(HasSubstr("bomb.nrrd: "), HasSubstr("30000 x 30000 x 1400"),
                                                  HasSubstr("limit is 2 GiB")));
  EXPECT_THAT(refusal("bomb.nrrd", test::nrrd_header({65536, 65536, 65536}, false) + noise(2 << 20)),
              HasSubstr("limit is 2 GiB"));
}

// A header that is modest, and data behind it that are not: 300 MiB of them in 300 kB.
TEST(VolumeLimit, DataThatUnpackToMoreThanTheHeaderSaysAreRefused) {
  const std::string bomb = test::deflated(std::string(std::size_t{300} << 20, '\0'), true);
  EXPECT_LT(bomb.size(), std::size_t{2} << 20);
  EXPECT_THAT(refusal("bomb.nrrd", test::nrrd_header({10, 10, 10}, true) + bomb), HasSubstr("more data"));
  EXPECT_THAT(refusal("bomb.nii.gz", bomb), HasSubstr("NIfTI"));
}

TEST(VolumeLimit, ANiftiThatClaimsToBeHugeIsRefusedByItsHeader) {
  std::string header = test::nifti(test::oblique_volume(), std::endian::little);
  for (const std::size_t at : {42U, 44U, 46U})
    header.replace(at, 2, test::bytes_of(std::int16_t{30000}, std::endian::little));
  EXPECT_THAT(refusal("bomb.nii", header), AllOf(HasSubstr("bomb.nii: "), HasSubstr("limit is 2 GiB")));
  EXPECT_THAT(refusal("bomb.nii.gz", test::deflated(header, true)),
              AllOf(HasSubstr("30000 x 30000 x 30000"), HasSubstr("limit is 2 GiB")));
}

TEST(VolumeLimit, AMetaImageThatClaimsToBeHugeIsRefusedByItsHeader) {
  for (const bool compressed : {false, true}) {
    std::string header = test::metaimage(test::oblique_volume(), compressed);
    header.replace(header.find("7 5 4"), 5, "60000 60000 60000");
    EXPECT_THAT(refusal("bomb.mha", header), AllOf(HasSubstr("bomb.mha: "), HasSubstr("limit is 2 GiB")));
  }
}

// Rows, columns and slices together.
TEST(VolumeLimit, ADicomSeriesThatClaimsToBeHugeIsRefusedByItsHeaders) {
  const TemporaryFolder folder;
  for (auto [name, slice] : test::dicom_slices(test::oblique_volume())) {
    slice.columns = slice.rows = 65535;
    write_bytes(folder / name, test::dicom(slice));
  }
  const SpareMemory spare(kSpare_bytes);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_volume(folder.path()); }),
              AllOf(HasSubstr("65535 x 65535 x 4"), HasSubstr("limit is 2 GiB")));
}

// The limit is the caller's to set, and what lies below it is read.
TEST(VolumeLimit, IsTheCallers) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.nrrd", test::uniform_nrrd({100, 100, 100}, 7));
  VolumeFileOptions options;
  options.most_bytes = 5'999'999;  // a million voxels of four bytes from two
  EXPECT_THROW((void)read_volume(folder / "a.nrrd", options), InvalidInput);
  options.most_bytes = 6'000'000;
  EXPECT_EQ(read_volume(folder / "a.nrrd", options).values.size(), 1'000'000U);
}

}  // namespace
}  // namespace arthronaut::images
