#include "app/scene/scene_view.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <Eigen/Geometry>
#include <cstdlib>

#include "app/scene/drawn_volume.h"
#include "app/scene/offscreen_context.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::scene {
namespace {

using Eigen::Vector3d;

// A body that is its own mirror image in no plane: two ellipsoids that overlap.
struct Lump {
  Vector3d center_mm, radii_mm;
};
constexpr double kThreshold = 250;
const std::vector<Lump>& lumps() {
  static const std::vector<Lump> made{{{4, -6, 10}, {22, 30, 38}}, {{26, 12, 30}, {16, 12, 10}}};
  return made;
}

std::vector<BoneItem> meshes() {
  std::vector<BoneItem> items;
  for (const Lump& lump : lumps())
    items.push_back(
        {std::make_shared<const geometry::TriangleMesh>(test::ellipsoid(lump.radii_mm, 5, lump.center_mm))});
  return items;
}

// Its surface lies where the values cross the threshold, as steep as a cortex in a CT.
double value_in(const Vector3d& x_mm) {
  double nearest = 1e9;
  for (const Lump& lump : lumps()) {
    const double k = (x_mm - lump.center_mm).cwiseQuotient(lump.radii_mm).norm();
    nearest = std::min(nearest, (k - 1) * lump.radii_mm.minCoeff());
  }
  return std::clamp(kThreshold - 500 * nearest, -1000.0, 1500.0);
}

images::Volume volume_of(const Eigen::Matrix3d& directions, const Vector3d& spacing_mm) {
  images::Volume volume;
  volume.modality = images::Modality::Ct;
  volume.lps_from_index.linear() = directions * spacing_mm.asDiagonal();
  const Vector3d middle(10, 0, 15);
  volume.size = (Vector3d(130, 130, 130).cwiseQuotient(spacing_mm)).cast<int>();
  volume.lps_from_index.translation() =
      middle -
      volume.lps_from_index.linear() * (0.5 * (volume.size - Eigen::Vector3i::Ones()).cast<double>());
  for (int k = 0; k < volume.size.z(); ++k)
    for (int j = 0; j < volume.size.y(); ++j)
      for (int i = 0; i < volume.size.x(); ++i)
        volume.values.push_back(static_cast<float>(value_in(volume.lps_from_index * Vector3d(i, j, k))));
  return volume;
}

const geometry::Bounds kAround{{-60, -60, -60}, {80, 60, 90}};
constexpr int kSize_px = 480;
constexpr double kAway_mm = 420;

SceneContent content_of(const images::Volume& volume, std::size_t most_voxels = 100'000'000) {
  SceneContent content;
  content.volume = std::make_shared<VolumeItem>(VolumeItem{drawn_volume(volume, kAround, most_voxels)});
  return content;
}

class DrawnScene : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    context_ = std::make_unique<OffscreenContext>();
    view_ = std::make_unique<SceneView>([this] { context_->make_current(); });
    view_->set_background({0, 0, 1}, {0, 0, 1});
    view_->resize(kSize_px, kSize_px);
  }
  Image picture(const SceneContent& content, const Vector3d& direction) {
    view_->show(content);
    view_->look(look_along(direction.normalized(), {10, 0, 15}, kAway_mm, Vector3d(0.1, 0.2, 1)));
    return view_->read_image();
  }

  std::unique_ptr<OffscreenContext> context_;
  std::unique_ptr<SceneView> view_;
};

// More of the body, whose red is at least two thirds of its blue, than of the background.
bool is_drawn(const Image& image, std::size_t pixel) {
  return image.rgb[3 * pixel] > image.rgb[3 * pixel + 2] / 2;
}

// By how much one silhouette stands out over the other, as a mean along the outline.
struct Gap {
  double mean_mm = 0;  // positive: the first is the larger
  double off_mm = 0;   // either way
  double outline_px = 0;
};
Gap gap_of(const Image& first, const Image& second) {
  double only_first = 0, only_second = 0, outline = 0;
  for (std::size_t y = 1; y + 1 < kSize_px; ++y) {
    for (std::size_t x = 1; x + 1 < kSize_px; ++x) {
      const std::size_t at = y * kSize_px + x;
      const bool a = is_drawn(first, at), b = is_drawn(second, at);
      only_first += a && !b;
      only_second += b && !a;
      // Edges between pixels; on an oblique outline they are longer than it by 4 / pi on the whole.
      outline += (is_drawn(second, at + 1) != b) + (is_drawn(second, at + kSize_px) != b);
    }
  }
  outline *= M_PI / 4;
  const double mm_per_px = 2 * kAway_mm * std::tan(13 * M_PI / 180) / kSize_px;
  return {(only_first - only_second) / outline * mm_per_px, (only_first + only_second) / outline * mm_per_px,
          outline};
}

