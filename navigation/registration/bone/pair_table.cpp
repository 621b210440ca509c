#include "navigation/registration/bone/pair_table.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <unordered_map>

#include "navigation/registration/bone/cell_key.h"
#include "planning/geometry/error.h"

namespace arthronaut::registration {

namespace {

constexpr float kTurn = 6.28318530718f;
constexpr float kPi = 0.5f * kTurn;
constexpr std::size_t kMaxSampleCount = 60'000;  // two bytes an index

float wrapped_rad(float angle) { return angle - kTurn * std::floor(angle / kTurn + 0.5f); }

// A direction of cosine `curve_cos` to the baseline can lie across one of cosine `surface_cos` when the
// planes through the baseline that hold them enclose the angle whose cosine this is; beyond [-1, 1] there is
// none.
float cos_of_crossing(float curve_cos, float surface_cos) {
  const float sines = (1 - curve_cos * curve_cos) * (1 - surface_cos * surface_cos);
  return -curve_cos * surface_cos / std::sqrt(std::max(sines, 1e-6f));
}

struct AngleRange {
  float low, high;
  bool empty = false;
};

// Noise may push a true match slightly past the limit.
constexpr float kCosineSlack = 1.02f;

// The crossing angles over one bin of the surface cosine, of which they are a monotonic function.
AngleRange crossing_range(float curve_cos, float surface_cos_low, float surface_cos_high) {
  float a = cos_of_crossing(curve_cos, surface_cos_low), b = cos_of_crossing(curve_cos, surface_cos_high);
  if (a > b) std::swap(a, b);
  if (a > kCosineSlack || b < -kCosineSlack) return {0, 0, true};
  return {std::acos(std::clamp(b, -1.0f, 1.0f)), std::acos(std::clamp(a, -1.0f, 1.0f))};
}

// Keeps the samples apart by means of a hash of cells as wide as the spacing.
class SpacedSet {
 public:
  explicit SpacedSet(double spacing_mm) : spacing_mm_(static_cast<float>(spacing_mm)) {}

  bool insert(const SurfaceSample& sample) {
    const Eigen::Vector3i cell = (sample.point_mm / spacing_mm_).array().floor().cast<int>();
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const auto it = cells_.find(cell_key(cell + Eigen::Vector3i(x, y, z)));
          if (it == cells_.end()) continue;
          for (const std::size_t other : it->second) {
            // The other side of a thin wall is another place.
            if (samples_[other].normal.dot(sample.normal) < 0) continue;
            if ((samples_[other].point_mm - sample.point_mm).squaredNorm() < spacing_mm_ * spacing_mm_)
              return false;
          }
        }
      }
    }
    cells_[cell_key(cell)].push_back(samples_.size());
    samples_.push_back(sample);
    return true;
  }

  std::vector<SurfaceSample> take() { return std::move(samples_); }

 private:
  float spacing_mm_;
  std::vector<SurfaceSample> samples_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

}  // namespace

std::vector<SurfaceSample> sample_surface(const geometry::TriangleMesh& mesh, double spacing_mm) {
  constexpr double kDartsPerSample = 12;  // after which few gaps are left
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh);
  std::vector<double> area_up_to(mesh.triangles.size());
  double area_mm2 = 0;
  const auto corner = [&](std::size_t t, std::size_t k) {
    return static_cast<std::size_t>(mesh.triangles[t][k]);
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d &a = mesh.vertices_mm[corner(t, 0)], &b = mesh.vertices_mm[corner(t, 1)],
                          &c = mesh.vertices_mm[corner(t, 2)];
    area_mm2 += 0.5 * (b - a).cross(c - a).norm();
    area_up_to[t] = area_mm2;
  }
  std::mt19937_64 random(20'231);  // any fixed number: the samples belong to the bone, not to a registration
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  SpacedSet set(spacing_mm);
  const auto darts = static_cast<std::int64_t>(kDartsPerSample * area_mm2 / (spacing_mm * spacing_mm));
  for (std::int64_t dart = 0; dart < darts; ++dart) {
    const auto t = static_cast<std::size_t>(
        std::lower_bound(area_up_to.begin(), area_up_to.end(), uniform() * area_mm2) - area_up_to.begin());
    double u = uniform(), v = uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const std::size_t a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Eigen::Vector3d point =
        (1 - u - v) * mesh.vertices_mm[a] + u * mesh.vertices_mm[b] + v * mesh.vertices_mm[c];
    const Eigen::Vector3d normal = (1 - u - v) * normals[a] + u * normals[b] + v * normals[c];
    if (normal.norm() < 0.1) continue;  // a crease too sharp to have one
    set.insert({point.cast<float>(), normal.normalized().cast<float>()});
  }
  return set.take();
}

