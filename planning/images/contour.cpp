#include "planning/images/contour.h"

#include <vtkCellArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>

namespace arthronaut::images {

std::optional<VoxelBounds> bounds_of_label(const Volume& volume, int label) {
  const auto wanted = static_cast<float>(label);
  VoxelBounds bounds{volume.size, Eigen::Vector3i::Constant(-1)};
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = 0; i < volume.size.x(); ++i) {
        if (volume.at(i, j, k) != wanted) continue;
        bounds.low = bounds.low.cwiseMin(Eigen::Vector3i(i, j, k));
        bounds.high = bounds.high.cwiseMax(Eigen::Vector3i(i, j, k));
      }
    }
  }
  if (bounds.high.x() < 0) return std::nullopt;
  return bounds;
}

geometry::TriangleMesh contour(const Field& field, float level, const Eigen::Affine3d& lps_from_index,
                               const Smoothing& smoothing) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(field.size.x(), field.size.y(), field.size.z());
  image->AllocateScalars(VTK_FLOAT, 1);
  std::copy(field.values.begin(), field.values.end(), static_cast<float*>(image->GetScalarPointer()));
  vtkNew<vtkFlyingEdges3D> cubes;
  cubes->SetInputData(image);
  cubes->SetValue(0, level);
  cubes->ComputeNormalsOff();
  cubes->ComputeGradientsOff();
  cubes->ComputeScalarsOff();
  cubes->Update();

  vtkNew<vtkPolyData> in_patient;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkPolyData* found = cubes->GetOutput();
  points->SetNumberOfPoints(found->GetNumberOfPoints());
  const Eigen::Vector3d first = field.first_index.cast<double>();
  for (vtkIdType i = 0; i < found->GetNumberOfPoints(); ++i) {
    const Eigen::Vector3d index = Eigen::Map<const Eigen::Vector3d>(found->GetPoint(i)) + first;
    const Eigen::Vector3d p = lps_from_index * index;
    points->SetPoint(i, p.data());
  }
  in_patient->SetPoints(points);
  in_patient->SetPolys(found->GetPolys());

  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputData(in_patient);
  smooth->SetNumberOfIterations(std::max(smoothing.iterations, 1));
  smooth->SetPassBand(smoothing.pass_band);
  smooth->NormalizeCoordinatesOn();
  smooth->NonManifoldSmoothingOn();
  smooth->FeatureEdgeSmoothingOff();
  smooth->BoundarySmoothingOff();
  if (smoothing.iterations > 0) smooth->Update();

  geometry::TriangleMesh mesh;
  vtkPolyData* surface = smoothing.iterations > 0 ? smooth->GetOutput() : in_patient.GetPointer();
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
    mesh.vertices_mm.emplace_back(Eigen::Map<const Eigen::Vector3d>(surface->GetPoint(i)));
  }
  vtkCellArray* cells = surface->GetPolys();
  const vtkIdType* corners = nullptr;
  vtkIdType count = 0;
  for (cells->InitTraversal(); cells->GetNextCell(count, corners);) {
    mesh.triangles.push_back({static_cast<std::int32_t>(corners[0]), static_cast<std::int32_t>(corners[1]),
                              static_cast<std::int32_t>(corners[2])});
  }
  return mesh;
}

}  // namespace arthronaut::images
