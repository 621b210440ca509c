// Painting bones from outside, as a hand does it: strokes over an MR, grown, taken, a crash, surfaces, a
// case.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <thread>

#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/images/volume_writer.h"
#include "planning/painting/painting_file.h"
#include "planning/phantom/phantom_case.h"
#include "tests/app/window/display.h"
#include "tests/planning/segmentation/known_ct.h"
#include "tests/planning/segmentation/known_mr.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {
namespace {

using Eigen::Vector3d;

// The built-in knee as labels 5 and 6, in voxels of about 1 mm.
struct KnownKnee {
  phantom::PhantomKnee knee = phantom::make_phantom_knee();
  images::Volume labels;

  KnownKnee() {
    const auto low = geometry::bounds_of(knee.tibia.mesh).min_mm,
               high = geometry::bounds_of(knee.femur.mesh).max_mm;
    labels.lps_from_index.linear() = Vector3d(0.9, 0.9, 1.2).asDiagonal();
    labels.lps_from_index.translation() = Vector3d(-50, -45, low.z() - 5);
    labels.size = {112, 100, static_cast<int>((high.z() - low.z() + 10) / 1.2)};
    labels.values.assign(static_cast<std::size_t>(labels.size.cast<std::int64_t>().prod()), 0.0F);
    const auto femur = coverage(knee.femur.mesh, labels, 2), tibia = coverage(knee.tibia.mesh, labels, 2);
    for (std::size_t v = 0; v < femur.size(); ++v)
      labels.values[v] = femur[v] > 0.5F ? 5.0F : tibia[v] > 0.5F ? 6.0F : 0.0F;
  }
  [[nodiscard]] double dice(const painting::Labels& painted, std::uint8_t label, float truth) const {
    std::size_t both = 0, all = 0;
    for (std::size_t v = 0; v < painted.size(); ++v) {
      both += painted[v] == label && labels.values[v] == truth;
      all += (painted[v] == label) + (labels.values[v] == truth);
    }
    return 2.0 * static_cast<double>(both) / static_cast<double>(all);
  }
};

class PaintWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_for_window_tests(); !missing.empty()) GTEST_SKIP() << missing;
    make_case(known_mr(known_.labels, 20));
  }
  void make_case(const images::Volume& image) const {
    cases::Case knee;
    knee.name = "Painted knee";
    knee.side = known_.knee.side;
    knee.created_utc = "2026-01-31T12:00:00Z";
    knee.images.push_back({.file = "",
                           .modality = image.modality_in_file,
                           .source = "NRRD",
                           .is_label_map = false,
                           .size = image.size,
                           .spacing_mm = image.spacing_mm()});
    std::filesystem::create_directories(case_folder());
    cases::store_image(case_folder(), 1, images::encoded(image), knee.images.back());
    cases::save_case(case_folder(), knee);
  }
  [[nodiscard]] std::filesystem::path case_folder() const { return folder_ / "Painted.arthro"; }
  // Where a point of the volume lies in a pane that shows the whole volume.
  // (The CT's grid is a little larger about the same middle.)
  [[nodiscard]] std::pair<int, int> pixel(const Area& pane, const Vector3d& right, const Vector3d& down,
                                          const Vector3d& point_mm) const {
    const Vector3d last = (known_.labels.size.array() - 1).cast<double>();
    const Vector3d center = known_.labels.lps_from_index * Vector3d(0.5 * last);
    const Vector3d extent = last.cwiseProduct(known_.labels.spacing_mm());
    const double mm_per_px = std::max(extent.dot(right.cwiseAbs()), extent.dot(down.cwiseAbs())) /
                             std::min(pane.width, pane.height);
    const Vector3d from_center = (point_mm - center) / mm_per_px;
    return {pane.x + pane.width / 2 + static_cast<int>(std::lround(from_center.dot(right))),
            pane.y + pane.height / 2 + static_cast<int>(std::lround(from_center.dot(down)))};
  }
  // A stroke in a pane, in the slice through the volume's middle.
  void stroke(const RunningWorkstation& app, const std::string& widget, const Vector3d& from,
              const Vector3d& to) const {
    const bool is_sagittal = widget == "paint.sagittal_slice";
    const Vector3d right = is_sagittal ? Vector3d::UnitY() : Vector3d::UnitX(), down = -Vector3d::UnitZ();
    const Area pane = app.widgets().at(widget);
    const auto [x0, y0] = pixel(pane, right, down, from);
    const auto [x1, y1] = pixel(pane, right, down, to);
    app.drag(x0, y0, x1, y1);
  }
  [[nodiscard]] Vector3d at(double x, double y, double z) const {  // shares of the volume
    return known_.labels.lps_from_index *
           Vector3d((known_.labels.size.array() - 1).cast<double>() * Vector3d(x, y, z).array());
  }
  const TemporaryFolder folder_;
  const KnownKnee known_;
};

