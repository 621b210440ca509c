// A drawn volume as VTK draws it: rays cast through it on the processor, on all cores, so that it needs
// nothing of OpenGL. Private to this module.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkVolume.h>

#include <vector>

#include "app/scene/drawn_volume.h"

namespace arthronaut::scene {

[[nodiscard]] vtkSmartPointer<vtkVolume> vtk_from_volume(const DrawnVolume& volume);
// Preset, threshold, opacity and cuts. `volume` is of vtk_from_volume(*item.volume).
void dress(vtkVolume& volume, const VolumeItem& item);
// One ray for a square of this many pixels; at 1 samples lie half a voxel apart along it, else a whole one.
void set_detail(vtkVolume& volume, double pixels_per_ray);

}  // namespace arthronaut::scene
