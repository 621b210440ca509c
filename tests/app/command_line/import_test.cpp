// import, as a user types it: what it says of what it was told by.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/images/volume_file.h"
#include "planning/images/volume_writer.h"
#include "tests/app/command_line/program.h"
#include "tests/planning/segmentation/known_mr.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;

// Of a file whose name says nothing: it is not blamed for what a segment's name told.
TEST(ImportCommand, SaysThatASegmentsNameToldTheSide) {
  const test::TemporaryFolder folder;
  images::Volume labels = test::known_labels();
  labels.segments = {{"Right femur", 5}, {"tibia", 6}};
  images::write_volume(folder / "knee.seg.nrrd", labels);
  const auto by_segment = run_program({"import", folder / "knee.seg.nrrd", "-o", folder / "A.arthro"});
  EXPECT_THAT(by_segment.output, HasSubstr(": a right knee (by the name of a segment)."));
  labels.segments = {{"femur", 5}, {"tibia", 6}};
  images::write_volume(folder / "right.seg.nrrd", labels);
  const auto by_file = run_program({"import", folder / "right.seg.nrrd", "-o", folder / "B.arthro"});
  EXPECT_THAT(by_file.output, HasSubstr(": a right knee (by the name of the source)."));
}

}  // namespace
}  // namespace arthronaut
