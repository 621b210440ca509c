// Ten strokes in an MR that is made from known labels: how near the grown bones come, and how long each thing
// takes that one does while painting.
//
//   painting_accuracy [LABELS FEMUR TIBIA [N]]   a label map and its numbers; none: the built-in knee. N: so
//                                                many slices make one, as thick as in most MRs of knees
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <string>

#include "planning/geometry/surface.h"
#include "planning/images/bone_surface.h"
#include "planning/images/volume_file.h"
#include "planning/painting/label_edits.h"
#include "planning/painting/painting.h"
#include "planning/painting/painting_file.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/planning/segmentation/known_ct.h"
#include "tests/planning/segmentation/known_mr.h"
#include "tests/temporary_folder.h"

namespace {

using namespace arthronaut;

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The built-in knee in 384 x 384 x 160 voxels.
images::Volume built_in_labels() {
  const auto knee = phantom::make_phantom_knee();
  const auto low = geometry::bounds_of(knee.tibia.mesh).min_mm,
             high = geometry::bounds_of(knee.femur.mesh).max_mm;
  images::Volume labels;
  labels.size = {384, 384, 160};
  const Eigen::Vector3d first(-60, -60, low.z() - 5), last(60, 60, high.z() + 5);
  labels.lps_from_index.linear() = (last - first).cwiseQuotient(Eigen::Vector3d(383, 383, 159)).asDiagonal();
  labels.lps_from_index.translation() = first;
  labels.values.assign(static_cast<std::size_t>(labels.size.cast<std::int64_t>().prod()), 0.0F);
  const auto femur = test::coverage(knee.femur.mesh, labels, 2),
             tibia = test::coverage(knee.tibia.mesh, labels, 2);
  for (std::size_t v = 0; v < femur.size(); ++v)
    labels.values[v] = femur[v] > 0.5F ? 5.0F : tibia[v] > 0.5F ? 6.0F : 0.0F;
  return labels;
}

double dice(const painting::Labels& labels, const images::Volume& truth, int label) {
  std::size_t all = 0, both = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const bool is_grown = labels[v] == label, is_true = truth.values[v] == static_cast<float>(label);
    all += is_grown + is_true;
    both += is_grown && is_true;
  }
  return 2.0 * static_cast<double>(both) / static_cast<double>(all);
}

// So many slices make one: what each holds is as it was, by the mean of the grey or by the most frequent
// label.
images::Volume in_thick_slices(const images::Volume& fine, int slices, bool is_label) {
  images::Volume thick = fine;
  thick.size.z() = fine.size.z() / slices;
  thick.lps_from_index.translation() = fine.lps_from_index * Eigen::Vector3d(0, 0, 0.5 * (slices - 1));
  thick.lps_from_index.linear().col(2) *= slices;
  thick.values.resize(static_cast<std::size_t>(thick.size.cast<std::int64_t>().prod()));
  std::vector<float> stack(static_cast<std::size_t>(slices));
  for (int k = 0; k < thick.size.z(); ++k) {
    for (int j = 0; j < thick.size.y(); ++j) {
      for (int i = 0; i < thick.size.x(); ++i) {
        for (int s = 0; s < slices; ++s) stack[static_cast<std::size_t>(s)] = fine.at(i, j, slices * k + s);
        float& value = thick.values[thick.index(i, j, k)];
        if (is_label) {
          value = *std::max_element(stack.begin(), stack.end(), [&](float one, float other) {
            return std::count(stack.begin(), stack.end(), one) <
                   std::count(stack.begin(), stack.end(), other);
          });
        } else {
          value = std::accumulate(stack.begin(), stack.end(), 0.0F) / static_cast<float>(slices);
        }
      }
    }
  }
  return thick;
}

struct Distances {
  double median_mm = 0, most_mm = 0;  // 95 % are within that
};
Distances distances(const geometry::TriangleMesh& made, const geometry::Surface& exact) {
  std::vector<double> off;
  for (const auto& p : made.vertices_mm) off.push_back((exact.closest_point(p).point_mm - p).norm());
  std::sort(off.begin(), off.end());
  return {off[off.size() / 2], off[off.size() * 95 / 100]};
}

