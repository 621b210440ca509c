#include "planning/postop/bone_field.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <future>
#include <iterator>
#include <thread>

#include "planning/images/voxel_mask.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using geometry::RigidTransform;

constexpr double kCell_mm = 2, kRoom_mm = 30;
// Less is a splinter, or noise.
constexpr double kLeastPiece_mm3 = 2000, kLeastAnchored_mm3 = 6000;
constexpr std::size_t kMostAnchored = 5;
// Of a shaft, a few times less.
constexpr double kLeastCut_mm2 = 150;
// The gaps of a thin cortex in cells.
constexpr double kClosing_mm = 2;
// Of a piece, what belongs to the joint at its end. Bones that touch are one piece, and an image may end
// within a shaft: a joint may lie anywhere along it.
constexpr double kJointEnd_mm = 70, kAlong_mm = 15, kAnotherAnchor_mm = 5;

// Cells that are the means of so many voxels.
struct Cells {
  Vector3i factor, size, room;
  Eigen::Affine3d lps_from_cell;
  Vector3d spacing_mm;
  images::VoxelMask is_bone{Vector3i::Zero()};
};

Cells cells_above(const images::Volume& volume, double threshold_hu) {
  Cells cells;
  cells.factor = (kCell_mm / volume.spacing_mm().array()).round().max(1).cast<int>();
  const Vector3i inner = (volume.size.array() / cells.factor.array()).max(1);
  cells.spacing_mm = volume.spacing_mm().cwiseProduct(cells.factor.cast<double>());
  cells.room = (kRoom_mm / cells.spacing_mm.array()).ceil().cast<int>();
  cells.size = inner + 2 * cells.room;
  const Vector3d scale = cells.factor.cast<double>();
  cells.lps_from_cell = volume.lps_from_index;
  cells.lps_from_cell.translate(
      Vector3d(0.5 * (scale.array() - 1) - scale.array() * cells.room.cast<double>().array()));
  cells.lps_from_cell.scale(scale);
  cells.is_bone = images::VoxelMask(cells.size);
  for (int k = 0; k < inner.z(); ++k) {
    for (int j = 0; j < inner.y(); ++j) {
      for (int i = 0; i < inner.x(); ++i) {
        double sum = 0;
        int count = 0;
        for (int dk = 0; dk < cells.factor.z() && k * cells.factor.z() + dk < volume.size.z(); ++dk) {
          for (int dj = 0; dj < cells.factor.y() && j * cells.factor.y() + dj < volume.size.y(); ++dj) {
            for (int di = 0; di < cells.factor.x() && i * cells.factor.x() + di < volume.size.x(); ++di) {
              sum +=
                  volume.at(i * cells.factor.x() + di, j * cells.factor.y() + dj, k * cells.factor.z() + dk);
              ++count;
            }
          }
        }
        const Vector3i at = Vector3i(i, j, k) + cells.room;
        cells.is_bone.inside[cells.is_bone.index(at.x(), at.y(), at.z())] = sum >= threshold_hu * count;
      }
    }
  }
  return cells;
}

// Middle and both ends of a piece along its longest axis, and places between.
void add_anchors(const Cells& cells, const images::VoxelPiece& piece, std::vector<Vector3d>& anchors) {
  const auto nx = static_cast<std::size_t>(cells.size.x()), ny = static_cast<std::size_t>(cells.size.y());
  std::vector<Vector3d> points;
  Vector3d sum = Vector3d::Zero();
  for (const std::size_t v : piece.voxels) {
    points.emplace_back(cells.lps_from_cell * Vector3d(static_cast<double>(v % nx),
                                                       static_cast<double>(v / nx % ny),
                                                       static_cast<double>(v / (nx * ny))));
    sum += points.back();
  }
  const Vector3d middle = sum / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - middle) * (p - middle).transpose();
  const Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  const std::size_t first_of_piece = anchors.size();
  anchors.push_back(middle);
  double low = 1e9, high = -1e9;
  for (const Vector3d& p : points) {
    low = std::min(low, axis.dot(p));
    high = std::max(high, axis.dot(p));
  }
  const auto add_middle_of = [&](double from, double to) {
    Vector3d sum_between = Vector3d::Zero();
    double count = 0;
    for (const Vector3d& p : points) {
      if (axis.dot(p) < from || axis.dot(p) > to) continue;
      sum_between += p;
      ++count;
    }
    if (count == 0) return;
    const Vector3d anchor = sum_between / count;
    const bool is_new =
        std::all_of(anchors.begin() + static_cast<std::ptrdiff_t>(first_of_piece), anchors.end(),
                    [&](const Vector3d& other) { return (other - anchor).norm() > kAnotherAnchor_mm; });
    if (is_new) anchors.push_back(anchor);
  };
  add_middle_of(low, low + kJointEnd_mm);
  add_middle_of(high - kJointEnd_mm, high);
  for (double from = low; from + 2 * kAlong_mm <= high; from += kAlong_mm)
    add_middle_of(from, from + 2 * kAlong_mm);
}

