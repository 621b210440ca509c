#include "app/command_line/option_checks.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>
#include <type_traits>
#include <utility>

#include "app/report/report.h"
#include "planning/bones/mesh_file.h"
#include "planning/cases/own_files.h"
#include "planning/files/format.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/images/dicom_file.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;

// limits: as the help has them.
template <typename Number>
CLI::Validator of_number(const std::string& limits, const std::function<bool(Number)>& is_right) {
  return {[limits, is_right](const std::string& text) {
            Number value = 0;
            if (CLI::detail::lexical_cast(text, value) && is_right(value)) return std::string();
            const bool is_whole = std::is_integral_v<Number>;
            return "\"" + text + "\" must be a " + (is_whole ? "whole number, " : "number, ") + limits;
          },
          limits};
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(file, ignored), in = fs::weakly_canonical(folder, ignored);
  return std::mismatch(in.begin(), in.end(), whole.begin(), whole.end()).first == in.end();
}

// Of a file that is there. Of a folder the DICOM images are read, not what another command has written there.
bool is_read(const fs::path& file, const fs::path& input) {
  std::error_code ignored;
  if (fs::is_directory(input, ignored)) return lies_in(file, input) && images::has_dicom_mark(file);
  const bool is_pattern = input.filename().string().find('%') != std::string::npos;
  if (is_pattern && file.extension() == input.extension())
    return fs::equivalent(fs::absolute(file).parent_path(), fs::absolute(input).parent_path(), ignored);
  return fs::equivalent(file, input, ignored);
}

void refuse_loss(const fs::path& file, const NamedFiles& files) {
  std::error_code ignored;
  if (fs::exists(file, ignored)) {
    for (const fs::path& input : files.read)
      if (is_read(file, input))
        throw InvalidInput(file, "", "is what is read: what is written needs a file of its own");
  }
  const bool is_made =
      file.filename() == files.makes && fs::exists(fs::absolute(file).parent_path() / "case.json", ignored);
  if (cases::is_own_file(file) && !is_made)
    throw InvalidInput(file, "", "is one of the case's own files: what is written needs another name");
}

void refuse_unwritable_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) throw IoError(file, "is a folder, not a file");
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder, error)) {
    const bool is_closed = error == std::errc::permission_denied;
    throw IoError(file, is_closed ? error.message() : "the folder " + folder.string() + " does not exist");
  }
  files::refuse_unwritable(folder, file);
}

}  // namespace

CLI::Validator between(double least, double greatest) {
  return of_number<double>(files::format("%.16g to %.16g", least, greatest),
                           [least, greatest](double value) { return value >= least && value <= greatest; });
}

CLI::Validator whole_between(std::int64_t least, std::int64_t greatest) {
  return of_number<std::int64_t>(
      std::to_string(least) + " to " + std::to_string(greatest),
      [least, greatest](std::int64_t value) { return value >= least && value <= greatest; });
}

CLI::Validator finite() {
  return of_number<double>("finite", [](double value) { return std::isfinite(value); });
}

CLI::Validator above_zero() {
  return of_number<double>("above 0", [](double value) { return value > 0 && std::isfinite(value); });
}

CLI::Validator a_seed() { return whole_between(0, std::int64_t{1} << 53); }

CLI::Validator a_marker_id() {
  constexpr int kDictionarySize = 50;
  return of_number<std::int64_t>("0 to 49 (DICT_4X4_50)",
                                 [](std::int64_t value) { return value >= 0 && value < kDictionarySize; });
}

CLI::Validator a_name() {
  return {[](const std::string& text) { return std::string(text.empty() ? "must not be empty" : ""); }, ""};
}

CLI::Validator a_file() {
  return {[](const std::string& text) {
            if (text == "-") return std::string("\"-\": what is written is no text, it needs a file");
            return std::string(text.empty() ? "must not be empty" : "");
          },
          ""};
}

CLI::Validator read_by(std::function<void(const std::string&)> read) {
  return {[read = std::move(read)](const std::string& text) {
            try {
              read(text);
            } catch (const InvalidInput& error) {
              return std::string(error.what());
            }
            return std::string();
          },
          ""};
}

void add_mesh_options(CLI::App& command, std::string& space, std::string& unit, const std::string& mesh) {
  command
      .add_option("--space", space, "Frame of " + mesh + " when its file doesn't say: lps (default) or ras")
      ->check(read_by([](const std::string& text) { (void)bones::space_from_text(text); }));
  command.add_option("--unit", unit, "Length unit of " + mesh + ": mm, cm, m or in")
      ->check(read_by([](const std::string& text) { (void)bones::length_unit_from_text(text); }));
}

void refuse_another_ending(const fs::path& output, const std::vector<std::string>& endings) {
  std::error_code ignored;
  if (fs::is_other(output, ignored) || std::ranges::find(endings, report::ending_of(output)) != endings.end())
    return;
  std::string words = endings.size() == 1 ? " does not end in " : " ends in none of ";
  for (const std::string& ending : endings) {
    const bool is_first = &ending == &endings.front(), is_last = &ending == &endings.back();
    words += (is_first ? "" : is_last ? " and " : ", ") + ending;
  }
  throw CLI::ValidationError("--output", output.string() + words);
}

void refuse_together(const std::function<void()>& check) {
  try {
    check();
  } catch (const InvalidInput& error) {
    throw CLI::ValidationError(error.what(), CLI::ExitCodes::ValidationError);
  }
}

void refuse_before_the_work(const NamedFiles& files) {
  std::set<fs::path> taken;
  for (const fs::path& file : files.written) {
    std::error_code ignored;
    if (file.empty() || file == "-" || fs::is_other(file, ignored)) continue;
    if (!taken.insert(fs::weakly_canonical(fs::absolute(file), ignored)).second)
      throw InvalidInput(file, "", "is to be written twice");
    refuse_loss(file, files);
    refuse_unwritable_file(file);
  }
}

}  // namespace arthronaut::command_line
