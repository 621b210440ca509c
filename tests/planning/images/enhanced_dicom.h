// Enhanced (multi-frame) CT and MR and directories of discs, made by DCMTK: what is to be read is known by
// construction.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "planning/images/volume.h"

class DcmDataset;

namespace arthronaut::test {

struct EnhancedForm {
  std::string modality = "CT";
  std::string transfer_syntax = "1.2.840.10008.1.2.1";  // UID
  // Which slices of the volume the frames show, in the order of the file.
  std::vector<int> slices{2, 0, 3, 1};
  // Of each frame; empty: none is written. A frame of another echo than the first holds other values.
  std::vector<double> echo_times_ms = {};
  // The last change before the file is written.
  std::function<void(DcmDataset&)> change = [](DcmDataset&) {};
};

// Every frame with its own position and rescaling; orientation and spacing are shared by all.
void write_enhanced_dicom(const std::filesystem::path& file, const images::Volume& volume,
                          const EnhancedForm& form = {});

// A slice of a series with all that a directory asks for. The name must be of eight capitals and figures at
// most.
struct ListedSlice {
  std::string name, series_uid;
  int slice = 0;
};
void write_listed_slice(const std::filesystem::path& folder, const images::Volume& volume,
                        const ListedSlice& slice);
// folder/DICOMDIR over these files.
void write_dicom_directory(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace arthronaut::test