PairShape shape_of(const Eigen::Vector3f& first, const Eigen::Vector3f& first_direction,
                   const Eigen::Vector3f& second, const Eigen::Vector3f& second_direction) {
  PairShape shape;
  const Eigen::Vector3f between = second - first;
  shape.distance_mm = between.norm();
  const Eigen::Vector3f e = between / std::max(shape.distance_mm, 1e-6f);
  shape.cos_first = first_direction.dot(e);
  shape.cos_second = second_direction.dot(e);
  const Eigen::Vector3f across_first = first_direction - shape.cos_first * e;
  const Eigen::Vector3f across_second = second_direction - shape.cos_second * e;
  shape.dihedral_rad = std::atan2(e.dot(across_first.cross(across_second)), across_first.dot(across_second));
  return shape;
}

PairTable::PairTable(const geometry::TriangleMesh& mesh, const PairTableOptions& options)
    : options_(options) {
  double spacing_mm = options_.sample_spacing_mm;
  const double area_mm2 = geometry::surface_area_mm2(mesh);
  spacing_mm = std::max(spacing_mm, std::sqrt(area_mm2 / static_cast<double>(kMaxSampleCount)));
  for (;;) {
    samples_ = sample_surface(mesh, spacing_mm);
    const double excess = static_cast<double>(count_pairs()) / static_cast<double>(options_.max_pair_count);
    if (excess <= 1 && samples_.size() <= kMaxSampleCount) break;
    spacing_mm *= std::max(1.05, std::pow(excess, 0.25) * 1.02);  // the count falls with the fourth power
  }
  build_pairs();
}

PairTable::PairTable(ByteReader& bytes) : options_(bytes.read<PairTableOptions>()) {
  const auto numbers = bytes.read_many<std::array<float, 6>>();
  for (const auto& n : numbers) samples_.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  distance_bin_count_ = bytes.read<std::int32_t>();
  pairs_ = bytes.read_many<Pair>();
  cell_start_ = bytes.read_many<std::uint32_t>();
  if (cell_start_.size() != static_cast<std::size_t>(distance_bin_count_) * kCosineBins * kCosineBins + 1 ||
      cell_start_.back() != pairs_.size()) {
    throw InvalidInput("no pair table");
  }
}

void PairTable::write_to(ByteWriter& bytes) const {
  bytes.write(options_);
  std::vector<std::array<float, 6>> numbers;
  for (const SurfaceSample& sample : samples_) {
    const Eigen::Vector3f &p = sample.point_mm, &n = sample.normal;
    numbers.push_back({p.x(), p.y(), p.z(), n.x(), n.y(), n.z()});
  }
  bytes.write(numbers);
  bytes.write(std::int32_t{distance_bin_count_});
  bytes.write(pairs_);
  bytes.write(cell_start_);
}

std::size_t PairTable::count_pairs() const {
  const auto low = static_cast<float>(options_.min_distance_mm * options_.min_distance_mm);
  const auto high = static_cast<float>(options_.max_distance_mm * options_.max_distance_mm);
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    for (std::size_t j = i + 1; j < samples_.size(); ++j) {
      const float squared = (samples_[i].point_mm - samples_[j].point_mm).squaredNorm();
      count += squared >= low && squared <= high;
    }
  }
  return count;
}

void PairTable::build_pairs() {
  const auto low = static_cast<float>(options_.min_distance_mm),
             high = static_cast<float>(options_.max_distance_mm);
  distance_bin_count_ = static_cast<int>((high - low) / kDistanceBin_mm) + 1;
  const auto cosine_bin = [](float cosine) {
    return std::clamp(static_cast<int>((cosine + 1) * (0.5f * kCosineBins)), 0, kCosineBins - 1);
  };
  const auto cell_of = [&](const PairShape& shape) {
    const int bin = static_cast<int>((shape.distance_mm - low) / kDistanceBin_mm);
    return static_cast<std::size_t>((bin * kCosineBins + cosine_bin(shape.cos_first)) * kCosineBins +
                                    cosine_bin(shape.cos_second));
  };
  std::vector<Pair> found;
  found.reserve(count_pairs());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    for (std::size_t j = i + 1; j < samples_.size(); ++j) {
      const float squared = (samples_[i].point_mm - samples_[j].point_mm).squaredNorm();
      if (squared < low * low || squared > high * high) continue;
      Pair pair{shape_of(samples_[i].point_mm, samples_[i].normal, samples_[j].point_mm, samples_[j].normal),
                static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)};
      pair.shape.distance_mm = std::clamp(pair.shape.distance_mm, low, high);
      // A normal along the baseline lies across no tangent that is not across the baseline itself: no use.
      constexpr float kAlong = 0.98f;
      if (std::abs(pair.shape.cos_first) < kAlong && std::abs(pair.shape.cos_second) < kAlong)
        found.push_back(pair);
    }
  }
  // Counting sort by cell, then by dihedral within the cell.
  const auto cell_count = static_cast<std::size_t>(distance_bin_count_ * kCosineBins * kCosineBins);
  cell_start_.assign(cell_count + 1, 0);
  for (const Pair& pair : found) ++cell_start_[cell_of(pair.shape) + 1];
  std::partial_sum(cell_start_.begin(), cell_start_.end(), cell_start_.begin());
  std::vector<std::uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  pairs_.resize(found.size());
  for (const Pair& pair : found) pairs_[next[cell_of(pair.shape)]++] = pair;
  for (std::size_t cell = 0; cell < cell_count; ++cell) {
    std::sort(pairs_.begin() + cell_start_[cell], pairs_.begin() + cell_start_[cell + 1],
              [](const Pair& l, const Pair& r) { return l.shape.dihedral_rad < r.shape.dihedral_rad; });
  }
}

