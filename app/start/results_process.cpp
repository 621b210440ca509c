#include "app/start/results_process.h"

#include <vector>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::start {

namespace fs = std::filesystem;
using End = own_process::CommandOutcome::End;

own_process::CommandOutcome write_dicom_results(const fs::path& program, const fs::path& case_folder,
                                                const fs::path& folder, bool is_deidentified,
                                                const std::stop_token& stop) {
  files::create_private_folder(folder.parent_path());
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) throw IoError(folder, "cannot be emptied: " + error.message());
  std::vector<std::string> arguments{"dicom", case_folder.string(), "-o", folder.string()};
  if (is_deidentified) arguments.emplace_back("--deidentified");
  auto outcome = own_process::run_command(program, std::move(arguments),
                                          folder.parent_path() / (folder.filename().string() + ".log"),
                                          [&stop] { return stop.stop_requested(); });
  if (outcome.end == End::Done || outcome.end == End::Unreliable) return outcome;
  fs::remove_all(folder, error);
  if (outcome.words.empty()) outcome.words = "the results could not be written";
  return outcome;
}

}  // namespace arthronaut::start