// Of a case that another program had what it left is gone on with, not what was there when it was opened.
TEST_F(PaintWindow, ACaseThatBecomesFreeIsPaintedOnAsItWasLeft) {
  const VirtualDisplay display(1280, 720);
  auto theirs = std::make_unique<cases::CaseLock>(case_folder());
  ASSERT_TRUE(theirs->is_held());
  RunningWorkstation app(display, folder_.path(), {case_folder().string()});
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
  ASSERT_TRUE(app.wait_for_state("access", "read-only"));
  painting::SavedPainting painted;
  painted.bones.assign(known_.labels.values.size(), 0);
  painted.strokes = painted.bones;
  std::fill_n(painted.bones.begin() + static_cast<std::ptrdiff_t>(painted.bones.size() / 2), 500,
              painting::kFemur);
  painting::save_painting(case_folder(), known_.labels, painted);
  theirs.reset();
  ASSERT_TRUE(app.wait_for_state("access", "own", 60));
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
  ASSERT_TRUE(app.wait_for_widget("paint.coronal_slice", 20));
  app.press("1");
  stroke(app, "paint.coronal_slice", at(0.4, 0.5, 0.8), at(0.6, 0.5, 0.8));
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint femur bone"));
  EXPECT_TRUE(app.wait_for_state("paint_saved", "yes", 60));
  const auto kept = painting::load_painting(case_folder(), known_.labels);
  EXPECT_GT(std::ranges::count(kept->bones, painting::kFemur), 500) << "theirs, and what was added";
}

TEST_F(PaintWindow, StrokesBecomeTheBonesOfTheCaseAndACrashLosesNothing) {
  const VirtualDisplay display(1600, 900);
  {
    RunningWorkstation app(display, folder_.path(), {case_folder().string()});
    ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
    EXPECT_EQ(app.state("screen"), "paint");
    ASSERT_TRUE(app.wait_for_widget("paint.sagittal_slice"));
    EXPECT_EQ(app.state("paint_next"), "Paint a few strokes into the femur (1) on two or three slices");
    const auto paint = [&](const char* key, const std::string& what, const std::string& pane,
                           const Vector3d& from, const Vector3d& to) {
      app.press(key);
      stroke(app, pane, from, to);
      return app.wait_for_state("paint_undo", what, 20);
    };
    const std::string sagittal = "paint.sagittal_slice", coronal = "paint.coronal_slice";
    ASSERT_TRUE(paint("1", "Paint femur stroke", coronal, at(0.5, 0.5, 0.9), at(0.5, 0.5, 0.75)));
    ASSERT_TRUE(paint("2", "Paint tibia stroke", coronal, at(0.5, 0.5, 0.1), at(0.5, 0.5, 0.3)));
    ASSERT_TRUE(paint("3", "Paint surroundings stroke", coronal, at(0.03, 0.5, 0.05), at(0.03, 0.5, 0.95)));
    app.press("ctrl+z");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint tibia stroke"));
    app.press("ctrl+y");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint surroundings stroke"));
    stroke(app, coronal, at(0.97, 0.5, 0.05), at(0.97, 0.5, 0.95));
    stroke(app, sagittal, at(0.5, 0.03, 0.05), at(0.5, 0.03, 0.95));
    stroke(app, sagittal, at(0.5, 0.97, 0.05), at(0.5, 0.97, 0.95));
    app.press("g");
    ASSERT_TRUE(app.wait_for_state("paint_preview", "grown", 120));
    app.press("Return");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Grow the bones"));
    ASSERT_TRUE(app.wait_for_state("paint_saved", "yes", 60));
    app.kill();
  }
  const auto saved = painting::load_painting(case_folder(), known_.labels);
  ASSERT_TRUE(saved);
  EXPECT_GT(known_.dice(saved->bones, painting::kFemur, 5), 0.97);
  EXPECT_GT(known_.dice(saved->bones, painting::kTibia, 6), 0.97);
  RunningWorkstation app(display, folder_.path(), {case_folder().string()});
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
  app.press("a");
  ASSERT_TRUE(app.wait_for_state("making", "judging", 240)) << app.state("paint_hint");
  ASSERT_TRUE(app.wait_for_widget("paint.accept"));
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("screen", "mode", 240));
  ASSERT_TRUE(app.wait_for_widget("plan.view", 120));
  EXPECT_EQ(app.state("access"), "own");
  const cases::Case made = cases::load_case(case_folder());
  ASSERT_EQ(made.bones.size(), 2U);
  for (const auto& [kind, truth] : {std::pair{bones::BoneKind::Femur, known_.knee.femur.mesh},
                                    {bones::BoneKind::Tibia, known_.knee.tibia.mesh}}) {
    const auto distances = distances_to(truth, made.bones.at(kind).mesh, 3);
    EXPECT_LT(distances[distances.size() / 2], 0.3);
  }
  // Back into the painting, from Plan by its key.
  app.press("i");
  ASSERT_TRUE(app.wait_for_state("screen", "paint"));
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 60));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("screen", "mode"));
}

