#include "app/paint/bone_making.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "planning/cases/study.h"
#include "planning/images/volume_writer.h"
#include "planning/import/case_import.h"
#include "planning/painting/painting_file.h"
#include "planning/phantom/phantom_case.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/planning/painting/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::paint {
namespace {

using bones::BoneKind;
using painting::Layer;
using State = BoneMaking::State;

// A ball painted as femur: a closed surface of its volume, of which the anatomy check says that it is no
// femur.
class BoneMakingTest : public ::testing::Test {
 protected:
  static constexpr double kRadius_mm = 18;
  BoneMakingTest() {
    auto volume = std::make_shared<images::Volume>(test::empty_volume({60, 60, 60}, {0.8, 0.8, 0.8}));
    for (std::size_t v = 0; v < volume->values.size(); ++v) volume->values[v] = static_cast<float>(v % 300);
    painting_ = painting::Painting(volume);
    painting::Labels bones(volume->values.size(), painting::kNothing);
    test::add_ball(bones, *volume, {24, 24, 24}, kRadius_mm, painting::kFemur);
    painting_.put(Layer::Bones, bones, "ball");
    knee_.name = "Painted";
    knee_.side = bones::Side::Left;
    knee_.created_utc = "2026-01-31T12:00:00Z";
    knee_.images.push_back({.file = "", .modality = "MR", .source = "DICOM"});
    knee_.images.back().size = volume->size;
    knee_.images.back().spacing_mm = volume->spacing_mm();
    cases::store_image(folder_.path(), 1, images::encoded(*volume), knee_.images.back());
    cases::save_case(folder_.path(), knee_);
    painting::save_painting(folder_.path(), *volume, {painting_.labels(Layer::Strokes), bones});
  }
  bool reach(State state) {
    for (int i = 0; i < 12'000 && making_.state() != state; ++i) {
      making_.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return making_.state() == state;
  }
  const test::TemporaryFolder folder_;
  cases::Case knee_;
  painting::Painting painting_;
  BoneMaking making_{[] {}, ARTHRONAUT_PROGRAM};
};

TEST_F(BoneMakingTest, JudgesTheSurfaceAndPutsItIntoTheCaseWithItsStudy) {
  images::DicomOrigin origin;
  origin.study_uid = "1.2.3";
  origin.series_uid = "1.2.3.4";
  cases::save_studies(folder_.path(), {{BoneKind::Femur, origin}});
  ASSERT_EQ(BoneMaking::refusal(knee_, painting_), "");
  making_.start(knee_, folder_.path(), knee_.images.back(), painting_);
  ASSERT_TRUE(reach(State::Judging)) << making_.failure();
  ASSERT_EQ(making_.qualities().size(), 1U);
  const importing::BoneQuality& quality = making_.qualities()[0];
  const double ball_ml = 4.0 / 3 * M_PI * kRadius_mm * kRadius_mm * kRadius_mm / 1000;
  EXPECT_NEAR(quality.labelled_ml, ball_ml, 0.01 * ball_ml);
  EXPECT_NEAR(quality.surface_ml, quality.labelled_ml, 0.01 * ball_ml) << "not shrunk";
  EXPECT_TRUE(quality.is_closed);
  EXPECT_EQ(quality.edges_not_manifold, 0U);
  EXPECT_FALSE(quality.doubts.empty()) << "a ball is no femur";
  making_.save();
  ASSERT_TRUE(reach(State::Done)) << making_.failure();
  const cases::Case made = cases::load_case(folder_.path());
  EXPECT_EQ(made.side, bones::Side::Left);
  EXPECT_EQ(made.images.size(), 1U) << "the labels are no image of the case";
  ASSERT_TRUE(made.bones.contains(BoneKind::Femur));
  // Between the voxels: half a voxel's diagonal is 0.7 mm.
  for (const Eigen::Vector3d& p : made.bones.at(BoneKind::Femur).mesh.vertices_mm)
    ASSERT_NEAR((p - Eigen::Vector3d(24, 24, 24)).norm(), kRadius_mm, 0.5);
  EXPECT_EQ(cases::load_studies(folder_.path()).at(BoneKind::Femur).series_uid, "1.2.3.4");
}

// A case of two series, an older and a newer one: a bone goes to the hospital beside the one that it was
// painted in.
TEST_F(BoneMakingTest, ABoneIsOfTheStudyOfTheImageThatItWasPaintedIn) {
  const auto add_series = [&](const std::string& uid, float brightness) {
    images::Volume volume = *painting_.shared_volume();
    volume.values.front() = brightness;
    importing::BoneImport import;
    import.side = bones::Side::Left;
    import.image = {knee_.images.front(), images::encoded(volume)};
    import.origin.study_uid = "1.2.3";
    import.origin.series_uid = uid;
    importing::add_to_case(folder_.path(), import, "", "mr");
  };
  add_series("1.2.3.1", 1000);
  add_series("1.2.3.2", 2000);
  const cases::Case knee = cases::load_case(folder_.path());
  ASSERT_EQ(knee.images.size(), 3U);
  for (const std::size_t number : {1U, 2U}) {
    making_.start(knee, folder_.path(), knee.images[number], painting_);
    ASSERT_TRUE(reach(State::Judging)) << making_.failure();
    making_.save();
    ASSERT_TRUE(reach(State::Done)) << making_.failure();
    EXPECT_EQ(cases::load_studies(folder_.path()).at(BoneKind::Femur).series_uid,
              "1.2.3." + std::to_string(number));
  }
}

TEST_F(BoneMakingTest, StoppedOrLeftItChangesNothing) {
  making_.start(knee_, folder_.path(), knee_.images.back(), painting_);
  making_.cancel();
  EXPECT_EQ(making_.state(), State::Idle);
  making_.start(knee_, folder_.path(), knee_.images.back(), painting_);
  ASSERT_TRUE(reach(State::Judging)) << making_.failure();
  making_.cancel();
  EXPECT_EQ(making_.state(), State::Idle);
  EXPECT_TRUE(cases::load_case(folder_.path()).bones.empty());
}

TEST_F(BoneMakingTest, ABoneThatIsPlannedOnAndAnEmptyPaintingAreRefusedBeforeTheWork) {
  const painting::Painting empty(painting_.shared_volume());
  EXPECT_THAT(BoneMaking::refusal(knee_, empty), testing::HasSubstr("Nothing is painted"));
  tunnels::Tunnel tunnel;
  tunnel.bone = BoneKind::Tibia;
  knee_.plan.put(tunnel, "");
  EXPECT_EQ(BoneMaking::refusal(knee_, painting_), "");
  tunnel.bone = BoneKind::Femur;
  knee_.plan.put(tunnel, "");
  EXPECT_THAT(BoneMaking::refusal(knee_, painting_), testing::HasSubstr("femur is planned on"));
  EXPECT_THAT(BoneMaking::refusal(knee_, painting_, {BoneKind::Femur}),
              testing::HasSubstr("correct them first"))
      << "painted as the case has it, it is not made anew";
  EXPECT_THAT(BoneMaking::refusal(knee_, painting_, {BoneKind::Tibia}),
              testing::HasSubstr("femur is planned on"));
}

TEST_F(BoneMakingTest, ABrokenPaintingIsSaid) {
  std::filesystem::remove(painting::bones_file(folder_.path()));
  making_.start(knee_, folder_.path(), knee_.images.back(), painting_);
  for (int i = 0; i < 12'000 && making_.state() == State::Making; ++i) {
    making_.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(making_.state(), State::Idle);
  EXPECT_THAT(making_.failure(), testing::HasSubstr("does not exist"));
}

}  // namespace
}  // namespace arthronaut::paint
