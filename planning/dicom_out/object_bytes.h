// A DCMTK object as the bytes that a file of it holds. Inner header of dicom_out.
#pragma once

#include <string>

class DcmDataset;
class DcmFileFormat;

namespace arthronaut::dicom_out {

// Explicit VR, little endian, sequences of explicit length. Throw IoError when DCMTK cannot.
[[nodiscard]] std::string bytes_of(DcmDataset& dataset);
// A file of DICOM PS3.10, with its preamble and its meta information.
[[nodiscard]] std::string bytes_of(DcmFileFormat& file);

}  // namespace arthronaut::dicom_out