// The values rise from nothing seen to opaque within 0.12 mm about the surface; a pixel is 0.4 mm.
constexpr double kSame_mm = 0.06;

struct Axes {
  const char* name;
  Eigen::Matrix3d directions;
  Vector3d spacing_mm;
};
std::vector<Axes> axes() {
  const Eigen::Matrix3d turned =
      (Eigen::AngleAxisd(0.5, Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.4, Vector3d::UnitX()) *
       Eigen::AngleAxisd(0.3, Vector3d::UnitY()))
          .toRotationMatrix();
  Eigen::Matrix3d sagittal;  // i to the back, j to the feet, k to the left
  sagittal << 0, 0, 1, 1, 0, 0, 0, -1, 0;
  Eigen::Matrix3d tilted = Eigen::Matrix3d::Identity();  // a gantry's tilt
  tilted.col(2) = Vector3d(0, 0.26, 0.966).normalized();
  return {{"straight", Eigen::Matrix3d::Identity(), {0.8, 0.8, 0.8}},
          {"oblique", turned, {0.7, 0.7, 1.2}},
          {"sagittal", sagittal, {0.7, 0.7, 1.5}},
          {"mirrored", turned * Vector3d(1, 1, -1).asDiagonal(), {0.8, 0.9, 1.2}},
          {"sheared", tilted, {0.8, 0.8, 1.2}}};
}

// A view that is not on the screen holds next to nothing; back on it, it shows what it showed.
TEST_F(DrawnScene, LetsGoOfItsPictureUntilItIsShownAgain) {
  const auto held_mb = [] {
    const struct mallinfo2 info = ::mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd) * 1e-6;
  };
  SceneContent content;
  content.bones = meshes();
  view_->resize(2 * kSize_px, 2 * kSize_px);
  const Image shown = picture(content, {0, 1, 0});
  const double before_mb = held_mb();
  view_->let_go_of_picture();
  EXPECT_LT(held_mb(), before_mb - 10);
  view_->resize(2 * kSize_px, 2 * kSize_px);
  EXPECT_TRUE(view_->render_if_dirty());
  EXPECT_EQ(view_->read_image().rgb, shown.rgb);
}

// The volume lies exactly where the bones lie, from every side, whatever the scanner's axes were.
TEST_F(DrawnScene, AVolumeHasTheSilhouetteOfItsBody) {
  SceneContent of_meshes;
  of_meshes.bones = meshes();
  for (const Vector3d& direction : {Vector3d(0, 1, 0), Vector3d(1, 0.3, -0.2), Vector3d(-0.5, 0.6, -0.7)}) {
    const Image wanted = picture(of_meshes, direction);
    for (const Axes& of : axes()) {
      const Gap gap = gap_of(picture(content_of(volume_of(of.directions, of.spacing_mm)), direction), wanted);
      EXPECT_GT(gap.outline_px, 500) << of.name;
      EXPECT_LT(gap.off_mm, kSame_mm) << of.name << ": the volume is larger by " << gap.mean_mm << " mm";
    }
  }
}