void measure_growth(const images::Volume& exact_labels, const std::vector<int>& bones, int slices) {
  const images::Volume truth = in_thick_slices(exact_labels, slices, true);
  const painting::Labels strokes = test::strokes(truth, bones);
  for (const double noise : {20.0, 40.0}) {
    // The noise of a slice does not fall with its thickness: that is what it is made thick for, and used up.
    const images::Volume mr =
        in_thick_slices(test::known_mr(exact_labels, noise * std::sqrt(slices)), slices, false);
    images::Volume grown = truth;
    painting::Labels labels;
    const double took = seconds([&] { labels = segmentation::grow_from_seeds(mr, strokes); });
    grown.values.assign(labels.begin(), labels.end());
    for (const int bone : bones) {
      const geometry::Surface exact(images::surface_of_label(exact_labels, bone).mesh);
      const Distances off = distances(images::surface_of_label(grown, bone).mesh, exact);
      const Distances least = distances(images::surface_of_label(truth, bone).mesh, exact);
      std::printf(
          "noise %2.0f, label %d: Dice %.4f, surface median %.3f mm, 95 %% %.3f mm (of the exact labels "
          "%.3f, %.3f), growing %.1f s\n",
          noise, bone, dice(labels, truth, bone), off.median_mm, off.most_mm, least.median_mm, least.most_mm,
          took);
    }
  }
}

void measure_edits(const images::Volume& truth, const std::vector<int>& bones) {
  painting::Painting painting(std::make_shared<const images::Volume>(truth));
  painting::Labels labels(truth.values.size(), painting::kNothing), strokes = labels;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (truth.values[v] == static_cast<float>(bones[0])) labels[v] = painting::kFemur;
    if (truth.values[v] == static_cast<float>(bones[1])) labels[v] = painting::kTibia;
  }
  const painting::Labels painted = test::strokes(truth, bones);
  for (std::size_t v = 0; v < strokes.size(); ++v)
    strokes[v] = painted[v] == bones[0] ? painting::kFemur : painted[v] == bones[1] ? painting::kTibia : 0;
  const auto say = [](const char* what, double took_s) {
    std::printf("%-34s %8.1f ms\n", what, 1000 * took_s);
  };
  say("take a grown knee (a step)", seconds([&] { painting.put(painting::Layer::Bones, labels, "grown"); }));
  const Eigen::Vector3d middle = truth.lps_from_index * Eigen::Vector3d(0.5 * truth.size.cast<double>());
  say("a move of a 6 mm disc", seconds([&] {
        painting.paint(painting::Layer::Bones,
                       {middle, middle + Eigen::Vector3d(2, 0, 0), Eigen::Vector3d::UnitZ(), {}},
                       painting::kNothing, "erase", false);
      }));
  say("a move of a 20 mm ball", seconds([&] {
        painting.paint(painting::Layer::Bones,
                       {middle, middle + Eigen::Vector3d(2, 0, 0), Eigen::Vector3d::UnitZ(), {10, true}},
                       painting::kNothing, "erase", false);
      }));
  say("undo of the grown knee", seconds([&] { painting.go_to(0); }));
  say("keep the largest piece", seconds([&] { painting::keep_largest(labels, truth, painting::kFemur); }));
  say("fill holes", seconds([&] { painting::fill_holes(labels, truth, painting::kFemur); }));
  say("close gaps of 4 mm", seconds([&] { painting::fill_holes(labels, truth, painting::kFemur, 2); }));
  say("part by strokes", seconds([&] { painting::part_by_strokes(labels, truth, strokes); }));
  say("smooth", seconds([&] { painting::smooth(labels, truth, painting::kFemur, 1); }));
  const test::TemporaryFolder folder;
  say("save (beside the screen)", seconds([&] {
        painting::save_painting(folder.path(), truth, {strokes, labels});
      }));
}

}  // namespace

int main(int count, char** arguments) {
  images::Volume truth;
  std::vector<int> bones{5, 6};
  if (count >= 4) {
    truth = images::read_volume(arguments[1]);
    bones = {std::atoi(arguments[2]), std::atoi(arguments[3])};
  } else {
    truth = built_in_labels();
  }
  std::printf("%d x %d x %d voxels\n", truth.size.x(), truth.size.y(), truth.size.z());
  const int slices = count == 5 ? std::atoi(arguments[4]) : 1;
  if (slices < 1 || slices > truth.size.z()) {
    std::fprintf(stderr, "N is the number of slices that make one\n");
    return 2;
  }
  measure_growth(truth, bones, slices);
  if (slices == 1) measure_edits(truth, bones);
  return 0;
}