// Distance and its slope at a place counted in cells; far beyond the field the value of its border.
struct Slope {
  double distance_mm;
  Vector3d gradient;  // a mm in LPS
  bool is_in_view;
};

Slope slope_at(const BoneField& field, const Vector3d& cell) {
  Slope slope;
  slope.is_in_view = (cell.array() >= field.first_in_view.array()).all() &&
                     (cell.array() <= field.last_in_view.array()).all();
  const Vector3d inside = cell.cwiseMax(0.0).cwiseMin(field.size.cast<double>() - Vector3d::Constant(1.001));
  const Vector3i low = inside.cast<int>();
  const Vector3d f = inside - low.cast<double>();
  const auto nx = static_cast<std::size_t>(field.size.x()),
             plane = nx * static_cast<std::size_t>(field.size.y());
  const float* const v = field.distance_mm.data() + static_cast<std::size_t>(low.x()) +
                         nx * static_cast<std::size_t>(low.y()) + plane * static_cast<std::size_t>(low.z());
  const double c00 = v[0] + f.x() * (v[1] - v[0]), c10 = v[nx] + f.x() * (v[nx + 1] - v[nx]),
               c01 = v[plane] + f.x() * (v[plane + 1] - v[plane]),
               c11 = v[plane + nx] + f.x() * (v[plane + nx + 1] - v[plane + nx]);
  const double low_z = c00 + f.y() * (c10 - c00), high_z = c01 + f.y() * (c11 - c01);
  slope.distance_mm = low_z + f.z() * (high_z - low_z);
  const auto along_x = [&](std::size_t o) { return static_cast<double>(v[o + 1] - v[o]); };
  const Vector3d by_cell((1 - f.z()) * ((1 - f.y()) * along_x(0) + f.y() * along_x(nx)) +
                             f.z() * ((1 - f.y()) * along_x(plane) + f.y() * along_x(plane + nx)),
                         (1 - f.z()) * (c10 - c00) + f.z() * (c11 - c01), high_z - low_z);
  slope.gradient.noalias() = field.cell_from_lps.linear().transpose() * by_cell;
  return slope;
}

constexpr double kMostCost_mm = 6, kOutOfViewCost_mm = 3.5;

double cost_of(const BoneField& field, std::span<const SurfaceSample> samples, const RigidTransform& pose) {
  const Eigen::Matrix3d cell_from_plan = field.cell_from_lps.linear() * pose.rotation.toRotationMatrix();
  const Vector3d origin = field.cell_from_lps * pose.translation_mm;
  double sum = 0;
  for (const SurfaceSample& sample : samples) {
    const Slope slope = slope_at(field, cell_from_plan * sample.point_mm + origin);
    sum += slope.is_in_view ? std::min(slope.distance_mm, kMostCost_mm) : kOutOfViewCost_mm;
  }
  return sum / static_cast<double>(samples.size());
}

Vector3d middle_of(std::span<const SurfaceSample> samples) {
  Vector3d sum = Vector3d::Zero();
  for (const SurfaceSample& sample : samples) sum += sample.point_mm;
  return sum / static_cast<double>(samples.size());
}

