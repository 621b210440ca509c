// A series of slices with all that a hospital's says of patient and study, made by DCMTK.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "planning/images/dicom_origin.h"
#include "planning/images/volume.h"

class DcmDataset;

namespace arthronaut::test {

struct DicomSeriesForm {
  images::Patient patient{"Muster^Anna", "4711", "19900131"};
  images::DicomOrigin origin{.study_uid = "1.2.826.0.1.3680043.8.498.1",
                             .study_id = "KNEE-17",
                             .accession_number = "A-0815",
                             .referring_physician = "Dr^House",
                             .study_date = "20260130",
                             .study_time = "081500",
                             .patient_sex = "F",
                             .patient_id_issuer = "Clinic",
                             .series_uid = "1.2.826.0.1.3680043.8.498.2",
                             .frame_of_reference_uid = "1.2.826.0.1.3680043.8.498.3",
                             .sop_class_uid = "1.2.840.10008.5.1.4.1.1.2",
                             .sop_instance_uids = {}};
  // The texts are taken to be written in it already.
  std::string character_set = "";
  // The last change of slice k before its file is written.
  std::function<void(DcmDataset&, int k)> change = nullptr;
};

// One file a slice, of the volume as it is (modality CT). Slice k is the instance "series_uid.k".
void write_dicom_series(const std::filesystem::path& folder, const images::Volume& volume,
                        const DicomSeriesForm& form = {});

// A CT with a bone in it that import takes for a femur: 700 HU in an ellipsoid, the rest -100.
[[nodiscard]] images::Volume ellipsoid_ct();

}  // namespace arthronaut::test
