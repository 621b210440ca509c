// Checks of what was asked for, made before any work. CLI11's own let NaN pass, and name limits of 309
// digits: every option that takes a number has one of these. A wrong value is wrong usage; a file that
// cannot be written, or that would be lost, is invalid input.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace arthronaut::command_line {

[[nodiscard]] CLI::Validator between(double least, double greatest);
[[nodiscard]] CLI::Validator whole_between(std::int64_t least, std::int64_t greatest);
[[nodiscard]] CLI::Validator finite();
[[nodiscard]] CLI::Validator above_zero();  // and finite
[[nodiscard]] CLI::Validator a_seed();      // 0 to 2^53, which every reader of JSON keeps
[[nodiscard]] CLI::Validator a_marker_id();
// Not empty; and of what is no text, not "-" either, which stands for standard output.
[[nodiscard]] CLI::Validator a_name();
[[nodiscard]] CLI::Validator a_file();
// What `read` throws of a value is what is wrong with it.
[[nodiscard]] CLI::Validator read_by(std::function<void(const std::string&)> read);
// --space and --unit of what `mesh` names ("the mesh"); empty where they are not given.
void add_mesh_options(CLI::App& command, std::string& space, std::string& unit, const std::string& mesh);
// Wrong usage where the file ends, in large letters or small ones, in none of these (".pdf"). Devices and
// pipes are of any name.
void refuse_another_ending(const std::filesystem::path& output, const std::vector<std::string>& endings);
// What `check` throws of several options together is wrong usage too.
void refuse_together(const std::function<void()>& check);

// What a command reads and writes by names of the user's; an empty one is none.
struct NamedFiles {
  std::vector<std::filesystem::path> read, written;
  std::string_view makes = {};  // the file of a case that this command is there to write: camera.json
};
// Throws InvalidInput where what is written would take the place of what is read (a file, one of a folder of
// DICOM images or of a pattern of pictures), of a case's own file or of another thing written; IoError where
// its folder is not there or cannot be written. "-", devices and pipes are written to.
void refuse_before_the_work(const NamedFiles& files);

}  // namespace arthronaut::command_line
