#include "planning/phantom/implicit_mesh.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>

namespace arthronaut::phantom {

namespace {

// No function changes faster than twice its distance from the surface.
constexpr double kSteepest = 2.0;

Eigen::Vector3d gradient_of(const ImplicitFunction& function, const Eigen::Vector3d& p) {
  constexpr double kStep = 1e-4;
  Eigen::Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    gradient[axis] = (function(p + step) - function(p - step)) / (2.0 * kStep);
  }
  return gradient;
}

vtkNew<vtkImageData> sample(const ImplicitFunction& function, const ImplicitMeshOptions& options) {
  const double edge = options.edge_length_mm;
  const Eigen::Array3i size = ((options.max_mm - options.min_mm) / edge).array().ceil().cast<int>() + 1;
  vtkNew<vtkImageData> grid;
  grid->SetDimensions(size.x(), size.y(), size.z());
  grid->SetOrigin(options.min_mm.data());
  grid->SetSpacing(edge, edge, edge);
  grid->AllocateScalars(VTK_FLOAT, 1);
  auto* const values = static_cast<float*>(grid->GetScalarPointer());
  const auto sampled = [&](const Eigen::Array3i& at) {
    const auto value = static_cast<float>(function(options.min_mm + edge * at.cast<double>().matrix()));
    // A sample on the surface would give triangles without area.
    return std::abs(value) < 1e-3F ? 1e-3F : value;
  };
  // By blocks. Far from the surface all of a block is as its middle: only the sign counts there.
  constexpr int kBlock = 4;
  const double far_mm = kSteepest * std::sqrt(3.0) * 0.5 * kBlock * edge;
  Eigen::Array3i from, at;
  for (from.z() = 0; from.z() < size.z(); from.z() += kBlock) {
    for (from.y() = 0; from.y() < size.y(); from.y() += kBlock) {
      for (from.x() = 0; from.x() < size.x(); from.x() += kBlock) {
        const Eigen::Array3i end = (from + kBlock).min(size);
        const float middle = sampled(from + kBlock / 2);
        const bool is_far = std::abs(middle) > far_mm;
        for (at.z() = from.z(); at.z() < end.z(); ++at.z())
          for (at.y() = from.y(); at.y() < end.y(); ++at.y())
            for (at.x() = from.x(); at.x() < end.x(); ++at.x())
              values[at.x() + size.x() * (at.y() + size.y() * at.z())] = is_far ? middle : sampled(at);
      }
    }
  }
  return grid;
}

geometry::TriangleMesh contour(vtkImageData* grid) {
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(grid);
  edges->SetValue(0, 0.0);
  edges->ComputeNormalsOff();
  edges->ComputeGradientsOff();
  edges->ComputeScalarsOff();
  edges->Update();
  vtkPolyData* surface = edges->GetOutput();

  geometry::TriangleMesh mesh;
  mesh.vertices_mm.resize(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    surface->GetPoint(static_cast<vtkIdType>(i), mesh.vertices_mm[i].data());
  }
  vtkCellArray* cells = surface->GetPolys();
  mesh.triangles.reserve(static_cast<std::size_t>(cells->GetNumberOfCells()));
  cells->InitTraversal();
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  while (cells->GetNextCell(count, ids) != 0) {
    mesh.triangles.push_back({static_cast<std::int32_t>(ids[0]), static_cast<std::int32_t>(ids[1]),
                              static_cast<std::int32_t>(ids[2])});
  }
  if (geometry::signed_volume_mm3(mesh) < 0.0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

// Every vertex goes half way to the mean of its neighbours, then back onto the surface: slivers of the grid
// disappear.
void relax(geometry::TriangleMesh& mesh, const ImplicitFunction& function) {
  std::vector<Eigen::Vector3d> sum(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  std::vector<int> neighbours(mesh.vertices_mm.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto from = static_cast<std::size_t>(triangle[corner]);
      sum[from] += mesh.vertices_mm[static_cast<std::size_t>(triangle[(corner + 1) % 3])];
      ++neighbours[from];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (neighbours[i] == 0) continue;
    const Eigen::Vector3d mean = sum[i] / neighbours[i];
    mesh.vertices_mm[i] = project_onto(function, 0.5 * (mesh.vertices_mm[i] + mean));
  }
}

}  // namespace

// A gradient costs six values and turns little over a step, so that each one serves two steps.
Eigen::Vector3d project_onto(const ImplicitFunction& function, const Eigen::Vector3d& p) {
  Eigen::Vector3d point = p;
  double value = function(point);
  for (int i = 0; i < 10 && std::abs(value) > 1e-7; ++i) {
    const Eigen::Vector3d gradient = gradient_of(function, point);
    for (int k = 0; k < 2 && std::abs(value) > 1e-7; ++k) {
      // A step is bounded, since the function is a distance only near the surface.
      const Eigen::Vector3d step = -value * gradient / std::max(gradient.squaredNorm(), 1e-3);
      point += step * std::min(1.0, 2.0 / std::max(step.norm(), 1e-12));
      value = function(point);
    }
  }
  return point;
}

geometry::TriangleMesh mesh_of(const ImplicitFunction& function, const ImplicitMeshOptions& options) {
  const vtkNew<vtkImageData> grid = sample(function, options);
  geometry::TriangleMesh mesh = contour(grid);
  for (Eigen::Vector3d& vertex : mesh.vertices_mm) vertex = project_onto(function, vertex);
  for (int i = 0; i < options.relaxations; ++i) relax(mesh, function);
  return mesh;
}

}  // namespace arthronaut::phantom
