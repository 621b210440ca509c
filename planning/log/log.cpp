#include "planning/log/log.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "planning/geometry/error.h"

namespace arthronaut::log {

namespace {

constexpr int kClosed = 1 + static_cast<int>(Level::Error);

spdlog::level::level_enum level_of(Level level) {
  switch (level) {
    case Level::Debug:
      return spdlog::level::debug;
    case Level::Info:
      return spdlog::level::info;
    case Level::Warning:
      return spdlog::level::warn;
    case Level::Error:
      break;
  }
  return spdlog::level::err;
}

// Not spdlog's own registry: that one is shared with every library that uses spdlog too.
struct Log {
  std::atomic<int> least{kClosed};
  std::mutex mutex;  // of what the logger is, not of its lines
  std::shared_ptr<spdlog::logger> logger;
};

Log& the_log() {
  static Log log;
  return log;
}

}  // namespace

void open(const std::filesystem::path& file, Level least) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  // spdlog would make the folders of a slip of the keyboard.
  if (file.has_parent_path() && !fs::is_directory(file.parent_path(), ignored))
    throw IoError(file, "the log cannot be written there: there is no such folder");
  const bool is_new = !fs::exists(file, ignored);
  std::shared_ptr<spdlog::logger> logger;
  try {
    logger = std::make_shared<spdlog::logger>(
        "arthronaut", std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string()));
  } catch (const spdlog::spdlog_ex&) {
    throw IoError(file, "the log cannot be written there");
  }
  if (is_new) fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write, ignored);
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %l [%t] %v");
  logger->set_level(spdlog::level::debug);
  logger->flush_on(spdlog::level::debug);
  // By default spdlog tells of lines that it could not write on standard error, which belongs to the command.
  logger->set_error_handler([](const std::string&) {});
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  log.logger = std::move(logger);
  log.least = static_cast<int>(least);
}

void close() {
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  log.least = kClosed;
  log.logger.reset();
}

bool takes(Level level) { return static_cast<int>(level) >= the_log().least.load(std::memory_order_relaxed); }

void write(Level level, std::string_view line) {
  if (!takes(level)) return;
  Log& log = the_log();
  std::shared_ptr<spdlog::logger> logger;
  {
    const std::lock_guard lock(log.mutex);
    logger = log.logger;
  }
  if (!logger) return;
  std::string text(line);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  logger->log(level_of(level), spdlog::string_view_t(text));
}

}  // namespace arthronaut::log
