// A case as it is exported, and what of it is read back.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "planning/dicom_out/dicom_export.h"
#include "planning/files/atomic_file.h"
#include "planning/images/volume_file.h"
#include "planning/phantom/phantom_case.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/temporary_folder.h"

namespace arthronaut::dicom_out {

inline std::string text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  return item.findAndGetOFStringArray(key, value).good() ? std::string(value.c_str()) : "(absent)";
}

struct Dicom {
  explicit Dicom(const std::filesystem::path& file) {
    if (format.loadFile(file.c_str()).bad()) throw std::runtime_error("cannot be loaded: " + file.string());
  }
  [[nodiscard]] std::string operator[](const DcmTagKey& key) { return text(*format.getDataset(), key); }
  [[nodiscard]] std::string in(const DcmTagKey& sequence, long number, const DcmTagKey& key) {
    DcmItem* item = nullptr;
    return format.getDataset()->findAndGetSequenceItem(sequence, item, number).good() ? text(*item, key)
                                                                                      : "(no item)";
  }
  [[nodiscard]] std::string document() {
    const Uint8* bytes = nullptr;
    Uint32 length = 0;
    if (format.getDataset()->findAndGetUint8Array(DCM_EncapsulatedDocument, bytes).bad()) return "(absent)";
    (void)format.getDataset()->findAndGetUint32(DCM_EncapsulatedDocumentLength, length);
    return {reinterpret_cast<const char*>(bytes), length};
  }

  DcmFileFormat format;
};

inline std::map<std::string, std::string> contents_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    contents[entry.path().filename().string()] = files::read_text(entry.path());
  return contents;
}

class DicomExport : public testing::Test {
 protected:
  DicomExport() {
    contents_.knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4.0}), "Phantom");
    contents_.knee.created_utc = "2026-01-31T12:34:56Z";
    contents_.moment_utc = "2026-02-01T07:08:09Z";
    contents_.report_pdf = "%PDF-1.4 odd";
    contents_.report_pdf += '\n';  // an odd length, which DICOM fills up
    contents_.pictures = {
        {"Picture 1", 3, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18}}};
  }
  // As import leaves it after a series that says all there is to be said.
  void be_of_images() {
    test::write_dicom_series(folder_ / "ct", test::ellipsoid_ct());
    images::VolumeFileOptions options;
    images::DicomOrigin origin;
    options.on_origin = [&](const images::DicomOrigin& found) { origin = found; };
    const images::Volume volume = images::read_volume(folder_ / "ct", options);
    contents_.identity = {volume.patient.name, volume.patient.id, volume.patient.birth_date};
    contents_.studies = {{bones::BoneKind::Femur, origin}, {bones::BoneKind::Tibia, origin}};
  }
  ExportSummary write(const std::string& name = "out") { return export_dicom(contents_, folder_ / name); }
  [[nodiscard]] Dicom read(const std::string& name) const { return Dicom(folder_ / ("out/" + name)); }
  [[nodiscard]] static std::vector<std::string> all_names() {
    return {"femur.dcm", "tibia.dcm",  "femur_drilled.dcm", "tibia_drilled.dcm",
            "plan.dcm",  "report.dcm", "image_001.dcm"};
  }

  ExportContents contents_;
  const test::TemporaryFolder folder_;
};

}  // namespace arthronaut::dicom_out
