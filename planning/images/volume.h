// A volume of a CT, an MR or a label map, and where each of its voxels is in the patient.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"

namespace arthronaut::images {

// Whose picture it is, as the file says; each may be empty.
struct Patient {
  std::string name, id, birth_date;
};

// A named part of a label map, as 3D Slicer's .seg.nrrd has it.
struct Segment {
  std::string name;
  int label = 0;  // the value of its voxels
};

// As the file says. Of a file that does not say (NIfTI never does) Ct where a value lies below -500, as air
// does in HU and nothing that means anything does elsewhere; else Unknown, as of a label map.
enum class Modality { Unknown, Ct, Mr, Other };

struct Volume {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  // Takes an index (i, j, k), the centre of that voxel, to LPS in mm. Oblique, sheared and mirrored axes are
  // all possible; never singular.
  Eigen::Affine3d lps_from_index = Eigen::Affine3d::Identity();
  // i runs fastest. Rescaled: Hounsfield units for a CT, labels as they are. Finite.
  std::vector<float> values;
  std::string format;                     // "DICOM", "NIfTI"
  Patient patient;                        // DICOM alone says so
  std::string modality_in_file;           // "CT", "MR", "PT"; empty when the file does not say
  Modality modality = Modality::Unknown;  // whatever reads a volume decides it
  // Of the body that is shown, as whoever took the images marked them (DICOM alone); nullopt where none of
  // them says it, or not all the same.
  std::optional<bones::Side> side;
  std::vector<Segment> segments;   // empty where the file names none
  std::vector<std::string> notes;  // choices that the reader made, for a person to see

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] float at(int i, int j, int k) const { return values[index(i, j, k)]; }
  // Distance of neighbouring voxels along i, j and k.
  [[nodiscard]] Eigen::Vector3d spacing_mm() const { return lps_from_index.linear().colwise().norm(); }
};

// How often each value occurs, for a volume that holds whole numbers only and not more than 256 of them; else
// empty.
[[nodiscard]] std::vector<std::pair<int, std::size_t>> labels_of(const Volume& volume);

// Whether the volume is one of labels: of no known modality, whole numbers from 0, and each mostly beside its
// own like. An image of 8 bits has as few numbers, but another one beside nearly every voxel.
[[nodiscard]] bool is_label_map(const Volume& volume);

// "left-posterior-superior" for the axes i, j, k: the patient direction that each comes closest to.
[[nodiscard]] std::string axes_in_words(const Volume& volume);

}  // namespace arthronaut::images
