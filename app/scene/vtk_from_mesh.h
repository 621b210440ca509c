// The one way from plain meshes to VTK's and back. Private to this module.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "app/scene/solid_mesh.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::scene {

// With smooth point normals.
[[nodiscard]] vtkSmartPointer<vtkPolyData> vtk_from_mesh(const geometry::TriangleMesh& mesh);
[[nodiscard]] vtkSmartPointer<vtkPolyData> vtk_from_solid(const SolidMesh& mesh);
[[nodiscard]] geometry::TriangleMesh mesh_from_vtk(vtkPolyData& polydata);

}  // namespace arthronaut::scene
