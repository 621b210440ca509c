#include "planning/images/dicom_slice.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"
#include "planning/images/dicom_frames.h"

namespace arthronaut::images {

namespace {

DicomOrigin origin_of(DcmDataset& dataset) {
  DicomOrigin origin;
  const std::pair<DcmTagKey, std::string*> texts[] = {
      {DCM_StudyInstanceUID, &origin.study_uid},
      {DCM_StudyID, &origin.study_id},
      {DCM_AccessionNumber, &origin.accession_number},
      {DCM_ReferringPhysicianName, &origin.referring_physician},
      {DCM_StudyDate, &origin.study_date},
      {DCM_StudyTime, &origin.study_time},
      {DCM_PatientSex, &origin.patient_sex},
      {DCM_IssuerOfPatientID, &origin.patient_id_issuer},
      {DCM_SeriesInstanceUID, &origin.series_uid},
      {DCM_FrameOfReferenceUID, &origin.frame_of_reference_uid},
      {DCM_SOPClassUID, &origin.sop_class_uid}};
  for (const auto& [key, text] : texts) *text = utf8_text_of(dataset, key);
  if (std::string uid = text_of(dataset, DCM_SOPInstanceUID); !uid.empty())
    origin.sop_instance_uids.push_back(std::move(uid));
  return origin;
}

// What is there and cannot be read must not pass for what is not there: bone would have other values.
double rescaling_of(const DicomSlice& slice, DcmDataset& dataset, const DcmTagKey& key, double absent) {
  if (const auto value = decimals_of(dataset, key, 1)) return value->front();
  if (!text_of(dataset, key).empty())
    throw InvalidInput(slice.file, slice.place(), "its rescaling holds no numbers");
  return absent;
}

DicomSlice common_part(const std::filesystem::path& file, DcmDataset& dataset) {
  DicomSlice slice;
  slice.file = file;
  slice.series_uid = text_of(dataset, DCM_SeriesInstanceUID);
  slice.series_number = text_of(dataset, DCM_SeriesNumber);
  slice.description = utf8_text_of(dataset, DCM_SeriesDescription);
  slice.modality = text_of(dataset, DCM_Modality);
  slice.patient = {utf8_text_of(dataset, DCM_PatientName), utf8_text_of(dataset, DCM_PatientID),
                   text_of(dataset, DCM_PatientBirthDate)};
  slice.origin = std::make_shared<const DicomOrigin>(origin_of(dataset));
  slice.frame.rows = unsigned_short_of(dataset, DCM_Rows, 0);
  slice.frame.columns = unsigned_short_of(dataset, DCM_Columns, 0);
  if (const auto frames = decimals_of(dataset, DCM_NumberOfFrames, 1)) {
    constexpr double kMostFrames = 65536;
    if (!(frames->front() >= 1 && frames->front() <= kMostFrames))
      throw InvalidInput(file, "number of frames", "is out of range");
    slice.frames_in_file = static_cast<int>(frames->front());
  }
  slice.frame.slope = rescaling_of(slice, dataset, DCM_RescaleSlope, slice.frame.slope);
  slice.frame.intercept = rescaling_of(slice, dataset, DCM_RescaleIntercept, slice.frame.intercept);
  // Of the image before that of the series, of which it may be one of the other side.
  slice.side = side_of(dataset, DCM_ImageLaterality);
  if (!slice.side) slice.side = side_of(dataset, DCM_Laterality);
  if (const auto echo = decimals_of(dataset, DCM_EchoTime, 1)) slice.echo_time_ms = echo->front();
  if (const auto number = decimals_of(dataset, DCM_InstanceNumber, 1))
    slice.instance_number = number->front();
  if (const auto tilt = decimals_of(dataset, DCM_GantryDetectorTilt, 1))
    slice.gantry_tilt_deg = tilt->front();
  return slice;
}

// Directions are written with few digits: near enough to unit and to each other's normal is made exactly so.
void square_up(DicomSlice& slice) {
  if (!slice.has_geometry) return;
  const double skew = slice.along_columns.dot(slice.along_rows);
  if (!(std::abs(slice.along_columns.norm() - 1) <= 0.01) ||
      !(std::abs(slice.along_rows.norm() - 1) <= 0.01) || !(std::abs(skew) <= 0.01) ||
      !(slice.row_spacing_mm > 0) || !(slice.column_spacing_mm > 0) || !slice.position_mm.allFinite()) {
    throw InvalidInput(slice.file, slice.place(), "its image orientation or pixel spacing is not one");
  }
  slice.along_columns.normalize();
  slice.along_rows =
      (slice.along_rows - slice.along_rows.dot(slice.along_columns) * slice.along_columns).normalized();
}

void read_geometry(DcmDataset& dataset, DicomSlice& slice) {
  const auto position = decimals_of(dataset, DCM_ImagePositionPatient, 3);
  const auto orientation = decimals_of(dataset, DCM_ImageOrientationPatient, 6);
  const auto spacing = decimals_of(dataset, DCM_PixelSpacing, 2);
  if (!position || !orientation || !spacing) return;
  slice.position_mm = Eigen::Vector3d(position->data());
  slice.along_columns = Eigen::Vector3d(orientation->data());
  slice.along_rows = Eigen::Vector3d(orientation->data() + 3);
  slice.row_spacing_mm = (*spacing)[0];
  slice.column_spacing_mm = (*spacing)[1];
  slice.has_geometry = true;
}

}  // namespace

Eigen::Vector3d DicomSlice::normal() const { return along_columns.cross(along_rows); }

std::string DicomSlice::place() const {
  return frames_in_file > 1 ? "frame " + std::to_string(frame.number + 1) : "";
}

std::string DicomSlice::name() const {
  return (frames_in_file > 1 ? place() + " of " : "") + file.filename().string();
}

std::optional<std::vector<DicomSlice>> read_dicom_slices(const std::filesystem::path& file,
                                                         std::size_t most_bytes) {
  if (!has_dicom_mark(file)) return std::nullopt;
  const std::shared_ptr<DcmDataset> dataset = open_dicom(file, most_bytes);
  const DicomSlice common = common_part(file, *dataset);
  // Plans, contours and reports of the same study have no rows.
  if (common.frame.rows == 0 || common.frame.columns == 0) return std::vector<DicomSlice>{};
  std::vector<DicomSlice> slices;
  if (has_functional_groups(*dataset)) {
    slices = slices_of_frames(common, *dataset);
  } else if (common.frames_in_file > 1) {
    throw InvalidInput(file, "",
                       "holds " + std::to_string(common.frames_in_file) +
                           " frames and does not say where each lies in the patient");
  } else {
    slices = {common};
    read_geometry(*dataset, slices.front());
  }
  const auto pixels = std::make_shared<const DicomPixels>(file, dataset);
  for (DicomSlice& slice : slices) {
    square_up(slice);
    slice.pixels = pixels;
  }
  return slices;
}

void append_pixels(const DicomSlice& slice, std::vector<float>& values) {
  slice.pixels->append_frame(slice.frame, values);
}

}  // namespace arthronaut::images
