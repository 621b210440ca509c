#include "navigation/recording/session_hashes.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <span>

#include "planning/files/sha256.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMostBytesOfARecord = std::int64_t{64} << 20;

struct NumberedTable {
  const char* name;
  const char* number;
  const char* order;
};
constexpr std::array kFrameTables = {
    NumberedTable{"frames", "frame", "1"},    NumberedTable{"markers", "frame", "1, 2"},
    NumberedTable{"bodies", "frame", "1, 2"}, NumberedTable{"guidance", "frame", "1"},
    NumberedTable{"digests", "frame", "1"},   NumberedTable{"latency", "frame", "1"},
    NumberedTable{"outside", "frame", "1, 2"}};
constexpr std::size_t kFrameTablesOfBefore = 6;
constexpr std::array kEventTables = {NumberedTable{"events", "id", "1"}};
constexpr std::array kPictureTables = {NumberedTable{"pictures", "picture", "1"}};

std::span<const NumberedTable> tables_of(const std::string& of) {
  if (of == kFrameRows) return kFrameTables;
  if (of == kFrameRowsOfBefore) return std::span(kFrameTables).first(kFrameTablesOfBefore);
  if (of == kEventRows) return kEventTables;
  return kPictureTables;
}

void sync_file(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;  // gone: whoever reads it says so
  ::fdatasync(descriptor);
  ::close(descriptor);
}

}  // namespace

bool is_of_rows(const std::string& of) {
  return of == kFrameRows || of == kFrameRowsOfBefore || of == kEventRows || of == kPictureRows;
}

std::string sha256_of_rows(SessionDatabase& database, const std::string& of, std::int64_t from,
                           std::int64_t to) {
  files::Sha256 hash;
  std::string row;
  for (const NumberedTable& table : tables_of(of)) {
    const std::string number = table.number;
    Statement statement = database.prepare("SELECT * FROM " + std::string(table.name) + " WHERE " + number +
                                           " >= ? AND " + number + " < ? ORDER BY " + table.order);
    statement.bind(1, from).bind(2, to);
    row = table.name;
    while (statement.step()) {
      for (int column = 0; column < statement.column_count(); ++column) statement.append_value(column, row);
      hash.add(std::as_bytes(std::span(row)));
      row.clear();
    }
    hash.add(std::as_bytes(std::span(row)));  // the name of a table without rows
  }
  return hash.hex();
}

std::int64_t rows_end(SessionDatabase& database, const std::string& of) {
  std::int64_t end = 0;
  for (const NumberedTable& table : tables_of(of)) {
    Statement last =
        database.prepare("SELECT MAX(" + std::string(table.number) + ") FROM " + std::string(table.name));
    if (last.step() && !last.is_null(0)) end = std::max(end, last.integer(0) + 1);
  }
  return end;
}

fs::path file_of(const fs::path& session_folder, const std::string& of) {
  const fs::path file = session_folder / of;
  const fs::path part = session_folder / (of + ".part");
  return !fs::exists(file) && fs::exists(part) ? part : file;
}

std::int64_t size_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

std::optional<std::string> sha256_of_bytes(const fs::path& file, std::int64_t from, std::int64_t to) {
  if (size_of(file) < to || !fs::exists(file)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !stream.seekg(from)) throw IoError(file, "cannot be read");
  files::Sha256 hash;
  std::array<char, 65536> buffer{};
  for (std::int64_t left = to - from; left > 0;) {
    const auto wanted = static_cast<std::streamsize>(std::min<std::int64_t>(left, buffer.size()));
    if (!stream.read(buffer.data(), wanted)) throw IoError(file, "cannot be read");
    hash.add(std::as_bytes(std::span(buffer.data(), static_cast<std::size_t>(wanted))));
    left -= wanted;
  }
  return hash.hex();
}

SessionHashes::SessionHashes(const fs::path& session_folder)
    : folder_(session_folder), chain_(session_folder) {}

SessionHashes::SessionHashes(const fs::path& session_folder, const ReadChain& read)
    : folder_(session_folder), chain_(session_folder, read) {
  for (const ChainRecord& record : read.records)
    covered_[record.of] = std::max(covered_[record.of], record.to);  // -1: about to be written
}

std::optional<SessionHashes> SessionHashes::of_finished(const fs::path& session_folder) {
  if (!fs::exists(chain_file(session_folder))) return std::nullopt;
  const ReadChain read = read_chain(session_folder);
  if (!read.problem.empty() || read.ends_in_half_a_line) return std::nullopt;
  return SessionHashes(session_folder, read);
}

void SessionHashes::write_file(const std::string& name, const std::function<void()>& write) {
  announce_file(name);
  // Else a power cut could leave the new file and the old hash: changed, as it seems.
  chain_.sync();
  write();
  cover_file(name);
}

void SessionHashes::announce_file(const std::string& name) {
  chain_.append(name, 0, -1, std::string(64, '0'));
}

void SessionHashes::cover_file(const std::string& name) {
  const fs::path file = folder_ / name;
  if (fs::exists(file)) cover_bytes(name, 0, size_of(file));
}

void SessionHashes::cover_growth(const std::string& name, std::int64_t head) {
  const fs::path file = file_of(folder_, name);
  const std::int64_t size = size_of(file);
  std::int64_t from = covered_[name];
  if (size <= from || size < head) return;
  sync_file(file);
  while (from < size) {
    const std::int64_t most = from == 0 && head > 0 ? head : kMostBytesOfARecord;
    const std::int64_t to = std::min(size, from + most);
    cover_bytes(name, from, to);
    from = to;
  }
  covered_[name] = from;
}

void SessionHashes::cover_to_end(const std::string& name, std::int64_t head) {
  const std::int64_t size = size_of(file_of(folder_, name));
  const bool has_head = head > 0 && covered_[name] > 0;
  if (has_head) cover_bytes(name, 0, std::min(head, size));
  cover_growth(name, std::min(head, size));
}

void SessionHashes::cover_bytes(const std::string& name, std::int64_t from, std::int64_t to) {
  if (const auto hash = sha256_of_bytes(file_of(folder_, name), from, to))
    chain_.append(name, from, to, *hash);
}

void SessionHashes::cover_rows(SessionDatabase& database, const std::string& of, std::int64_t end) {
  std::int64_t& from = covered_[of];
  if (end <= from) return;
  chain_.append(of, from, end, sha256_of_rows(database, of, from, end));
  from = end;
}

void SessionHashes::announce_events() {
  chain_.append(kEventRows, covered_[kEventRows], -1, std::string(64, '0'));
  if (covered_.contains(kDatabaseFile)) announce_file(kDatabaseFile);
  chain_.sync();
}

void SessionHashes::cover_sealed_database() {
  if (!covered_.contains(kDatabaseFile)) return;
  cover_file(kDatabaseFile);
  chain_.sync();
}

void SessionHashes::close() {
  chain_.append(kChainEnd, 0, 0, std::string(64, '0'));
  chain_.sync();
}

}  // namespace arthronaut::recording
