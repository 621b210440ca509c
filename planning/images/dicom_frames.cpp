#include "planning/images/dicom_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmfg/fginterface.h>
#include <dcmtk/dcmfg/fgpixeltransform.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>

#include <charconv>

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"

namespace arthronaut::images {

namespace {

template <typename Group>
Group* group_of(FGInterface& groups, std::size_t frame, DcmFGTypes::E_FGType type) {
  return dynamic_cast<Group*>(groups.get(static_cast<Uint32>(frame), type));
}

void read_geometry(FGInterface& groups, std::size_t frame, DicomSlice& slice) {
  auto* position = group_of<FGPlanePosPatient>(groups, frame, DcmFGTypes::EFG_PLANEPOSPATIENT);
  auto* orientation = group_of<FGPlaneOrientationPatient>(groups, frame, DcmFGTypes::EFG_PLANEORIENTPATIENT);
  auto* measures = group_of<FGPixelMeasures>(groups, frame, DcmFGTypes::EFG_PIXELMEASURES);
  if (!position || !orientation || !measures) return;
  Eigen::Vector3d& p = slice.position_mm;
  Eigen::Vector3d &c = slice.along_columns, &r = slice.along_rows;
  slice.has_geometry =
      position->getImagePositionPatient(p.x(), p.y(), p.z()).good() &&
      orientation->getImageOrientationPatient(c.x(), c.y(), c.z(), r.x(), r.y(), r.z()).good() &&
      measures->getPixelSpacing(slice.row_spacing_mm, 0).good() &&
      measures->getPixelSpacing(slice.column_spacing_mm, 1).good();
}

void read_rescaling(FGInterface& groups, std::size_t frame, DicomSlice& slice) {
  const auto* transform =
      group_of<FGPixelValueTransformation>(groups, frame, DcmFGTypes::EFG_PIXELVALUETRANSMETA);
  if (!transform) return;
  OFString slope, intercept;
  if (transform->getRescaleSlope(slope).bad() || transform->getRescaleIntercept(intercept).bad()) return;
  OFBool has_slope = OFFalse, has_intercept = OFFalse;
  const double slope_value = OFStandard::atof(slope.c_str(), &has_slope);
  const double intercept_value = OFStandard::atof(intercept.c_str(), &has_intercept);
  if (!has_slope || !has_intercept || !std::isfinite(slope_value) || !std::isfinite(intercept_value))
    throw InvalidInput(slice.file, slice.place(), "its rescaling holds no numbers");
  slice.frame.slope = slope_value;
  slice.frame.intercept = intercept_value;
}

// DCMTK has no class for the group of MR echoes: looked up in the frame's item, then in the shared one.
void read_echo_time(DcmItem* own, DcmItem* shared, DicomSlice& slice) {
  for (DcmItem* groups : {own, shared}) {
    DcmItem* echo = nullptr;
    if (!groups || groups->findAndGetSequenceItem(DCM_MREchoSequence, echo).bad() || !echo) continue;
    if (const auto time = decimals_of(*echo, DCM_EffectiveEchoTime, 1)) {
      slice.echo_time_ms = time->front();
      return;
    }
  }
}

// DCMTK's class for it knows no frame without a code for its region.
void read_side(DcmItem* own, DcmItem* shared, DicomSlice& slice) {
  for (DcmItem* groups : {own, shared}) {
    DcmItem* anatomy = nullptr;
    if (!groups || groups->findAndGetSequenceItem(DCM_FrameAnatomySequence, anatomy).bad() || !anatomy)
      continue;
    if (const auto side = side_of(*anatomy, DCM_FrameLaterality)) {
      slice.side = side;
      return;
    }
  }
}

// A group is either of one frame or of all (DICOM PS3.3, C.7.6.16): of two places none is to be believed.
void refuse_said_twice(DcmItem& own, DcmItem& shared, const DicomSlice& slice) {
  for (const DcmTagKey& key :
       {DCM_PlanePositionSequence, DCM_PlaneOrientationSequence, DCM_PixelMeasuresSequence}) {
    if (own.tagExists(key) && shared.tagExists(key))
      throw InvalidInput(slice.file, slice.place(), "says where it lies both for itself and for all frames");
  }
}

DcmSequenceOfItems* sequence_of(DcmDataset& dataset, const DcmTagKey& key) {
  DcmSequenceOfItems* sequence = nullptr;
  return dataset.findAndGetSequence(key, sequence).good() ? sequence : nullptr;
}

}  // namespace

bool has_functional_groups(DcmDataset& dataset) {
  return sequence_of(dataset, DCM_PerFrameFunctionalGroupsSequence) != nullptr;
}

std::vector<DicomSlice> slices_of_frames(const DicomSlice& common, DcmDataset& dataset) {
  DcmSequenceOfItems* per_frame = sequence_of(dataset, DCM_PerFrameFunctionalGroupsSequence);
  DcmSequenceOfItems* shared = sequence_of(dataset, DCM_SharedFunctionalGroupsSequence);
  const auto count = static_cast<std::size_t>(common.frames_in_file);
  if (per_frame->card() != count) {
    throw InvalidInput(
        common.file, "functional groups",
        "are of " + std::to_string(per_frame->card()) + " frames, the file holds " + std::to_string(count));
  }
  FGInterface groups;
  if (const OFCondition condition = groups.read(dataset); condition.bad())
    throw InvalidInput(common.file, "functional groups", condition.text());
  DcmItem* shared_item = shared && shared->card() > 0 ? shared->getItem(0) : nullptr;
  std::vector<DicomSlice> slices(count, common);
  DcmObject* item = nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    item = per_frame->nextInContainer(item);
    DicomSlice& slice = slices[i];
    slice.frame.number = static_cast<int>(i);
    auto* own = dynamic_cast<DcmItem*>(item);
    if (own && shared_item) refuse_said_twice(*own, *shared_item, slice);
    read_geometry(groups, i, slice);
    read_rescaling(groups, i, slice);
    read_echo_time(own, shared_item, slice);
    read_side(own, shared_item, slice);
  }
  return slices;
}

}  // namespace arthronaut::images
