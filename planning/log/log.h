// The log that `--log FILE` asks for: what a run was started with, which sources were opened and ended, every
// error where it is caught, registrations and alarms. It is for whoever looks for the cause of something
// afterwards. Nothing of the program reads it, and what the user must know is said on the screen and in the
// record, never here alone.
//
// Until open() a line goes nowhere and costs the reading of one number. There is one log a process, since a
// line may come from anywhere: that is why these are functions and nothing is handed around. Every function
// may be called from any thread. Not for the way of a frame: log what changes, not what is.
#pragma once

#include <filesystem>
#include <string_view>

namespace arthronaut::log {

// Debug: with --verbose alone. Warning: went on without something. Error: caught at the top of a thread, of a
// command or of the program.
enum class Level { Debug, Info, Warning, Error };

// From here on lines of this level and above are appended to the file, one by one and at once, so that a
// crash loses none: "2026-11-22 03:04:05.678 info [thread] text", in local time. Called again: into another
// file. A new file is its owner's alone to read: lines hold names of folders. Throws IoError when the folder
// is not there or the file can't be written.
void open(const std::filesystem::path& file, Level least);
void close();
[[nodiscard]] bool takes(Level level);  // whether a line of this level goes anywhere: to save making it

// One line; line ends in it are written as spaces. Where it can't be written (disk full) it is left out:
// nothing depends on the log.
void write(Level level, std::string_view line);

inline void debug(std::string_view line) { write(Level::Debug, line); }
inline void info(std::string_view line) { write(Level::Info, line); }
inline void warning(std::string_view line) { write(Level::Warning, line); }
inline void error(std::string_view line) { write(Level::Error, line); }

}  // namespace arthronaut::log
