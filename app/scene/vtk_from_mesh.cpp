#include "app/scene/vtk_from_mesh.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkQuadricDecimation.h>
#include <vtkUnsignedCharArray.h>

#include "app/scene/scene_content.h"

namespace arthronaut::scene {

namespace {

vtkSmartPointer<vtkCellArray> cells_from(const std::vector<std::array<std::int32_t, 3>>& triangles) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->AllocateExact(static_cast<vtkIdType>(triangles.size()),
                       static_cast<vtkIdType>(3 * triangles.size()));
  for (const auto& t : triangles) {
    const vtkIdType ids[3] = {t[0], t[1], t[2]};
    cells->InsertNextCell(3, ids);
  }
  return cells;
}

template <typename Vectors>
vtkSmartPointer<vtkFloatArray> floats_from(const Vectors& vectors) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const Eigen::Vector3f v = vectors[i].template cast<float>();
    array->SetTypedTuple(static_cast<vtkIdType>(i), v.data());
  }
  return array;
}

}  // namespace

vtkSmartPointer<vtkPolyData> vtk_from_mesh(const geometry::TriangleMesh& mesh) {
  auto polydata = vtkSmartPointer<vtkPolyData>::New();
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(floats_from(mesh.vertices_mm));
  polydata->SetPoints(points);
  polydata->SetPolys(cells_from(mesh.triangles));
  polydata->GetPointData()->SetNormals(floats_from(geometry::vertex_normals(mesh)));
  return polydata;
}

vtkSmartPointer<vtkPolyData> vtk_from_solid(const SolidMesh& mesh) {
  auto polydata = vtkSmartPointer<vtkPolyData>::New();
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(floats_from(mesh.points_mm));
  polydata->SetPoints(points);
  polydata->SetPolys(cells_from(mesh.triangles));
  polydata->GetPointData()->SetNormals(floats_from(mesh.normals));
  auto colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colors->SetName("colors");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(static_cast<vtkIdType>(mesh.colors.size()));
  for (std::size_t i = 0; i < mesh.colors.size(); ++i)
    colors->SetTypedTuple(static_cast<vtkIdType>(i), mesh.colors[i].data());
  polydata->GetPointData()->SetScalars(colors);
  return polydata;
}

geometry::TriangleMesh mesh_from_vtk(vtkPolyData& polydata) {
  geometry::TriangleMesh mesh;
  mesh.vertices_mm.resize(static_cast<std::size_t>(polydata.GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
    polydata.GetPoint(static_cast<vtkIdType>(i), mesh.vertices_mm[i].data());
  auto ids = vtkSmartPointer<vtkIdList>::New();
  polydata.GetPolys()->InitTraversal();
  while (polydata.GetPolys()->GetNextCell(ids) != 0) {
    if (ids->GetNumberOfIds() != 3) continue;
    mesh.triangles.push_back({static_cast<std::int32_t>(ids->GetId(0)),
                              static_cast<std::int32_t>(ids->GetId(1)),
                              static_cast<std::int32_t>(ids->GetId(2))});
  }
  return mesh;
}

std::shared_ptr<const geometry::TriangleMesh> simplified(const geometry::TriangleMesh& mesh,
                                                         std::size_t max_triangles) {
  if (mesh.triangles.size() <= max_triangles) return std::make_shared<geometry::TriangleMesh>(mesh);
  const vtkSmartPointer<vtkPolyData> whole = vtk_from_mesh(mesh);
  whole->GetPointData()->Initialize();  // shape alone decides
  auto decimation = vtkSmartPointer<vtkQuadricDecimation>::New();
  decimation->SetInputData(whole);
  decimation->SetTargetReduction(1.0 - static_cast<double>(max_triangles) /
                                           static_cast<double>(mesh.triangles.size()));
  decimation->Update();
  return std::make_shared<geometry::TriangleMesh>(mesh_from_vtk(*decimation->GetOutput()));
}

}  // namespace arthronaut::scene