// Downhill, with far samples counting less and less. Nearly all of the time of a search goes here: frames are
// put together once a step, and of the normal matrix only the half that is read is summed.
void descend(const BoneField& field, std::span<const SurfaceSample> samples, int steps, double first_scale_mm,
             double last_scale_mm, RigidTransform& pose) {
  const Vector3d middle = middle_of(samples);
  const Eigen::Matrix3d cell_from_turned = field.cell_from_lps.linear();
  for (int step = 0; step < steps; ++step) {
    const double scale =
        first_scale_mm * std::pow(last_scale_mm / first_scale_mm, step / std::max(1.0, steps - 1.0));
    geometry::Matrix6d normal = geometry::Matrix6d::Identity() * 1e-3;
    geometry::Vector6d right = geometry::Vector6d::Zero();
    const Eigen::Matrix3d turned_from_plan = pose.rotation.toRotationMatrix();
    const Vector3d center = turned_from_plan * middle + pose.translation_mm,
                   center_in_cells = field.cell_from_lps * center;
    for (const SurfaceSample& sample : samples) {
      const Vector3d from_center = turned_from_plan * (sample.point_mm - middle);
      const Slope slope = slope_at(field, cell_from_turned * from_center + center_in_cells);
      if (!slope.is_in_view && slope.distance_mm > scale) continue;
      const double ratio = slope.distance_mm / scale,
                   weight = 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
      geometry::Vector6d row;
      row.head<3>() = slope.gradient;
      row.tail<3>() = from_center.cross(slope.gradient);
      for (int column = 0; column < 6; ++column) {
        const double weighted = weight * row[column];
        for (int line = column; line < 6; ++line) normal(line, column) += weighted * row[line];
        right[column] -= weighted * slope.distance_mm;
      }
    }
    const geometry::Vector6d change = normal.ldlt().solve(right);  // reads the lower half
    const Vector3d turn = change.tail<3>();
    const double angle = turn.norm();
    const Eigen::Quaterniond rotation(angle > 1e-12 ? Eigen::AngleAxisd(std::min(angle, 0.35), turn / angle)
                                                    : Eigen::AngleAxisd::Identity());
    Vector3d shift = change.head<3>();
    if (shift.norm() > 15) shift *= 15 / shift.norm();
    pose = {(rotation * pose.rotation).normalized(),
            rotation * (pose.translation_mm - center) + center + shift};
  }
}

// Spread evenly over all turns: Shoemake's unit quaternions of a low-discrepancy sequence (R3, Roberts 2018).
std::vector<Eigen::Quaterniond> turns_to_try(Turns turns) {
  constexpr int kAll = 900;
  constexpr double kSmall_rad = 1.15;
  std::vector<Eigen::Quaterniond> result;
  if (turns == Turns::Small) result.push_back(Eigen::Quaterniond::Identity());
  const auto fraction = [](double x) { return x - std::floor(x); };
  for (int i = 1; i <= kAll; ++i) {
    const double a = fraction(0.5 + 0.8191725133961645 * i),
                 b = fraction(0.5 + 0.6710436067037893 * i) * 2 * M_PI,
                 c = fraction(0.5 + 0.5497004779019703 * i) * 2 * M_PI;
    const Eigen::Quaterniond q(std::sqrt(a) * std::cos(c), std::sqrt(1 - a) * std::sin(b),
                               std::sqrt(1 - a) * std::cos(b), std::sqrt(a) * std::sin(c));
    if ((geometry::rotation_angle_rad(q) < kSmall_rad) == (turns == Turns::Small)) result.push_back(q);
  }
  return result;
}

}  // namespace

std::optional<BoneField> bone_field(const images::Volume& volume, double threshold_hu) {
  Cells cells = cells_above(volume, threshold_hu);
  const double cell_mm3 = std::abs(cells.lps_from_cell.linear().determinant());
  const auto pieces = images::connected_pieces(
      cells.is_bone, std::max<std::size_t>(1, static_cast<std::size_t>(kLeastPiece_mm3 / cell_mm3)));
  if (pieces.empty()) return std::nullopt;
  BoneField field;
  for (std::size_t p = 0; p < pieces.size() && p < kMostAnchored; ++p) {
    if (p == 0 || static_cast<double>(pieces[p].count) * cell_mm3 > kLeastAnchored_mm3)
      add_anchors(cells, pieces[p], field.anchors_mm);
  }
  std::fill(cells.is_bone.inside.begin(), cells.is_bone.inside.end(), std::uint8_t{0});
  for (const auto& piece : pieces)
    for (const std::size_t v : piece.voxels) cells.is_bone.inside[v] = 1;
  images::close_gaps(cells.is_bone, cells.spacing_mm, kClosing_mm);
  images::fill_enclosed(cells.is_bone, 2);

  field.size = cells.size;
  field.cell_from_lps = cells.lps_from_cell.inverse();
  field.first_in_view = cells.room.cast<double>();
  field.last_in_view = (cells.size - cells.room).cast<double>() - Vector3d::Ones();
  // Its surface: beside what is no bone, but not where the volume ends.
  const auto nx = static_cast<std::size_t>(cells.size.x()),
             plane = nx * static_cast<std::size_t>(cells.size.y());
  const auto& inside = cells.is_bone.inside;
  std::vector<std::size_t> surface;
  double cut_mm2 = 0;
  const Vector3i last = cells.size - cells.room - Vector3i::Ones();
  for (int k = cells.room.z(); k <= last.z(); ++k) {
    for (int j = cells.room.y(); j <= last.y(); ++j) {
      for (int i = cells.room.x(); i <= last.x(); ++i) {
        const std::size_t v = cells.is_bone.index(i, j, k);
        if (!inside[v]) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const int at = Vector3i(i, j, k)[axis];
          if (at == cells.room[axis] || at == last[axis])
            cut_mm2 += cells.spacing_mm.prod() / cells.spacing_mm[axis];
        }
        const bool is_surface =
            (i > cells.room.x() && !inside[v - 1]) || (i < last.x() && !inside[v + 1]) ||
            (j > cells.room.y() && !inside[v - nx]) || (j < last.y() && !inside[v + nx]) ||
            (k > cells.room.z() && !inside[v - plane]) || (k < last.z() && !inside[v + plane]);
        if (is_surface) surface.push_back(v);
      }
    }
  }
  field.is_cut = cut_mm2 > kLeastCut_mm2;
  field.bone_mm3 = cell_mm3 * static_cast<double>(std::ranges::count(inside, std::uint8_t{1}));
  field.distance_mm = images::distances_mm(cells.size, surface, cells.spacing_mm);
  for (float& d : field.distance_mm) d = std::min(d, 60.0F);
  return field;
}