void PairTable::find_matches(const PairShape& curve, const Tolerance& tolerance,
                             std::vector<Match>& matches) const {
  const auto low_mm = static_cast<float>(options_.min_distance_mm);
  const int first_bin = std::max(
      0,
      static_cast<int>(std::floor((curve.distance_mm - tolerance.distance_mm - low_mm) / kDistanceBin_mm)));
  const int last_bin = std::min(
      distance_bin_count_ - 1,
      static_cast<int>(std::floor((curve.distance_mm + tolerance.distance_mm - low_mm) / kDistanceBin_mm)));
  std::array<AngleRange, kCosineBins> first_range, second_range;
  for (int k = 0; k < kCosineBins; ++k) {
    const float low = static_cast<float>(k) * (2.0f / kCosineBins) - 1, high = low + 2.0f / kCosineBins;
    first_range[static_cast<std::size_t>(k)] = crossing_range(curve.cos_first, low, high);
    second_range[static_cast<std::size_t>(k)] = crossing_range(curve.cos_second, low, high);
  }

  // dihedral' - dihedral = turn at the first point - turn at the second, each turn being plus or minus a
  // crossing angle.
  const auto test = [&](const Pair& pair, float first_sign, float second_sign) {
    if (std::abs(pair.shape.distance_mm - curve.distance_mm) > tolerance.distance_mm) return;
    const float first_cos = cos_of_crossing(curve.cos_first, pair.shape.cos_first);
    const float second_cos = cos_of_crossing(curve.cos_second, pair.shape.cos_second);
    if (std::abs(first_cos) > kCosineSlack || std::abs(second_cos) > kCosineSlack) return;
    const float first_turn = first_sign * std::acos(std::clamp(first_cos, -1.0f, 1.0f));
    const float second_turn = second_sign * std::acos(std::clamp(second_cos, -1.0f, 1.0f));
    const float miss = wrapped_rad(pair.shape.dihedral_rad - curve.dihedral_rad - first_turn + second_turn);
    if (std::abs(miss) <= tolerance.angle_rad)
      matches.push_back({pair.first, pair.second, first_turn + 0.5f * miss});
  };
  const auto test_window = [&](std::size_t cell, float from, float to, float first_sign, float second_sign) {
    const auto begin = pairs_.begin() + cell_start_[cell], end = pairs_.begin() + cell_start_[cell + 1];
    const auto by_dihedral = [](const Pair& pair, float angle) { return pair.shape.dihedral_rad < angle; };
    // The window may pass the seam at half a turn.
    const float shift = kTurn * std::floor((from + kPi) / kTurn);
    for (float part_from = from - shift, part_to = to - shift; part_to >= -kPi;
         part_from -= kTurn, part_to -= kTurn) {
      for (auto it = std::lower_bound(begin, end, part_from, by_dihedral);
           it != end && it->shape.dihedral_rad <= part_to; ++it) {
        test(*it, first_sign, second_sign);
      }
    }
  };

  for (int bin = first_bin; bin <= last_bin; ++bin) {
    for (int k = 0; k < kCosineBins; ++k) {
      const AngleRange& first = first_range[static_cast<std::size_t>(k)];
      if (first.empty) continue;
      for (int l = 0; l < kCosineBins; ++l) {
        const AngleRange& second = second_range[static_cast<std::size_t>(l)];
        if (second.empty) continue;
        const auto cell = static_cast<std::size_t>((bin * kCosineBins + k) * kCosineBins + l);
        if (cell_start_[cell] == cell_start_[cell + 1]) continue;
        const float base = curve.dihedral_rad, slack = tolerance.angle_rad;
        test_window(cell, base + first.low - second.high - slack, base + first.high - second.low + slack, 1,
                    1);
        test_window(cell, base + first.low + second.low - slack, base + first.high + second.high + slack, 1,
                    -1);
        test_window(cell, base - first.high - second.high - slack, base - first.low - second.low + slack, -1,
                    1);
        test_window(cell, base - first.high + second.low - slack, base - first.low + second.high + slack, -1,
                    -1);
      }
    }
  }
}

}  // namespace arthronaut::registration
