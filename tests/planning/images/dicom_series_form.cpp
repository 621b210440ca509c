#include "tests/planning/images/dicom_series_form.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/planning/bones/mesh_text_forms.h"

namespace arthronaut::test {

namespace {

void require(const OFCondition& condition, const char* what) {
  if (condition.bad()) throw std::runtime_error(std::string(what) + ": " + condition.text());
}

void put(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  if (!value.empty()) require(item.putAndInsertString(key, value.c_str()), value.c_str());
}

std::string joined(const Eigen::Vector3d& v) {
  return number(v.x()) + "\\" + number(v.y()) + "\\" + number(v.z());
}

void put_origin(DcmDataset& dataset, const DicomSeriesForm& form) {
  const images::DicomOrigin& origin = form.origin;
  put(dataset, DCM_SpecificCharacterSet, form.character_set);
  put(dataset, DCM_PatientName, form.patient.name);
  put(dataset, DCM_PatientID, form.patient.id);
  put(dataset, DCM_PatientBirthDate, form.patient.birth_date);
  put(dataset, DCM_PatientSex, origin.patient_sex);
  put(dataset, DCM_IssuerOfPatientID, origin.patient_id_issuer);
  put(dataset, DCM_StudyInstanceUID, origin.study_uid);
  put(dataset, DCM_StudyID, origin.study_id);
  put(dataset, DCM_StudyDate, origin.study_date);
  put(dataset, DCM_StudyTime, origin.study_time);
  put(dataset, DCM_AccessionNumber, origin.accession_number);
  put(dataset, DCM_ReferringPhysicianName, origin.referring_physician);
  put(dataset, DCM_SeriesInstanceUID, origin.series_uid);
  put(dataset, DCM_FrameOfReferenceUID, origin.frame_of_reference_uid);
  put(dataset, DCM_SOPClassUID, origin.sop_class_uid);
}

void put_pixels(DcmDataset& dataset, const images::Volume& volume, int slice) {
  const std::pair<DcmTagKey, int> numbers[] = {{DCM_SamplesPerPixel, 1},       {DCM_Rows, volume.size.y()},
                                               {DCM_Columns, volume.size.x()}, {DCM_BitsAllocated, 16},
                                               {DCM_BitsStored, 16},           {DCM_HighBit, 15},
                                               {DCM_PixelRepresentation, 1}};
  for (const auto& [key, value] : numbers)
    require(dataset.putAndInsertUint16(key, static_cast<Uint16>(value)), "a number");
  put(dataset, DCM_PhotometricInterpretation, "MONOCHROME2");
  std::vector<Uint16> stored;
  for (int j = 0; j < volume.size.y(); ++j) {
    for (int i = 0; i < volume.size.x(); ++i)
      stored.push_back(static_cast<Uint16>(static_cast<Sint16>(std::lround(volume.at(i, j, slice)))));
  }
  require(dataset.putAndInsertUint16Array(DCM_PixelData, stored.data(), stored.size()), "pixels");
}

}  // namespace

void write_dicom_series(const std::filesystem::path& folder, const images::Volume& volume,
                        const DicomSeriesForm& form) {
  std::filesystem::create_directories(folder);
  const Eigen::Vector3d spacing = volume.spacing_mm();
  for (int k = 0; k < volume.size.z(); ++k) {
    DcmFileFormat format;
    DcmDataset& dataset = *format.getDataset();
    put_origin(dataset, form);
    put(dataset, DCM_SOPInstanceUID, form.origin.series_uid + "." + std::to_string(k));
    put(dataset, DCM_Modality, "CT");
    put(dataset, DCM_SeriesNumber, "3");
    put(dataset, DCM_InstanceNumber, std::to_string(k + 1));
    put(dataset, DCM_ImagePositionPatient, joined(volume.lps_from_index * Eigen::Vector3d(0, 0, k)));
    put(dataset, DCM_ImageOrientationPatient,
        joined(volume.lps_from_index.linear().col(0) / spacing.x()) + "\\" +
            joined(volume.lps_from_index.linear().col(1) / spacing.y()));
    put(dataset, DCM_PixelSpacing, number(spacing.y()) + "\\" + number(spacing.x()));
    put_pixels(dataset, volume, k);
    if (form.change) form.change(dataset, k);
    const auto file = folder / ("slice" + std::to_string(1000 + k) + ".dcm");
    require(format.saveFile(file.c_str(), EXS_LittleEndianExplicit), "saving");
  }
}

images::Volume ellipsoid_ct() {
  images::Volume volume;
  volume.size = {40, 36, 44};
  volume.lps_from_index.linear() = Eigen::Vector3d(2, 2, 2).asDiagonal();
  volume.lps_from_index.translation() = Eigen::Vector3d(-70, -35, -40);
  const Eigen::Vector3d middle(20, 18, 22), radii(14, 12, 16);
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = 0; i < volume.size.x(); ++i) {
        const double at = (Eigen::Vector3d(i, j, k) - middle).cwiseQuotient(radii).norm();
        volume.values.push_back(at < 1 ? 700.0F : -100.0F);
      }
    }
  }
  return volume;
}

}  // namespace arthronaut::test
