#include "planning/cases/measurements.h"

#include <gtest/gtest.h>

#include <fstream>

#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::cases {
namespace {

// A triangle of 3, 4 and 5 mm.
const Measurement kDistance{{{1, 2, 3}, {1, 5, 7}}};
const Measurement kAngle{{{3, 0, 0}, {0, 0, 0}, {0, 4, 0}}};

TEST(Measurements, AreWhatTheyMeasure) {
  EXPECT_NEAR(kDistance.distance_mm(), 5, 1e-12);
  EXPECT_EQ(kDistance.in_words(), "5.0 mm");
  EXPECT_NEAR(kAngle.angle_deg(), 90, 1e-12);
  EXPECT_EQ(kAngle.in_words(), "90.0\u00B0");
  EXPECT_EQ((Measurement{{{1, 1, 1}, {1, 1, 1}, {2, 1, 1}}}.angle_deg()), 0);
}

// Back as they were saved, in their order; without any there is no file.
TEST(Measurements, ComeBackAsTheyWereSaved) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(load_measurements(folder.path()).empty());
  save_measurements(folder.path(), {kDistance, kAngle});
  EXPECT_EQ(load_measurements(folder.path()), (std::vector<Measurement>{kDistance, kAngle}));
  save_measurements(folder.path(), {});
  EXPECT_FALSE(std::filesystem::exists(measurements_file(folder.path())));
  save_measurements(folder.path(), {});
}

// What no measurement is, is refused with file and place; nothing is written of it.
TEST(Measurements, RefuseWhatIsNone) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(save_measurements(folder.path(), {Measurement{{{1, 1, 1}}}}), InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(measurements_file(folder.path())));
  for (
      const char* broken :
      {R"({"format": "arthronaut.measurements", "version": 1, "measurements": [{"points": [{"mm": [1, 2, 3]}]}]})",
       R"({"format": "arthronaut.measurements", "version": 1, "measurements": [{"points": [{"mm": [1, 2]}]}]})",
       R"({"format": "arthronaut.measurements", "version": 2, "measurements": []})", "{"}) {
    std::ofstream(measurements_file(folder.path())) << broken;
    try {
      (void)load_measurements(folder.path());
      ADD_FAILURE() << broken;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("measurements.json"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace arthronaut::cases
