#include "navigation/registration/bone/surface_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "navigation/registration/bone/reachable_region.h"
#include "planning/files/atomic_file.h"
#include "tests/navigation/registration/phantom_bone.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::registration {

namespace {

class SurfaceIndexCache : public testing::Test {
 protected:
  // What registering makes of the bone, to the last bit.
  static Eigen::Vector3d found_with(const SurfaceIndex& bone) {
    const auto trial = phantom_bone().trial(experiments::TrialNoise::Dry, 1);
    return register_curves(bone, trial.curves, {1, true, phantom_bone().target_mm})
        .marker_from_bone.translation_mm;
  }

  // Small, so that it is made ready in no time.
  static geometry::TriangleMesh octahedron() { return test::octahedron(15); }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "cache" / "femur.prepared";
};

}  // namespace

// The first use writes the cache, the second reads it and leaves it alone, and both register alike.
TEST_F(SurfaceIndexCache, ReadsWhatItWrote) {
  const Eigen::Vector3d fresh = found_with(*phantom_bone().prepared);
  EXPECT_EQ(found_with(SurfaceIndex(phantom_bone().mesh, file_)), fresh);
  ASSERT_TRUE(std::filesystem::exists(file_));
  const auto written = std::filesystem::last_write_time(file_);
  EXPECT_EQ(found_with(SurfaceIndex(phantom_bone().mesh, file_)), fresh);
  EXPECT_EQ(std::filesystem::last_write_time(file_), written);
}

// A file that was cut off, or in which one byte is another, is made again without a word.
TEST_F(SurfaceIndexCache, MakesABrokenFileAgain) {
  const SurfaceIndex first(octahedron(), file_);
  const std::string good = files::read_text(file_);
  std::string flipped = good;
  flipped[good.size() / 2] ^= 1;
  for (const std::string& broken :
       {good.substr(0, good.size() / 2), good.substr(0, 5), std::string(), flipped}) {
    std::ofstream(file_, std::ios::binary) << broken;
    const SurfaceIndex again(octahedron(), file_);
    EXPECT_EQ(files::read_text(file_), good);
  }
}

// A vertex moved by a hundredth of a millimetre is another bone.
TEST_F(SurfaceIndexCache, KnowsItsMesh) {
  const SurfaceIndex first(octahedron(), file_);
  const std::string before = files::read_text(file_);
  geometry::TriangleMesh other = octahedron();
  other.vertices_mm[0].x() += 0.01;
  const SurfaceIndex second(other, file_);
  EXPECT_NE(files::read_text(file_), before);
}

// Where nothing can be written, here below a file instead of a folder, or not even looked for, below a link
// that leads in a circle, the bone is prepared all the same.
TEST_F(SurfaceIndexCache, DoesWithoutAFileThatCannotBeWritten) {
  std::ofstream(folder_ / "cache") << "a file";
  std::filesystem::create_symlink("loop", folder_ / "loop");
  for (const std::filesystem::path& file : {file_, folder_ / "loop" / "femur.prepared"}) {
    const SurfaceIndex bone(octahedron(), file);
    EXPECT_NEAR(bone.data().field.sample({0, 0, 15.5}).distance_mm, 0.5, 0.05);
  }
}

// What lies at the entry and looks the same way can be touched; what is far away, or not there, cannot.
TEST(ReachableRegion, IsNearTheEntryAndOpen) {
  const PhantomBone& bone = phantom_bone();
  const auto reachable = find_reachable_samples(bone.prepared->data(), bone.target_mm);
  const auto& samples = bone.prepared->data().pairs.samples();
  ASSERT_EQ(reachable.size(), samples.size());
  const Eigen::Vector3f normal = bone.surface->closest_point(bone.target_mm).normal.cast<float>();
  int near_count = 0, open_count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float away_mm = (samples[i].point_mm - bone.target_mm.cast<float>()).norm();
    if (away_mm > 41) {
      EXPECT_FALSE(reachable[i]);
    }
    if (away_mm > 8 || samples[i].normal.dot(normal) < 0.7f) continue;
    ++near_count;
    open_count += reachable[i];
  }
  EXPECT_GT(near_count, 5);
  EXPECT_GT(open_count, 0.9 * near_count);
  const auto nowhere =
      find_reachable_samples(bone.prepared->data(), bone.target_mm + Eigen::Vector3d(500, 0, 0));
  EXPECT_EQ(std::count(nowhere.begin(), nowhere.end(), true), 0);
}

}  // namespace arthronaut::registration
