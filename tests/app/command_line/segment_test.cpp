// segment on an MR that was made from known labels: what it grows, tidies and says of the bones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "planning/files/atomic_file.h"
#include "planning/images/volume_file.h"
#include "planning/images/volume_writer.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/segmentation/known_mr.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SegmentCommand : public ::testing::Test {
 protected:
  SegmentCommand() {
    images::write_volume(folder_ / "mr.nrrd", test::known_mr(truth_, 20));
    write_seeds();
  }
  // With one voxel more, of this label.
  void write_seeds(std::uint8_t label = 0, const Eigen::Vector3i& at = {0, 0, 0}) const {
    write_seeds(test::strokes(truth_, {5, 6}), label, at);
  }
  void write_seeds(const std::vector<std::uint8_t>& painted, std::uint8_t label = 0,
                   const Eigen::Vector3i& at = {0, 0, 0}) const {
    images::Volume seeds = truth_;
    seeds.values.assign(painted.begin(), painted.end());
    if (label != 0) seeds.values[seeds.index(at.x(), at.y(), at.z())] = label;
    images::write_volume(folder_ / "seeds.nrrd", seeds);
  }
  [[nodiscard]] test::ProgramResult segment(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"segment", folder_ / "mr.nrrd",    "--seeds", folder_ / "seeds.nrrd",
                                       "-o",      folder_ / "labels.nrrd"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  [[nodiscard]] float grown_at(const Eigen::Vector3i& voxel) const {
    const auto grown = images::read_volume(folder_ / "labels.nrrd");
    return grown.at(voxel.x(), voxel.y(), voxel.z());
  }
  // A voxel in the middle of a stroke of the label.
  [[nodiscard]] Eigen::Vector3i in_stroke(std::uint8_t label) const {
    const auto painted = test::strokes(truth_, {5, 6});
    Eigen::Vector3i found(-1, -1, -1);
    for (int k = 0; k < truth_.size.z(); ++k)
      for (int j = 1; j + 1 < truth_.size.y(); ++j)
        for (int i = 1; i + 1 < truth_.size.x(); ++i)
          if (found.x() < 0 && painted[truth_.index(i, j, k)] == label &&
              painted[truth_.index(i - 1, j, k)] == label && painted[truth_.index(i + 1, j, k)] == label)
            found = {i, j, k};
    return found;
  }
  const images::Volume truth_ = test::known_labels();
  const test::TemporaryFolder folder_;
};

// The bones that are named are judged as an import will judge them, and drawn on a page.
TEST_F(SegmentCommand, JudgesTheBonesAndDrawsThem) {
  const auto result = segment({"--label", "femur=5,tibia=6", "--report", folder_ / "quality.pdf"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("femur: Closed: "), HasSubstr("tibia: Closed: "),
                                   HasSubstr("femur: Shape: nothing speaks against it"),
                                   HasSubstr("femur: Grey values: "), HasSubstr("quality.pdf")));
  std::ifstream pdf(folder_ / "quality.pdf", std::ios::binary);
  std::string begin(5, ' ');
  pdf.read(begin.data(), 5);
  EXPECT_EQ(begin, "%PDF-");
  // Named the wrong way round they are doubted, with the reason; the label map is there all the same.
  std::filesystem::remove(folder_ / "labels.nrrd");
  const auto doubted = segment({"--label", "femur=6,tibia=5"});
  EXPECT_EQ(doubted.exit_code, 4);
  EXPECT_THAT(doubted.output + doubted.errors, AllOf(HasSubstr("femur: Look: "), HasSubstr("tibia: Look: ")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "labels.nrrd"));
}

