#include "app/start/case_pictures.h"

#include <gtest/gtest.h>

#include "app/library/case_thumbnail.h"
#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::start {
namespace {

// Whoever leaves the list while a picture is made does not wait for its case to be read: nothing is drawn any
// more, and the list can be left, entered and closed all the same.
TEST(CasePictures, AreNotWaitedForWhenTheListIsLeft) {
  const test::TemporaryFolder folder;
  const auto knee = folder.path() / "Knee.arthro";
  cases::save_case(knee, phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "Knee"));
  {
    CasePictures pictures([] {});
    EXPECT_EQ(pictures.of(knee), nullptr);
    pictures.poll();
    EXPECT_TRUE(pictures.is_busy());
    pictures.finish();
    EXPECT_FALSE(pictures.is_busy());
  }
  EXPECT_FALSE(workstation_library::has_thumbnail(knee));
}

}  // namespace
}  // namespace arthronaut::start