// Fewer voxels for the speed of it: no further off than a small part of one.
TEST_F(DrawnScene, BroughtDownItStaysInItsPlace) {
  const images::Volume volume = volume_of(axes()[1].directions, axes()[1].spacing_mm);
  SceneContent of_meshes;
  of_meshes.bones = meshes();
  const Vector3d direction(1, 0.3, -0.2);
  const SceneContent coarse = content_of(volume, 500'000);
  ASSERT_LT(coarse.volume->volume->levels.size(), volume.values.size() / 4);
  const Gap gap = gap_of(picture(coarse, direction), picture(of_meshes, direction));
  EXPECT_LT(gap.off_mm, kSame_mm);
}

double share_of_green(const Image& image) {
  double count = 0;
  for (std::size_t at = 0; at < image.rgb.size(); at += 3)
    count += image.rgb[at + 1] > std::max(image.rgb[at], image.rgb[at + 2]) + 40;
  return count / static_cast<double>(image.rgb.size() / 3);
}

// A tunnel within the bone is hidden by it as by the mesh, and seen where the bone is cut away or
// translucent.
TEST_F(DrawnScene, AVolumeHidesWhatLiesBehindItsSurface) {
  SceneContent content = content_of(volume_of(axes()[1].directions, axes()[1].spacing_mm));
  const Vector3d direction(0, 1, 0), middle = lumps().front().center_mm;
  content.rods.push_back({middle - Vector3d(0, 0, 20), middle + Vector3d(0, 0, 20), 8, 8, {0, 1, 0}});
  EXPECT_EQ(share_of_green(picture(content, direction)), 0) << "hidden within";
  SceneContent beside = content;
  beside.rods.front().from_mm.y() = beside.rods.front().to_mm.y() = middle.y() - 45;
  EXPECT_GT(share_of_green(picture(beside, direction)), 0.005) << "before it";
  VolumeItem cut = *content.volume;
  cut.cuts.push_back({middle, -Vector3d::UnitY()});
  content.volume = std::make_shared<VolumeItem>(cut);
  EXPECT_GT(share_of_green(picture(content, direction)), 0.005) << "cut open to the middle";
  VolumeItem thin = *beside.volume;
  thin.opacity = 0.2;
  content.volume = std::make_shared<VolumeItem>(thin);
  EXPECT_GT(share_of_green(picture(content, direction)), 0.002) << "translucent";
}

// The threshold is a surface: 500 HU less lie a millimetre further out in this body.
TEST_F(DrawnScene, TheThresholdMovesTheSurface) {
  SceneContent content = content_of(volume_of(axes()[1].directions, axes()[1].spacing_mm));
  const Vector3d direction(0, 1, 0);
  const Image at_250 = picture(content, direction);
  VolumeItem lower = *content.volume;
  lower.threshold = kThreshold - 500;
  content.volume = std::make_shared<VolumeItem>(lower);
  const Gap gap = gap_of(picture(content, direction), at_250);
  // (k - 1) times the shortest radius grows by 1 within 1 to 1.75 mm, as the ellipsoids are long.
  EXPECT_GT(gap.mean_mm, 0.8);
  EXPECT_LT(gap.mean_mm, 1.9);
}

// An MR whose brightest value is its skin: cut open, what lies within has its own grey, and not the skin's.
TEST_F(DrawnScene, AnMrThatIsCutOpenShowsTheGreysWithin) {
  images::Volume mr = volume_of(axes()[1].directions, axes()[1].spacing_mm);
  mr.modality = images::Modality::Mr;
  const Vector3d core(10, 0, 15);
  std::size_t v = 0;
  for (int k = 0; k < mr.size.z(); ++k)
    for (int j = 0; j < mr.size.y(); ++j)
      for (int i = 0; i < mr.size.x(); ++i, ++v) {
        const float steepness = mr.values[v];  // above kThreshold within the body, by 500 a millimetre
        const bool is_core = (mr.lps_from_index * Vector3d(i, j, k) - core).norm() < 8;
        mr.values[v] = is_core ? 600.F : steepness < kThreshold ? 0.F : steepness < 1400 ? 900.F : 300.F;
      }
  SceneContent content = content_of(mr);
  VolumeItem item = *content.volume;
  item.preset = VolumePreset::Grey;
  item.threshold = first_threshold(*item.volume);
  const auto grey_in_the_middle = [&] {
    content.volume = std::make_shared<VolumeItem>(item);
    const Image image = picture(content, {0, 1, 0});
    return static_cast<int>(image.rgb[3 * (kSize_px / 2 * kSize_px + kSize_px / 2)]);
  };
  EXPECT_LT(grey_in_the_middle(), 100) << "the skin's edge, where its values pass the threshold";
  item.cuts.push_back({core, -Vector3d::UnitY()});
  EXPECT_NEAR(grey_in_the_middle(), 600.0 / 900 * 255, 8);
}

}  // namespace
}  // namespace arthronaut::scene
