// The surgeon's report of a case: plan, theatre, planned against achieved, versions. Two pages or more of A4.
#pragma once

#include <filesystem>

namespace arthronaut::report {

// The newest session with a registration or an achieved tunnel is reported; the report says so when there is
// none. Atomic. Throws IoError, InvalidInput (a broken case), DeviceError (no OpenGL at all for the
// pictures).
void write_report(const std::filesystem::path& case_folder, const std::filesystem::path& output_pdf);

}  // namespace arthronaut::report
