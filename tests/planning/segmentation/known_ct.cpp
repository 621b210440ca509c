#include "tests/planning/segmentation/known_ct.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "planning/geometry/surface.h"

namespace arthronaut::test {

namespace {

struct Crossing {
  double x;   // in voxels
  int steps;  // +1 into the mesh, -1 out of it
};

// A Gaussian along one axis, ends repeated.
void blur_along(std::vector<float>& values, const Eigen::Vector3i& size, int axis, double sigma_voxels) {
  if (sigma_voxels < 0.05) return;
  const int reach = static_cast<int>(std::ceil(3 * sigma_voxels));
  std::vector<float> kernel;
  float sum = 0;
  for (int d = -reach; d <= reach; ++d) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * d * d / (sigma_voxels * sigma_voxels))));
    sum += kernel.back();
  }
  std::size_t step = 1;
  for (int a = 0; a < axis; ++a) step *= static_cast<std::size_t>(size[a]);
  const auto n = static_cast<std::size_t>(size[axis]), before = static_cast<std::size_t>(reach);
  std::vector<float> row(n + 2 * before);
  for (std::size_t first = 0; first < values.size(); first += n * step) {
    for (std::size_t start = first; start < first + step; ++start) {
      for (std::size_t i = 0; i < n; ++i) row[before + i] = values[start + i * step];
      std::fill_n(row.begin(), reach, row[before]);
      std::fill_n(row.end() - reach, reach, row[before + n - 1]);
      for (std::size_t i = 0; i < n; ++i) {
        float blurred = 0;
        for (std::size_t k = 0; k < kernel.size(); ++k) blurred += kernel[k] * row[i + k];
        values[start + i * step] = blurred / sum;
      }
    }
  }
}

geometry::TriangleMesh shrunk(const geometry::TriangleMesh& mesh, double by_mm) {
  geometry::TriangleMesh inner = mesh;
  const auto normals = geometry::vertex_normals(mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) inner.vertices_mm[v] -= by_mm * normals[v];
  return inner;
}

}  // namespace

