#include "tests/planning/images/enhanced_dicom.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcddirif.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmfg/fgfracon.h>
#include <dcmtk/dcmfg/fginterface.h>
#include <dcmtk/dcmfg/fgpixeltransform.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmjpeg/djencode.h>

#include <cmath>
#include <stdexcept>

#include "tests/planning/bones/mesh_text_forms.h"

namespace arthronaut::test {

namespace {

constexpr double kIntercept = -1024;

void require(const OFCondition& condition, const char* what) {
  if (condition.bad()) throw std::runtime_error(std::string(what) + ": " + condition.text());
}

void put(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  require(item.putAndInsertString(key, value.c_str()), value.c_str());
}

std::string joined(const Eigen::Vector3d& v) {
  return number(v.x()) + "\\" + number(v.y()) + "\\" + number(v.z());
}

// Other slopes for neighbouring slices: that of another frame would tell.
double slope_of(int slice) { return slice % 2 == 0 ? 1 : 0.5; }

std::vector<Uint16> stored_slice(const images::Volume& volume, int slice, double slope) {
  std::vector<Uint16> stored;
  for (int j = 0; j < volume.size.y(); ++j) {
    for (int i = 0; i < volume.size.x(); ++i)
      stored.push_back(static_cast<Uint16>(std::lround((volume.at(i, j, slice) - kIntercept) / slope)));
  }
  return stored;
}

void describe_pixels(DcmDataset& dataset, const images::Volume& volume) {
  put(dataset, DCM_PhotometricInterpretation, "MONOCHROME2");
  const std::pair<DcmTagKey, int> numbers[] = {{DCM_SamplesPerPixel, 1},       {DCM_Rows, volume.size.y()},
                                               {DCM_Columns, volume.size.x()}, {DCM_BitsAllocated, 16},
                                               {DCM_BitsStored, 16},           {DCM_HighBit, 15},
                                               {DCM_PixelRepresentation, 0}};
  for (const auto& [key, value] : numbers)
    require(dataset.putAndInsertUint16(key, static_cast<Uint16>(value)), "a number");
}

void add_shared_groups(FGInterface& groups, const images::Volume& volume) {
  const Eigen::Vector3d spacing = volume.spacing_mm();
  FGPixelMeasures measures;
  require(measures.setPixelSpacing((number(spacing.y()) + "\\" + number(spacing.x())).c_str(), OFFalse),
          "spacing");
  require(measures.setSliceThickness("99", OFFalse), "thickness");  // must not be believed
  require(groups.addShared(measures), "measures");
  const Eigen::Vector3d c = volume.lps_from_index.linear().col(0) / spacing.x();
  const Eigen::Vector3d r = volume.lps_from_index.linear().col(1) / spacing.y();
  FGPlaneOrientationPatient orientation;
  require(orientation.setImageOrientationPatient(number(c.x()).c_str(), number(c.y()).c_str(),
                                                 number(c.z()).c_str(), number(r.x()).c_str(),
                                                 number(r.y()).c_str(), number(r.z()).c_str(), OFFalse),
          "orientation");
  require(groups.addShared(orientation), "orientation");
}

void add_frame_groups(FGInterface& groups, const images::Volume& volume, Uint32 frame, int slice) {
  const Eigen::Vector3d p = volume.lps_from_index * Eigen::Vector3d(0, 0, slice);
  FGPlanePosPatient position;
  require(position.setImagePositionPatient(number(p.x()).c_str(), number(p.y()).c_str(),
                                           number(p.z()).c_str(), OFFalse),
          "position");
  require(groups.addPerFrame(frame, position), "position");
  FGPixelValueTransformation rescaling;
  require(rescaling.setRescaleSlope(number(slope_of(slice)).c_str(), OFFalse), "slope");
  require(rescaling.setRescaleIntercept(number(kIntercept).c_str(), OFFalse), "intercept");
  require(rescaling.setRescaleType("HU", OFFalse), "type");
  require(groups.addPerFrame(frame, rescaling), "rescaling");
  FGFrameContent content;
  require(content.setStackID("1", OFFalse), "stack");
  require(groups.addPerFrame(frame, content), "content");
}

void register_encoders() {
  static const bool is_ready = [] {
    DcmRLEEncoderRegistration::registerCodecs();
    DJEncoderRegistration::registerCodecs();
    return true;
  }();
  static_cast<void>(is_ready);
}

void save(DcmFileFormat& format, const std::filesystem::path& file, const std::string& transfer_syntax) {
  register_encoders();
  const E_TransferSyntax syntax = DcmXfer(transfer_syntax.c_str()).getXfer();
  require(format.getDataset()->chooseRepresentation(syntax, nullptr), "encoding");
  require(format.saveFile(file.c_str(), syntax), "saving");
}

}  // namespace

void write_enhanced_dicom(const std::filesystem::path& file, const images::Volume& volume,
                          const EnhancedForm& form) {
  DcmFileFormat format;
  DcmDataset& dataset = *format.getDataset();
  put(dataset, DCM_SOPClassUID,
      form.modality == "CT" ? UID_EnhancedCTImageStorage : UID_EnhancedMRImageStorage);
  put(dataset, DCM_SOPInstanceUID, "1.2.3.9");
  put(dataset, DCM_Modality, form.modality);
  put(dataset, DCM_SeriesInstanceUID, "1.2.3.4");
  put(dataset, DCM_SeriesNumber, "3");
  put(dataset, DCM_NumberOfFrames, std::to_string(form.slices.size()));
  describe_pixels(dataset, volume);
  FGInterface groups;
  add_shared_groups(groups, volume);
  std::vector<Uint16> stored;
  for (std::size_t frame = 0; frame < form.slices.size(); ++frame) {
    const int slice = form.slices[frame];
    add_frame_groups(groups, volume, static_cast<Uint32>(frame), slice);
    auto pixels = stored_slice(volume, slice, slope_of(slice));
    if (!form.echo_times_ms.empty() && form.echo_times_ms[frame] != form.echo_times_ms.front())
      for (Uint16& pixel : pixels) pixel = static_cast<Uint16>(pixel / 2);
    stored.insert(stored.end(), pixels.begin(), pixels.end());
  }
  require(groups.write(dataset), "functional groups");
  for (std::size_t frame = 0; frame < form.echo_times_ms.size(); ++frame) {
    DcmItem *item = nullptr, *echo = nullptr;
    require(
        dataset.findAndGetSequenceItem(DCM_PerFrameFunctionalGroupsSequence, item, static_cast<long>(frame)),
        "frame");
    require(item->findOrCreateSequenceItem(DCM_MREchoSequence, echo, 0), "echo");
    require(echo->putAndInsertFloat64(DCM_EffectiveEchoTime, form.echo_times_ms[frame]), "echo time");
  }
  require(dataset.putAndInsertUint16Array(DCM_PixelData, stored.data(),
                                          static_cast<unsigned long>(stored.size())),
          "pixels");
  form.change(dataset);
  save(format, file, form.transfer_syntax);
}

void write_listed_slice(const std::filesystem::path& folder, const images::Volume& volume,
                        const ListedSlice& slice) {
  DcmFileFormat format;
  DcmDataset& dataset = *format.getDataset();
  const std::string instance_uid = slice.series_uid + ".1" + std::to_string(slice.slice);
  const std::pair<DcmTagKey, std::string> texts[] = {{DCM_SOPClassUID, UID_CTImageStorage},
                                                     {DCM_SOPInstanceUID, instance_uid},
                                                     {DCM_PatientName, "KNEE^A"},
                                                     {DCM_PatientID, "1"},
                                                     {DCM_StudyInstanceUID, "1.2.3"},
                                                     {DCM_StudyID, "1"},
                                                     {DCM_StudyDate, "20260101"},
                                                     {DCM_StudyTime, "120000"},
                                                     {DCM_StudyDescription, "KNEE"},
                                                     {DCM_AccessionNumber, "1"},
                                                     {DCM_Modality, "CT"},
                                                     {DCM_SeriesInstanceUID, slice.series_uid},
                                                     {DCM_SeriesNumber, "3"},
                                                     {DCM_InstanceNumber, std::to_string(slice.slice + 1)}};
  for (const auto& [key, text] : texts) put(dataset, key, text);
  const Eigen::Vector3d spacing = volume.spacing_mm();
  put(dataset, DCM_ImagePositionPatient, joined(volume.lps_from_index * Eigen::Vector3d(0, 0, slice.slice)));
  put(dataset, DCM_ImageOrientationPatient,
      joined(volume.lps_from_index.linear().col(0) / spacing.x()) + "\\" +
          joined(volume.lps_from_index.linear().col(1) / spacing.y()));
  put(dataset, DCM_PixelSpacing, number(spacing.y()) + "\\" + number(spacing.x()));
  put(dataset, DCM_RescaleSlope, number(slope_of(slice.slice)));
  put(dataset, DCM_RescaleIntercept, number(kIntercept));
  describe_pixels(dataset, volume);
  const auto stored = stored_slice(volume, slice.slice, slope_of(slice.slice));
  require(dataset.putAndInsertUint16Array(DCM_PixelData, stored.data(),
                                          static_cast<unsigned long>(stored.size())),
          "pixels");
  save(format, folder / slice.name, UID_LittleEndianExplicitTransferSyntax);
}

void write_dicom_directory(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);  // it tells every step
  DicomDirInterface directory;
  directory.enableInventMode();
  directory.disableBackupMode();
  directory.disableEncodingCheck();
  directory.disableConsistencyCheck();
  require(directory.createNewDicomDir(DicomDirInterface::AP_GeneralPurpose, (folder / "DICOMDIR").c_str(),
                                      "KNEE"),
          "directory");
  for (const std::string& name : names) {
    std::string file_id = name;
    require(directory.addDicomFile(file_id.c_str(), folder.c_str()), name.c_str());
  }
  require(directory.writeDicomDir(), "directory");
}

}  // namespace arthronaut::test
