#include "app/scene/vtk_volume.h"

#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkUnsignedShortArray.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <array>

namespace arthronaut::scene {

namespace {

vtkFixedPointVolumeRayCastMapper& mapper_of(vtkVolume& volume) {
  return *vtkFixedPointVolumeRayCastMapper::SafeDownCast(volume.GetMapper());
}

// As steep as noise allows: a slow ramp would fill the bone's edge up with what only lies beside it.
constexpr double kRamp_hu = 30;

// What VolumeItem::opacity is of.
constexpr double kTranslucent_mm = 10;

struct Tissue {
  double value_hu, opacity;  // of a millimetre
  Color color;
};
constexpr std::array<Tissue, 4> kSoftTissue{
    Tissue{-250, 0, {0.93F, 0.78F, 0.60F}}, Tissue{-150, 0.012, {0.93F, 0.78F, 0.60F}},    // fat, skin
    Tissue{-20, 0.012, {0.93F, 0.78F, 0.60F}}, Tissue{40, 0.020, {0.72F, 0.34F, 0.30F}}};  // muscle

}  // namespace

vtkSmartPointer<vtkVolume> vtk_from_volume(const DrawnVolume& volume) {
  vtkNew<vtkUnsignedShortArray> levels;
  levels->SetNumberOfValues(static_cast<vtkIdType>(volume.levels.size()));
  std::ranges::copy(volume.levels, levels->GetPointer(0));
  // Spacing stays with the image, whose gradients need it; the directions of its axes become the matrix.
  const Eigen::Vector3d spacing = volume.lps_from_index.linear().colwise().norm();
  vtkNew<vtkImageData> image;
  image->SetDimensions(volume.size.x(), volume.size.y(), volume.size.z());
  image->SetSpacing(spacing.x(), spacing.y(), spacing.z());
  image->GetPointData()->SetScalars(levels);
  vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
  mapper->SetInputData(image);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->IntermixIntersectingGeometryOn();
  auto actor = vtkSmartPointer<vtkVolume>::New();
  actor->SetMapper(mapper);
  vtkNew<vtkMatrix4x4> lps_from_image;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      lps_from_image->SetElement(row, column, volume.lps_from_index.linear()(row, column) / spacing[column]);
    lps_from_image->SetElement(row, 3, volume.lps_from_index.translation()[row]);
  }
  actor->SetUserMatrix(lps_from_image);
  set_detail(*actor, 1);
  return actor;
}

void dress(vtkVolume& volume, const VolumeItem& item) {
  const DrawnVolume& drawn = *item.volume;
  const auto level = [&](double value) { return (value - drawn.lowest) / drawn.per_level; };
  vtkNew<vtkPiecewiseFunction> opacity;
  vtkNew<vtkColorTransferFunction> color;
  const auto paint = [&](double value, double red, double green, double blue) {
    color->AddRGBPoint(level(value), red, green, blue);
  };
  const auto let_see = [&](double value, double alpha) { opacity->AddPoint(level(value), alpha); };
  const double t = item.threshold;
  const bool is_grey = item.preset == VolumePreset::Grey;
  if (is_grey) {
    let_see(t - drawn.per_level, 0);
    let_see(t + drawn.per_level, 1);
    paint(drawn.lowest, 0, 0, 0);
    paint(drawn.highest, 1, 1, 1);
  } else {
    let_see(t - kRamp_hu, item.preset == VolumePreset::Bone ? 0 : 0.05);
    let_see(t + kRamp_hu, 1);
    paint(t, kBoneColor.red, kBoneColor.green, kBoneColor.blue);
    // Below the bone; a threshold within the soft tissue leaves out what lies above it.
    for (const Tissue& tissue : kSoftTissue) {
      if (tissue.value_hu >= t - kRamp_hu) break;
      if (item.preset == VolumePreset::BoneAndSoftTissue) let_see(tissue.value_hu, tissue.opacity);
      paint(tissue.value_hu, tissue.color.red, tissue.color.green, tissue.color.blue);
    }
    paint(1600, 1, 0.98, 0.94);
  }
  vtkVolumeProperty* property = volume.GetProperty();
  if (item.opacity < 1) {
    vtkNew<vtkPiecewiseFunction> thinned;
    for (int i = 0; i < opacity->GetSize(); ++i) {
      double node[4];
      opacity->GetNodeValue(i, node);
      thinned->AddPoint(node[0], item.opacity * node[1]);
    }
    property->SetScalarOpacity(thinned);
  } else {
    property->SetScalarOpacity(opacity);
  }
  property->SetColor(color);
  property->SetInterpolationTypeToLinear();
  // A cut through an MR is read by its greys: light would turn the noise of their slope into dark and bright.
  property->SetShade(is_grey ? 0 : 1);
  property->SetAmbient(0.15);
  property->SetDiffuse(0.85);
  property->SetSpecular(0.12);
  property->SetSpecularPower(18);
  property->SetScalarOpacityUnitDistance(item.opacity < 1 ? kTranslucent_mm : 1);
  auto& mapper = mapper_of(volume);
  mapper.RemoveAllClippingPlanes();
  for (const CutPlane& cut : item.cuts) {
    vtkNew<vtkPlane> plane;  // VTK keeps what lies on its normal's side
    const Eigen::Vector3d kept = -cut.normal;
    plane->SetOrigin(cut.point_mm.x(), cut.point_mm.y(), cut.point_mm.z());
    plane->SetNormal(kept.x(), kept.y(), kept.z());
    mapper.AddClippingPlane(plane);
  }
}

void set_detail(vtkVolume& volume, double pixels_per_ray) {
  auto& mapper = mapper_of(volume);
  double spacing[3];
  vtkImageData::SafeDownCast(mapper.GetInput())->GetSpacing(spacing);
  const double voxel = std::min({spacing[0], spacing[1], spacing[2]});
  mapper.SetImageSampleDistance(static_cast<float>(pixels_per_ray));
  mapper.SetSampleDistance(static_cast<float>(pixels_per_ray > 1 ? voxel : voxel / 2));
}

}  // namespace arthronaut::scene
