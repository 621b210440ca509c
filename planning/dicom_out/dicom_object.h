// The data sets of the objects, module by module as DICOM PS3.3 has them. Inner header of dicom_out.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "planning/dicom_out/belonging.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::dicom_out {

// What every object says of itself.
struct ObjectKind {
  const char* modality = "";
  const char* series_description = "";
  int series_number = 0;
};
// Far above what scanners count, so that no series of the images has the same number.
inline constexpr ObjectKind kModels{"M3D", "Arthronaut: bones", 9001};
inline constexpr ObjectKind kDocument{"DOC", "Arthronaut: report", 9002};
inline constexpr ObjectKind kPictures{"OT", "Arthronaut: pictures", 9003};
inline constexpr ObjectKind kPlan{"FID", "Arthronaut: plan", 9004};

struct Object {
  std::string file_name;
  Belonging belonging;
  ObjectKind kind;
  std::unique_ptr<DcmDataset>
      dataset;  // whole but for the identifiers of series and instance, and its number
};

// What they have in common.
struct ObjectSetting {
  bones::Side side = bones::Side::Right;
  std::string moment_utc = {};  // of the contents, ISO 8601; empty: not known
  // cases::short_plan_hash(), by which report, session and tables name the plan; empty: nothing is planned.
  std::string plan_hash = {};

  // As the object says it: by the clock on the wall where it lies beside images, whose times are, too, as
  // DICOM has it where no offset from UTC is said. Empty where it is not told.
  [[nodiscard]] DicomMoment moment_in(const Belonging& belonging) const;
};

// Encapsulated STL (A.85.1). `stl` is binary. Throw IoError when DCMTK refuses an element.
[[nodiscard]] Object model_object(const Belonging& belonging, const ObjectSetting& setting,
                                  const std::string& title, const std::string& stl, bool is_modified);
// Encapsulated PDF (A.45.1).
[[nodiscard]] Object report_object(const Belonging& belonging, const ObjectSetting& setting,
                                   const std::string& pdf);
// Secondary Capture (A.8.1).
[[nodiscard]] Object picture_object(const Belonging& belonging, const ObjectSetting& setting,
                                    const KeyPicture& picture);

struct PlannedTunnel {
  tunnels::Tunnel tunnel;
  Eigen::Vector3d exit_mm;
  std::string frame_of_reference_uid;  // of both
};
// Spatial Fiducials (A.40): entry and exit of each tunnel as points, its axis as a line.
[[nodiscard]] Object plan_object(const Belonging& belonging, const ObjectSetting& setting,
                                 const std::vector<PlannedTunnel>& tunnels);

// What all begin with: patient (C.7.1.1), study (C.7.2.1), series and general equipment (C.7.5.1).
[[nodiscard]] Object begun(const Belonging& belonging, const ObjectKind& kind, const char* sop_class);

// Which knee, where the series says so (general series, C.7.3.1); documents say it of themselves.
void put_knee(DcmDataset& dataset, const ObjectSetting& setting);

// Gives the object its place in a series, and an identifier that follows from all that is in it.
void number(Object& object, const std::string& series_uid, int instance_number);

}  // namespace arthronaut::dicom_out