// Strokes need no mouse: the brush stands at the framed slice's cross-hair, and paints along while it is
// down.
TEST_F(PaintWindow, StrokesArePaintedByKeys) {
  const VirtualDisplay display(1280, 720);
  {
    RunningWorkstation app(display, folder_.path(), {case_folder().string()});
    ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
    const std::string pane = app.state("paint_keyed_pane"), middle = app.state("paint_cross");
    const auto leaves = [&](const std::string& cross) {
      for (int i = 0; i < 200 && app.state("paint_cross") == cross; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      return app.state("paint_cross") != cross;
    };
    app.press("shift+Next");
    ASSERT_TRUE(leaves(middle)) << "another image";
    app.press("shift+Prior");
    ASSERT_TRUE(app.wait_for_state("paint_cross", middle));
    app.press("shift+S");
    app.press("shift+S");
    app.press("shift+S");
    ASSERT_TRUE(app.wait_for_state("paint_keyed_pane", pane)) << "round";
    app.press("alt+Up");
    ASSERT_TRUE(leaves(middle));
    EXPECT_EQ(app.state("paint_undo"), "") << "it is lifted";
    app.press("2");
    app.press("space");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint tibia stroke"));
    for (int i = 0; i < 5; ++i) app.press("alt+Right");
    app.press("3");
    app.press("alt+Right");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint surroundings stroke"));
    app.press("ctrl+z");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint tibia stroke")) << "all of it one step";
    app.press("space");
    const std::string end = app.state("paint_cross");
    app.press("alt+Right");
    ASSERT_TRUE(leaves(end));
    EXPECT_EQ(app.state("paint_undo"), "Paint tibia stroke");
    ASSERT_TRUE(app.wait_for_state("paint_saved", "yes", 60));
  }
  const auto saved = painting::load_painting(case_folder(), known_.labels);
  ASSERT_TRUE(saved);
  EXPECT_GT(std::ranges::count(saved->strokes, painting::kTibia), 20) << "more than where it was lowered";
  EXPECT_EQ(std::ranges::count(saved->strokes, painting::kSurroundings), 0);
}

// A CT: the threshold's preview is moved and taken, femur and tibia, which are one label then, are parted by
// a stroke in the marrow of each, their shells are closed and filled, and the surfaces lie at the edge that
// the CT shows.
TEST_F(PaintWindow, ThresholdAndPartingMakeTheBonesOfACt) {
  // Of the grid of the labels: soft tissue, a cortex of two voxels, marrow.
  images::Volume ct = known_.labels;
  KnownCtOptions options;
  options.spacing_mm = ct.spacing_mm();
  options.cortex_mm = 2.5;
  options.blur_mm = 0.5;
  ct = known_ct({known_.knee.femur.mesh, known_.knee.tibia.mesh}, options);
  std::filesystem::remove_all(case_folder());
  make_case(ct);
  const VirtualDisplay display(1600, 900);
  RunningWorkstation app(display, folder_.path(), {case_folder().string()});
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
  ASSERT_TRUE(app.wait_for_widget("paint.coronal_slice"));
  app.press("t");
  ASSERT_TRUE(app.wait_for_state("paint_preview", "threshold"));
  const int threshold = std::stoi(app.state("paint_threshold"));
  app.press("Up");
  ASSERT_TRUE(app.wait_for_state("paint_threshold", std::to_string(threshold + 10)));
  app.press("Return");
  ASSERT_TRUE(
      app.wait_for_state("paint_undo", "Take the threshold of " + std::to_string(threshold + 10), 60));
  app.press("s");
  ASSERT_TRUE(app.wait_for_state("paint_brush", "femur on strokes"));
  stroke(app, "paint.coronal_slice", at(0.5, 0.5, 0.85), at(0.5, 0.5, 0.75));
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint femur stroke"));
  app.press("2");
  ASSERT_TRUE(app.wait_for_state("paint_brush", "tibia on strokes"));
  stroke(app, "paint.coronal_slice", at(0.5, 0.5, 0.15), at(0.5, 0.5, 0.3));
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint tibia stroke"));
  EXPECT_EQ(app.state("paint_next"), "Part the bones by their strokes (P), or go on with this one alone (A)");
  app.press("p");
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Part the bones", 60));
  for (const auto& [key, bone] : {std::pair{"1", "femur"}, {"2", "tibia"}}) {
    app.press(key);
    ASSERT_TRUE(app.wait_for_state("paint_brush", std::string(bone) + " on bones"));
    app.press("shift+h");
    ASSERT_TRUE(app.wait_for_state("paint_undo", "Close the gaps of the " + std::string(bone), 60));
  }
  app.press("a");
  ASSERT_TRUE(app.wait_for_state("making", "judging", 240)) << app.state("paint_hint");
  app.press("Return");
  ASSERT_TRUE(app.wait_for_state("screen", "mode", 240));
  const cases::Case made = cases::load_case(case_folder());
  ASSERT_EQ(made.bones.size(), 2U);
  for (const auto& [kind, truth] : {std::pair{bones::BoneKind::Femur, known_.knee.femur.mesh},
                                    {bones::BoneKind::Tibia, known_.knee.tibia.mesh}}) {
    const auto distances = distances_to(truth, made.bones.at(kind).mesh, 3);
    EXPECT_LT(distances[distances.size() / 2], 0.12);  // as asked of a CT's import
  }
}

// Brush and eraser on the bones themselves, its size by keys, whole-map edits with their undo.
TEST_F(PaintWindow, BonesAreCorrectedByBrushAndEraser) {
  const VirtualDisplay display(1600, 900);
  RunningWorkstation app(display, folder_.path(), {case_folder().string()});
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
  ASSERT_TRUE(app.wait_for_widget("paint.coronal_slice"));
  app.press("b");
  ASSERT_TRUE(app.wait_for_state("paint_brush", "femur on bones"));
  const std::string before = app.state("brush_mm");
  app.press("equal");
  ASSERT_TRUE(app.wait_for_state("brush_mm", "3.75"));
  EXPECT_EQ(before, "3.00");
  stroke(app, "paint.coronal_slice", at(0.5, 0.5, 0.9), at(0.5, 0.5, 0.75));
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Paint femur bone"));
  stroke(app, "paint.coronal_slice", at(0.8, 0.5, 0.5), at(0.8, 0.5, 0.52));
  app.press("i");
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Keep the largest piece of the femur", 60));
  app.press("e");
  stroke(app, "paint.coronal_slice", at(0.5, 0.5, 0.9), at(0.5, 0.5, 0.85));
  ASSERT_TRUE(app.wait_for_state("paint_undo", "Erase bone"));
  ASSERT_TRUE(app.wait_for_state("paint_saved", "yes", 60));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
  const auto saved = painting::load_painting(case_folder(), known_.labels);
  ASSERT_TRUE(saved);
  EXPECT_GT(std::count(saved->bones.begin(), saved->bones.end(), painting::kFemur), 0);
  EXPECT_EQ(std::count(saved->strokes.begin(), saved->strokes.end(), 0), std::ssize(saved->strokes));
}

// From Plan: at the joint, with the case's own bones as what is painted; there and back again writes nothing,
// not even when the surfaces are asked for.
TEST_F(PaintWindow, BeginsFromPlanWithTheBonesOfTheCaseAndLeavesThemAlone) {
  cases::Case knee = cases::load_case(case_folder());
  for (const auto* bone : {&known_.knee.femur, &known_.knee.tibia}) knee.bones[bone->kind] = *bone;
  cases::save_case(case_folder(), knee);
  const auto files = [&] {
    std::map<std::string, std::filesystem::file_time_type> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(case_folder()))
      if (entry.is_regular_file() &&
          (entry.path().extension() == ".ply" || entry.path().extension() == ".nrrd" ||
           entry.path().filename() == "plan.json"))
        found[entry.path().string()] = entry.last_write_time();
    return found;
  };
  const VirtualDisplay display(1600, 900);
  RunningWorkstation app(display, folder_.path(), {case_folder().string()});
  ASSERT_TRUE(app.wait_for_state("case", "open", 120));
  ASSERT_TRUE(app.wait_for_widget("plan.view"));
  const auto before = files();
  app.press("i");
  ASSERT_TRUE(app.wait_for_state("painting", "ready", 120));
  EXPECT_TRUE(app.state("paint_next").starts_with("These are the bones of the case"))
      << app.state("paint_next");
  // Between femur and tibia, not in the middle of the images.
  std::string cross = app.state("paint_cross");
  cross = cross.substr(cross.rfind(' ') + 1);
  const std::string minus = "\u2212";
  const double height = cross.starts_with(minus) ? -std::stod(cross.substr(minus.size())) : std::stod(cross);
  EXPECT_NEAR(height, geometry::bounds_of(known_.knee.femur.mesh).min_mm.z(), 12);
  app.press("a");
  ASSERT_TRUE(app.wait_for_state("paint_hint", "These are the bones of the case: correct them first"));
  app.press("Escape");
  ASSERT_TRUE(app.wait_for_state("screen", "mode"));
  app.press("ctrl+q");
  EXPECT_EQ(app.wait_for_exit(30), 0);
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace arthronaut::test
