#include "tests/planning/pacs/sent_series.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <stdexcept>

#include "planning/pacs/send.h"

namespace arthronaut::test {

void write_and_send(const Orthanc& orthanc, const std::filesystem::path& folder, const DicomSeriesForm& form,
                    const pacs::ConnectionOptions& connection) {
  write_dicom_series(folder, ellipsoid_ct(), form);
  pacs::SendOptions options;
  options.asks_commitment = false;
  const auto summary = pacs::send_files(orthanc.peer(), connection, pacs::files_to_send({folder}), options);
  if (!summary.is_usable()) throw std::runtime_error("not stored: " + summary.files.front().note);
}

std::map<std::string, std::string> pixels_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> pixels;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    DcmFileFormat format;
    const Uint16* values = nullptr;
    unsigned long count = 0;
    OFString uid;
    if (format.loadFile(entry.path().c_str()).bad() ||
        format.getDataset()->findAndGetUint16Array(DCM_PixelData, values, &count).bad() ||
        format.getDataset()->findAndGetOFString(DCM_SOPInstanceUID, uid).bad())
      throw std::runtime_error(entry.path().string() + ": not a whole image");
    pixels[uid.c_str()] = std::string(reinterpret_cast<const char*>(values), count * sizeof(Uint16));
  }
  return pixels;
}

}  // namespace arthronaut::test
