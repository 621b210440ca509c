#include "app/paint/paint_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "planning/images/volume_writer.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/painting/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::paint {
namespace {

using painting::Layer;

class PaintStoreTest : public ::testing::Test {
 protected:
  PaintStoreTest() {
    images::Volume volume = test::empty_volume({20, 20, 10}, {1, 1, 2});
    for (std::size_t v = 0; v < volume.values.size(); ++v) volume.values[v] = static_cast<float>(v % 700);
    image_.modality = "MR";
    image_.size = volume.size;
    image_.spacing_mm = volume.spacing_mm();
    cases::store_image(folder_.path(), 1, images::encoded(volume), image_);
  }
  std::optional<painting::Painting> load(PaintStore& store, bool read_only = false,
                                         std::vector<CaseBone> bones = {}) {
    store.open(folder_.path(), image_, read_only, std::move(bones));
    for (int i = 0; i < 4000 && store.is_loading(); ++i) {
      if (auto loaded = store.take_loaded()) return loaded;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::nullopt;
  }
  static void paint(painting::Painting& painting, double x) {
    painting.paint(Layer::Strokes, {{x, 5, 4}, {x, 9, 4}, Eigen::Vector3d::UnitZ(), {2, false}},
                   painting::kFemur, "stroke", false);
  }
  const test::TemporaryFolder folder_;
  cases::CaseImage image_;
};

// While the hand moves nothing is written; when it rests, all of it; the next program begins with that.
TEST_F(PaintStoreTest, WhatIsPaintedIsKeptWhenTheHandRests) {
  painting::Labels strokes;
  {
    PaintStore store([] {});
    auto painting = load(store);
    ASSERT_TRUE(painting) << store.failure();
    EXPECT_TRUE(store.is_saved(*painting));
    paint(*painting, 5);
    store.keep(*painting, 10.0);
    paint(*painting, 9);
    store.keep(*painting, 10.3);
    store.keep(*painting, 10.6);
    EXPECT_FALSE(std::filesystem::exists(painting::strokes_file(folder_.path())));
    EXPECT_FALSE(store.is_saved(*painting));
    store.keep(*painting, 10.8);
    for (int i = 0; i < 4000 && !store.is_saved(*painting); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(store.is_saved(*painting));
    strokes = painting->labels(Layer::Strokes);
  }
  PaintStore store([] {});
  const auto painting = load(store);
  ASSERT_TRUE(painting);
  EXPECT_EQ(painting->labels(Layer::Strokes), strokes);
  EXPECT_FALSE(painting->can_undo());
}

TEST_F(PaintStoreTest, AtTheEndNothingIsLeftUnsaved) {
  PaintStore store([] {});
  auto painting = load(store);
  ASSERT_TRUE(painting);
  paint(*painting, 5);
  store.keep_now(*painting);
  EXPECT_TRUE(store.is_saved(*painting));
  const auto saved = painting::load_painting(folder_.path(), painting->volume());
  ASSERT_TRUE(saved);
  EXPECT_EQ(saved->strokes, painting->labels(Layer::Strokes));
}

// The case's bones are what is painted, without a step; going away writes nothing, one stroke changes its
// bone alone, and what was painted then is gone on with.
TEST_F(PaintStoreTest, BeginsWithTheBonesOfTheCase) {
  const auto bones = [] {
    return std::vector<CaseBone>{
        {bones::BoneKind::Femur,
         std::make_shared<const geometry::TriangleMesh>(test::box({4, 4, 4}, {9.7, 9.7, 12.3}))},
        {bones::BoneKind::Tibia,
         std::make_shared<const geometry::TriangleMesh>(test::box({4, 4, 3}, {9.7, 9.7, 3.1}))}};
  };
  {
    PaintStore store([] {});
    auto painting = load(store, false, bones());
    ASSERT_TRUE(painting) << store.failure();
    EXPECT_EQ(std::ranges::count(painting->labels(Layer::Bones), painting::kFemur), 8 * 8 * 4);
    EXPECT_EQ(std::ranges::count(painting->labels(Layer::Bones), painting::kTibia), 8 * 8 * 3);
    EXPECT_FALSE(painting->can_undo());
    EXPECT_THAT(store.unchanged(*painting),
                testing::ElementsAre(bones::BoneKind::Femur, bones::BoneKind::Tibia));
    store.keep(*painting, 10);
    store.keep(*painting, 20);
    store.keep_now(*painting);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "painting"));

    painting->paint(Layer::Bones, {{9, 9, 12}, {9, 9, 12}, Eigen::Vector3d::UnitZ(), {2, false}},
                    painting::kNothing, "erase", false);
    EXPECT_THAT(store.unchanged(*painting), testing::ElementsAre(bones::BoneKind::Tibia));
    painting->undo();
    EXPECT_EQ(store.unchanged(*painting).size(), 2U);
    painting->redo();
    store.keep_now(*painting);
  }
  PaintStore store([] {});
  auto painting = load(store, false, bones());
  ASSERT_TRUE(painting);
  EXPECT_LT(std::ranges::count(painting->labels(Layer::Bones), painting::kFemur), 8 * 8 * 4);
  EXPECT_THAT(store.unchanged(*painting), testing::ElementsAre(bones::BoneKind::Tibia));
  store.note_made(*painting);
  EXPECT_EQ(store.unchanged(*painting).size(), 2U);
}

// A painting that cannot be read is not painted over: it may be all that there is of an afternoon.
TEST_F(PaintStoreTest, WhatCannotBeReadIsSaidAndLeftAlone) {
  std::filesystem::create_directory(folder_ / "painting");
  std::ofstream(painting::bones_file(folder_.path())) << "no label map";
  PaintStore store([] {});
  auto painting = load(store);
  ASSERT_TRUE(painting);
  EXPECT_THAT(store.failure(), testing::HasSubstr("left alone"));
  paint(*painting, 5);
  store.keep_now(*painting);
  EXPECT_FALSE(std::filesystem::exists(painting::strokes_file(folder_.path())));
  EXPECT_THAT(store.failure(), testing::HasSubstr("left alone"));
}

// A disk that was full and is not any more: at the end, and by itself after some seconds.
TEST_F(PaintStoreTest, WhatCouldNotBeSavedIsSavedLater) {
  const auto in_the_way = folder_ / "painting";
  PaintStore store([] {});
  auto painting = load(store);
  ASSERT_TRUE(painting);
  std::ofstream(in_the_way) << "no folder";
  paint(*painting, 5);
  store.keep_now(*painting);
  EXPECT_FALSE(store.is_saved(*painting));
  EXPECT_NE(store.failure(), "");
  std::filesystem::remove(in_the_way);
  store.keep_now(*painting);
  EXPECT_TRUE(store.is_saved(*painting));
  EXPECT_EQ(store.failure(), "");

  std::filesystem::remove_all(in_the_way);
  std::ofstream(in_the_way) << "no folder";
  paint(*painting, 9);
  store.keep_now(*painting);
  ASSERT_FALSE(store.is_saved(*painting));
  std::filesystem::remove(in_the_way);
  store.keep(*painting, 100);
  for (int i = 0; i < 4000 && !store.is_saved(*painting); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(store.is_saved(*painting));
}

TEST_F(PaintStoreTest, AReadOnlyCaseIsNotWrittenInto) {
  PaintStore store([] {});
  auto painting = load(store, true);
  ASSERT_TRUE(painting);
  paint(*painting, 5);
  store.keep_now(*painting);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "painting"));
}

TEST_F(PaintStoreTest, ImagesThatAreLostAreSaid) {
  std::filesystem::remove(folder_ / image_.file);
  PaintStore store([] {});
  EXPECT_FALSE(load(store));
  EXPECT_THAT(store.failure(), testing::HasSubstr("lost its images"));
}

TEST(ImageToPaint, IsTheNewestGreyOne) {
  cases::Case knee;
  EXPECT_FALSE(image_to_paint(knee));
  knee.images = {{.file = "a"}, {.file = "b"}, {.file = "c", .is_label_map = true}};
  EXPECT_EQ(image_to_paint(knee)->file, "b");
}

}  // namespace
}  // namespace arthronaut::paint
