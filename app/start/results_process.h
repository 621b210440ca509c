// What a case gives to the hospital's archive, written by `arthronaut dicom` in a process of its own.
#pragma once

#include <filesystem>
#include <stop_token>

#include "app/own_process/own_process.h"

namespace arthronaut::start {

// Empties `folder` first, which is the program's own, and writes there. Blocks; a stop ends the process and
// leaves nothing. Throws IoError.
[[nodiscard]] own_process::CommandOutcome write_dicom_results(const std::filesystem::path& program,
                                                              const std::filesystem::path& case_folder,
                                                              const std::filesystem::path& folder,
                                                              bool is_deidentified,
                                                              const std::stop_token& stop);

}  // namespace arthronaut::start
