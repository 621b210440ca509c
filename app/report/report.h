// The surgeon's report of a case: plan, theatre, planned against achieved, versions. Two to four pages: where
// it would be more, pictures are smaller and the middle of a long list is left to the report as JSON.
// Warnings are never cut, whatever it comes to.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/report/paper.h"

namespace arthronaut::report {

struct ReportOptions {
  // Names the patient as identity.json does. Without it nothing of identity.json is in the report, nor the
  // name of the video's file, which often is the patient's.
  bool with_identity = false;
  // For strangers: no date, no session's name and no picture of the video, into which a name may be drawn.
  // Identity is left out whatever is said above. In JSON and CSV they are null.
  bool is_deidentified = false;
  // When it was made, to be said; empty: the same case gives the same bytes at any time.
  std::string made_utc = {};
  Paper paper = Paper::A4;  // of a PDF
  // Of a PDF's pictures of bones, at least 0.5: drawing them is most of what a report takes.
  double picture_px_per_mm = 12;
  // Tells of this session, by its folder's name, whatever it came to, and of what was drilled before it.
  std::string session = {};
  // What goes on, and how much of the whole is done, 0 to 1. May be empty.
  std::function<void(const std::string& what, double share)> on_progress = {};

  void tell(const std::string& what, double share) const {
    if (on_progress) on_progress(what, share);
  }
};

// ".pdf" of "Knee.PDF": what is written goes by it.
[[nodiscard]] std::string ending_of(const std::filesystem::path& output);

// Where none is named, the newest session with a drilled tunnel is reported, else the newest with a
// registration; the report says so when there is none. By the output's ending: .json and .csv are the same
// numbers for other programs, anything else is a PDF. Atomic. Throws IoError, InvalidInput (a broken case, a
// session that is not there), DeviceError (no OpenGL at all for the pictures). Returns, in words, which
// sessions are not in it since they cannot be read, that its own is no longer what was recorded, and that the
// plan's side is in doubt; the report says so too. Reads all of that session, to hash it.
std::vector<std::string> write_report(const std::filesystem::path& case_folder,
                                      const std::filesystem::path& output, const ReportOptions& options = {});
// The bytes of such a file. Throws as write_report.
[[nodiscard]] std::string make_report(const std::filesystem::path& case_folder,
                                      const ReportOptions& options = {});

}  // namespace arthronaut::report