std::vector<Vector3d> BoneField::anchors_near_an_end(double within_mm) const {
  const Vector3d cell_mm = cell_from_lps.linear().rowwise().norm().cwiseInverse();
  std::vector<Vector3d> near;
  std::ranges::copy_if(anchors_mm, std::back_inserter(near), [&](const Vector3d& anchor) {
    const Vector3d at = cell_from_lps * anchor;
    return ((at - first_in_view).cwiseMin(last_in_view - at).cwiseProduct(cell_mm).array() < within_mm).any();
  });
  return near;
}

std::vector<CoarsePose> coarse_poses(const BoneField& field, std::span<const Vector3d> anchors_mm,
                                     std::span<const SurfaceSample> samples, Turns turns,
                                     const GoesOn& goes_on) {
  constexpr std::size_t kFew = 80, kMany = 400, kKept = 60, kReturned = 6;
  constexpr unsigned kMostThreads = 4;  // a window wants its own
  const auto few = samples.first(std::min(kFew, samples.size())),
             many = samples.first(std::min(kMany, samples.size()));
  const Vector3d middle = middle_of(many);
  // Each start goes its own way: as many at once as there are processors, in the order of the turns whatever
  // thread took which. The caller's thread alone tells and asks.
  const std::vector<Eigen::Quaterniond> rotations = turns_to_try(turns);
  std::vector<CoarsePose> all(rotations.size() * anchors_mm.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&](const std::function<bool()>& may_go_on) {
    for (std::size_t i = 0; may_go_on() && (i = next++) < rotations.size();) {
      for (std::size_t a = 0; a < anchors_mm.size(); ++a) {
        CoarsePose& start = all[i * anchors_mm.size() + a];
        start.postop_from_plan = {rotations[i], anchors_mm[a] - rotations[i] * middle};
        descend(field, few, 12, 20, 6, start.postop_from_plan);
        start.cost_mm = cost_of(field, few, start.postop_from_plan);
      }
    }
  };
  bool is_ended = false;
  {
    std::vector<std::future<void>> helpers;
    for (unsigned i = 1; i < std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads); ++i)
      helpers.push_back(std::async(std::launch::async, work, [] { return true; }));
    const auto count = static_cast<double>(rotations.size());
    work([&] {
      is_ended = !goes_on(std::min(1.0, static_cast<double>(next) / count));
      if (is_ended) next = rotations.size();
      return !is_ended;
    });
  }
  if (is_ended) return {};
  const auto by_cost = [](const CoarsePose& a, const CoarsePose& b) { return a.cost_mm < b.cost_mm; };
  std::stable_sort(all.begin(), all.end(), by_cost);
  if (all.size() > kKept) all.resize(kKept);
  for (CoarsePose& pose : all) {
    descend(field, many, 15, 6, 3, pose.postop_from_plan);
    pose.cost_mm = cost_of(field, many, pose.postop_from_plan);
  }
  std::stable_sort(all.begin(), all.end(), by_cost);
  std::vector<CoarsePose> distinct;
  for (const CoarsePose& pose : all) {
    const bool is_known = std::any_of(distinct.begin(), distinct.end(), [&](const CoarsePose& other) {
      const RigidTransform apart = other.postop_from_plan.inverse() * pose.postop_from_plan;
      return geometry::rotation_angle_rad(apart.rotation) < 0.12 && (apart * middle - middle).norm() < 4;
    });
    if (!is_known) distinct.push_back(pose);
    if (distinct.size() == kReturned) break;
  }
  return distinct;
}

}  // namespace arthronaut::postop
