// A case to be reported on, and the report's words.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/report/report.h"
#include "navigation/recording/session.h"
#include "navigation/tools/tool_set.h"
#include "planning/cases/case.h"
#include "planning/files/atomic_file.h"
#include "planning/phantom/phantom_case.h"
#include "tests/resources/described.h"
#include "tests/temporary_folder.h"

namespace arthronaut::report {

// A case of the phantom, its meshes coarse: pictures are looked at elsewhere.
class Report : public ::testing::Test {
 protected:
  void SetUp() override {
    static const cases::Case made =
        phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 3.0}), "Knee of Ærø");
    knee_ = made;
    cases::save_case(knee_folder(), knee_);
  }
  std::filesystem::path knee_folder() const { return folder_ / "Knee.arthro"; }
  std::filesystem::path pdf() const { return folder_ / "report.pdf"; }

  // With small pictures, which are most of the work; how they look is tested elsewhere.
  // For other programs it is as its schema says.
  std::vector<std::string> write(const std::filesystem::path& output, ReportOptions options = {}) const {
    options.picture_px_per_mm = 1;
    const std::vector<std::string> doubts = write_report(knee_folder(), output, options);
    if (output.extension() == ".json") {
      EXPECT_EQ(test::undescribed(nlohmann::json::parse(files::read_text(output)), "report"), "");
    }
    return doubts;
  }
  std::string made(ReportOptions options) const {
    options.picture_px_per_mm = 1;
    return make_report(knee_folder(), options);
  }

  std::string pdf_info() const { return output_of("pdfinfo " + pdf().string()); }
  // Words that a reader finds without complaint: libharu's own text map made it warn.
  std::string pdf_text() const {
    const std::string text = output_of("pdftotext -layout " + pdf().string() + " - 2>&1");
    EXPECT_EQ(text.find("Syntax"), std::string::npos) << text.substr(0, 200);
    return text;
  }

  // The report of a session of this kind of source with a registration, and with these events after it.
  std::string text_of_session(const std::string& source_kind,
                              const std::vector<std::pair<std::string_view, std::string>>& events,
                              bool finds_pose = true) const {
    const auto session_folder = cases::create_session_folder(knee_folder());
    pipeline::PipelineOptions options;
    options.calibration = {.image_size_px = {1920, 1080}, .focal_px = 600, .boundary = {{960, 540}, 520}};
    options.tools = tools::standard_tools();
    recording::SessionHeader header;
    header.id = session_folder.filename().string();
    header.source_kind = sources::source_kind_from_text(source_kind);
    registration::RegistrationSummary registration;
    registration.has_pose = registration.reliable = finds_pose;
    if (finds_pose) registration.reasons.clear();
    recording::SessionRecorder recorder(session_folder, header, options);
    recorder.set_registration(registration);
    for (const auto& [kind, text] : events) recorder.add_event({0, std::string(kind), text, -1});
    recorder.finish();
    write(pdf());
    return pdf_text();
  }

  cases::Case knee_;

 private:
  std::string output_of(const std::string& command) const {
    const auto file = folder_ / "output.txt";
    EXPECT_EQ(std::system((command + " > " + file.string()).c_str()), 0) << command;
    return files::read_text(file);
  }
  const test::TemporaryFolder folder_;
};

inline int page_count(const std::string& info) {
  const auto at = info.find("Pages:");
  return at == std::string::npos ? 0 : std::atoi(info.c_str() + at + 6);
}

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

}  // namespace arthronaut::report
