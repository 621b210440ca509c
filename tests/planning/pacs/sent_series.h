// Series in a PACS of the tests.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "planning/images/volume.h"
#include "tests/planning/images/dicom_series_form.h"
#include "tests/planning/pacs/orthanc.h"

namespace arthronaut::test {

// Short waits: the peer is on this machine.
[[nodiscard]] inline pacs::ConnectionOptions quick_connection() {
  return {.our_ae_title = "ARTHRONAUT",
          .tls = std::nullopt,
          .connect_timeout_s = 5,
          .answer_timeout_s = 20,
          .retries = 2,
          .first_pause_s = 0.05,
          .listening_port = 0};
}

// Writes the series there and sends it. Throws what sending throws.
void write_and_send(const Orthanc& orthanc, const std::filesystem::path& folder,
                    const DicomSeriesForm& form = {},
                    const pacs::ConnectionOptions& connection = quick_connection());

// The pixels of every image of the folder, by UID.
[[nodiscard]] std::map<std::string, std::string> pixels_of(const std::filesystem::path& folder);

inline constexpr int kImageCount = 44;  // of ellipsoid_ct()

}  // namespace arthronaut::test