// A slip of the brush, of the femur's label in the tibia: an island that goes, and a hole that is filled.
TEST_F(SegmentCommand, RemovesIslandsAndFillsHoles) {
  const Eigen::Vector3i slip = in_stroke(6);
  ASSERT_GE(slip.x(), 0);
  write_seeds(5, slip);
  const auto as_it_is = segment();
  EXPECT_EQ(grown_at(slip), 5.0F);
  EXPECT_THAT(as_it_is.output, Not(HasSubstr("islands")));
  const auto largest = segment({"--largest"});
  EXPECT_THAT(largest.output, HasSubstr("label 5: "));
  EXPECT_THAT(largest.output, HasSubstr("voxels of islands removed"));
  EXPECT_EQ(grown_at(slip), 0.0F);
  const auto filled = segment({"--label", "femur=5,tibia=6", "--largest", "--fill-holes", "1"});
  EXPECT_EQ(filled.exit_code, 0) << filled.errors;
  EXPECT_EQ(grown_at(slip), 6.0F);
}

// Where nothing was painted for what surrounds the bones, all of it becomes bone: said, and not relied on.
TEST_F(SegmentCommand, DoubtsBonesWithoutSurroundings) {
  auto painted = test::strokes(truth_, {5, 6});
  std::ranges::replace(painted, test::kBackground, std::uint8_t{0});
  write_seeds(painted);
  const auto named = segment({"--label", "femur=5,tibia=6"});
  EXPECT_EQ(named.exit_code, 4);
  EXPECT_THAT(named.errors, HasSubstr("no stroke stands for what surrounds the bones"));
  EXPECT_THAT(segment().output, HasSubstr("No voxel is 0: --label says which of the labels are bones."));
}

// Neither the patient's images nor the strokes are written over, and what no reader would take for a volume
// is not written at all.
TEST_F(SegmentCommand, RefusesAnOutputThatWouldLoseSomething) {
  const std::string images = files::read_text(folder_ / "mr.nrrd"),
                    seeds = files::read_text(folder_ / "seeds.nrrd");
  for (const char* input : {"mr.nrrd", "seeds.nrrd"}) {
    const auto result = run_program(
        {"segment", folder_ / "mr.nrrd", "--seeds", folder_ / "seeds.nrrd", "-o", folder_ / input});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.errors, AllOf(HasSubstr(input), HasSubstr("is what is read")));
  }
  EXPECT_EQ(files::read_text(folder_ / "mr.nrrd"), images);
  EXPECT_EQ(files::read_text(folder_ / "seeds.nrrd"), seeds);
  const auto text = run_program(
      {"segment", folder_ / "mr.nrrd", "--seeds", folder_ / "seeds.nrrd", "-o", folder_ / "labels.txt"});
  EXPECT_EQ(text.exit_code, 2);
  EXPECT_THAT(text.errors, HasSubstr("does not end in .nrrd"));
  const auto nowhere = segment({"--label", "femur=5", "--report", folder_ / "nowhere" / "page.pdf"});
  EXPECT_EQ(nowhere.exit_code, 3);
  EXPECT_THAT(nowhere.errors, HasSubstr("page.pdf: the folder"));
  EXPECT_EQ(segment({"--smooth-mm", "nan"}).exit_code, 2);
  EXPECT_EQ(segment({"--label", "fibula=5"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "labels.nrrd"));
}

// What cannot be is said before anything is grown, and nothing is written.
TEST_F(SegmentCommand, RefusesWhatItCannotJudge) {
  const auto unnamed = segment({"--report", folder_ / "quality.pdf"});
  EXPECT_EQ(unnamed.exit_code, 2);
  EXPECT_THAT(unnamed.errors, HasSubstr("--label"));
  const auto unpainted = segment({"--label", "femur=5,tibia=9"});
  EXPECT_EQ(unpainted.exit_code, 3);
  EXPECT_THAT(unpainted.errors, AllOf(HasSubstr("seeds.nrrd"), HasSubstr("the label 9")));
  EXPECT_EQ(segment({"--fill-holes", "-1"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "labels.nrrd"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "quality.pdf"));
}

}  // namespace
}  // namespace arthronaut