std::vector<float> coverage(const geometry::TriangleMesh& mesh, const images::Volume& grid, int samples) {
  const auto nx = static_cast<std::size_t>(grid.size.x());
  const int rows_j = grid.size.y() * samples, rows_k = grid.size.z() * samples;
  std::vector<std::vector<Crossing>> rows(static_cast<std::size_t>(rows_j) *
                                          static_cast<std::size_t>(rows_k));
  const Eigen::Affine3d index_from_lps = grid.lps_from_index.inverse();
  // Sub-row r lies at (r + 0.5) / samples - 0.5 voxels; a shift below any coordinate's grid avoids edges.
  const auto to_row = [&](double v) { return (v + 0.5) * samples - 0.5 + 1e-7; };
  for (const auto& t : mesh.triangles) {
    Eigen::Vector3d p[3];
    for (int c = 0; c < 3; ++c) {
      p[c] = index_from_lps * mesh.vertices_mm[static_cast<std::size_t>(t[static_cast<std::size_t>(c)])];
      p[c].y() = to_row(p[c].y());
      p[c].z() = to_row(p[c].z());
    }
    const double area =
        (p[1].y() - p[0].y()) * (p[2].z() - p[0].z()) - (p[2].y() - p[0].y()) * (p[1].z() - p[0].z());
    if (std::abs(area) < 1e-14) continue;
    const auto [y0, y1] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    const auto [z0, z1] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
    for (int k = std::max(0, static_cast<int>(std::ceil(z0)));
         k <= std::min(rows_k - 1, static_cast<int>(z1)); ++k) {
      for (int j = std::max(0, static_cast<int>(std::ceil(y0)));
           j <= std::min(rows_j - 1, static_cast<int>(y1)); ++j) {
        const double b =
            ((j - p[0].y()) * (p[2].z() - p[0].z()) - (p[2].y() - p[0].y()) * (k - p[0].z())) / area;
        const double c =
            ((p[1].y() - p[0].y()) * (k - p[0].z()) - (j - p[0].y()) * (p[1].z() - p[0].z())) / area;
        if (b < 0 || c < 0 || b + c > 1) continue;
        rows[static_cast<std::size_t>(k) * static_cast<std::size_t>(rows_j) + static_cast<std::size_t>(j)]
            .push_back({p[0].x() + b * (p[1].x() - p[0].x()) + c * (p[2].x() - p[0].x()), area > 0 ? -1 : 1});
      }
    }
  }
  std::vector<float> covered(grid.values.size(), 0.0F);
  const float weight = 1.0F / static_cast<float>(samples * samples);
  for (int k = 0; k < rows_k; ++k) {
    for (int j = 0; j < rows_j; ++j) {
      auto& row =
          rows[static_cast<std::size_t>(k) * static_cast<std::size_t>(rows_j) + static_cast<std::size_t>(j)];
      std::sort(row.begin(), row.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
      float* line = covered.data() + grid.index(0, j / samples, k / samples);
      int winding = 0;
      for (std::size_t c = 0; c + 1 < row.size(); ++c) {
        winding += row[c].steps;
        if (winding <= 0) continue;
        const double from = std::max(row[c].x + 0.5, 0.0),
                     to = std::min(row[c + 1].x + 0.5, static_cast<double>(nx));
        for (int i = static_cast<int>(from); i < to; ++i)
          line[i] +=
              weight * static_cast<float>(std::max(0.0, std::min(to, i + 1.0) - std::max(from, 1.0 * i)));
      }
    }
  }
  return covered;
}

images::Volume known_ct(const std::vector<geometry::TriangleMesh>& bones, const KnownCtOptions& options) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (const auto& bone : bones) {
    low = low.cwiseMin(geometry::bounds_of(bone).min_mm);
    high = high.cwiseMax(geometry::bounds_of(bone).max_mm);
  }
  low.array() -= options.margin_mm;
  high.array() += options.margin_mm;
  low.z() = std::max(low.z(), options.lowest_mm);
  high.z() = std::min(high.z(), options.highest_mm);
  images::Volume volume;
  volume.size = ((high - low).cwiseQuotient(options.spacing_mm)).array().ceil().cast<int>();
  volume.lps_from_index.linear() = options.spacing_mm.asDiagonal();
  volume.lps_from_index.translation() = low;
  volume.modality_in_file = "CT";
  volume.modality = images::Modality::Ct;
  volume.format = "made";
  volume.values.assign(static_cast<std::size_t>(volume.size.cast<std::int64_t>().prod()),
                       static_cast<float>(options.soft_tissue_hu));
  for (const auto& bone : bones) {
    const auto whole = coverage(bone, volume, options.samples),
               inner = coverage(shrunk(bone, options.cortex_mm), volume, options.samples);
    for (std::size_t v = 0; v < whole.size(); ++v) {
      const float marrow = std::min(inner[v], whole[v]);
      volume.values[v] +=
          static_cast<float>(options.cortex_hu - options.soft_tissue_hu) * (whole[v] - marrow) +
          static_cast<float>(options.marrow_hu - options.soft_tissue_hu) * marrow;
    }
  }
  if (options.operate) options.operate(volume);
  for (int axis = 0; axis < 3; ++axis)
    blur_along(volume.values, volume.size, axis, options.blur_mm / options.spacing_mm[axis]);
  std::mt19937_64 random(options.seed);
  std::normal_distribution<float> noise(0.0F, static_cast<float>(options.noise_hu));
  for (float& v : volume.values) v = std::round(v + (options.noise_hu > 0 ? noise(random) : 0.0F));
  return volume;
}

std::vector<double> distances_to(const geometry::TriangleMesh& truth, const geometry::TriangleMesh& surface,
                                 double margin_mm) {
  const geometry::Surface exact(truth);
  const geometry::Bounds bounds = geometry::bounds_of(truth);
  std::vector<double> distances;
  for (const Eigen::Vector3d& p : surface.vertices_mm) {
    if (p.z() < bounds.min_mm.z() + margin_mm || p.z() > bounds.max_mm.z() - margin_mm) continue;
    distances.push_back((exact.closest_point(p).point_mm - p).norm());
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

}  // namespace arthronaut::test
