// What a case gives to the hospital's archive, written by `arthronaut dicom` in a process of its own: it
// draws off the screen, which a thread beside the window's cannot.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

namespace arthronaut::start {

struct ResultsOutcome {
  enum class End { Written, Unreliable, Failed, Stopped } end = End::Failed;
  std::string words;  // its doubts, or why it failed
};

// Empties `folder` first, which is the program's own, and writes there. Blocks; a stop ends the process and
// leaves nothing. Throws IoError.
[[nodiscard]] ResultsOutcome write_dicom_results(const std::filesystem::path& program,
                                                 const std::filesystem::path& case_folder,
                                                 const std::filesystem::path& folder, bool is_deidentified,
                                                 const std::stop_token& stop);

}  // namespace arthronaut::start
