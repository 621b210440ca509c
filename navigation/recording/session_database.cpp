#include "navigation/recording/session_database.h"

#include <bit>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

// States are stored as the numbers of their enumerators, whose order is therefore part of this format.
constexpr int kSchemaVersion = 2;

// For another connection that reads or writes just now.
constexpr int kWait_ms = 5000;
constexpr auto kSealWait = std::chrono::seconds(2);

constexpr const char* kTables = R"(
CREATE TABLE frames(
  frame INTEGER PRIMARY KEY, timestamp_ns INTEGER NOT NULL,
  circle_found INTEGER, circle_x_px REAL, circle_y_px REAL, circle_radius_px REAL, circle_coverage_deg REAL,
  mark_state INTEGER, mark_polarity INTEGER, mark_angle_deg REAL, mark_sigma_deg REAL, lens_is_stale INTEGER,
  zoom_or_slip INTEGER, intrinsics_are_known INTEGER, is_frozen INTEGER,
  tip_is_valid INTEGER, tip_x_mm REAL, tip_y_mm REAL, tip_z_mm REAL, processing_ms REAL);
CREATE TABLE markers(
  frame INTEGER, marker_id INTEGER, state INTEGER, has_pose INTEGER,
  qw REAL, qx REAL, qy REAL, qz REAL, tx_mm REAL, ty_mm REAL, tz_mm REAL, rms_px REAL,
  PRIMARY KEY(frame, marker_id)) WITHOUT ROWID;
CREATE TABLE bodies(
  frame INTEGER, body_id INTEGER, qw REAL, qx REAL, qy REAL, qz REAL, tx_mm REAL, ty_mm REAL, tz_mm REAL,
  PRIMARY KEY(frame, body_id)) WITHOUT ROWID;
CREATE TABLE outside(
  frame INTEGER, place INTEGER, body_id INTEGER, state INTEGER, qw REAL, qx REAL, qy REAL, qz REAL, tx_mm REAL,
  ty_mm REAL, tz_mm REAL, stamp_utc_s REAL, age_s REAL, is_arrival INTEGER,
  PRIMARY KEY(frame, place)) WITHOUT ROWID;
CREATE TABLE guidance(
  frame INTEGER PRIMARY KEY, state INTEGER,
  point_x_mm REAL, point_y_mm REAL, point_z_mm REAL, direction_x REAL, direction_y REAL, direction_z REAL,
  tip_to_entry_mm REAL, axis_to_entry_mm REAL, angle_deg REAL, offset_anterior_mm REAL, offset_proximal_mm REAL,
  depth_mm REAL, remaining_mm REAL, sigma_offset_mm REAL, sigma_angle_deg REAL,
  offset_lateral_mm REAL, drill_depth_mm REAL, drill_to_exit_mm REAL, drill_sigma_mm REAL,
  drill_lateral_mm REAL, drill_sigma_offset_mm REAL, drill_sigma_angle_deg REAL, drill_x_mm REAL, drill_y_mm REAL,
  drill_z_mm REAL, drill_direction_x REAL, drill_direction_y REAL, drill_direction_z REAL,
  drill_exit_lateral_mm REAL, drill_marker_id INTEGER);
CREATE TABLE events(id INTEGER PRIMARY KEY, after_frame INTEGER, timestamp_ns INTEGER, kind TEXT, text TEXT);
CREATE TABLE pictures(
  picture INTEGER PRIMARY KEY, frame INTEGER NOT NULL, packet INTEGER NOT NULL, start_packet INTEGER NOT NULL,
  start_ms INTEGER NOT NULL, luma INTEGER);
CREATE TABLE digests(frame INTEGER PRIMARY KEY, state INTEGER NOT NULL, decisions INTEGER NOT NULL);
CREATE TABLE latency(
  frame INTEGER PRIMARY KEY, capture_ms REAL, decode_ms REAL, queue_ms REAL, tracking_ms REAL, operation_ms REAL,
  guidance_ms REAL);
CREATE TABLE ending(finished INTEGER);
)";

[[noreturn]] void fail(sqlite3* database, const std::filesystem::path& file) {
  throw IoError(file, database ? sqlite3_errmsg(database) : "out of memory");
}

}  // namespace

Statement::Statement(sqlite3* database, const std::filesystem::path& file, std::string_view sql)
    : database_(database), file_(file) {
  check(sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr));
}

Statement::~Statement() { sqlite3_finalize(statement_); }

void Statement::check(int result) const {
  if (result != SQLITE_OK) fail(database_, file_);
}

Statement& Statement::bind(int position, std::int64_t value) {
  check(sqlite3_bind_int64(statement_, position, value));
  return *this;
}

Statement& Statement::bind(int position, double value) {
  check(sqlite3_bind_double(statement_, position, value));
  return *this;
}

Statement& Statement::bind(int position, std::string_view value) {
  check(sqlite3_bind_text(statement_, position, value.data(), static_cast<int>(value.size()),
                          SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind_null(int position) {
  check(sqlite3_bind_null(statement_, position));
  return *this;
}

bool Statement::step() {
  const int result = sqlite3_step(statement_);
  if (result != SQLITE_ROW && result != SQLITE_DONE) fail(database_, file_);
  return result == SQLITE_ROW;
}

void Statement::run() {
  (void)step();
  check(sqlite3_reset(statement_));
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_, column); }
int Statement::int32(int column) const {
  return in_range(column, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}
int Statement::in_range(int column, int first, int last) const {
  const std::int64_t value = integer(column);
  if (value < first || value > last)
    throw InvalidInput(file_, sqlite3_column_name(statement_, column),
                       std::to_string(value) + " is out of range");
  return static_cast<int>(value);
}
double Statement::number(int column) const { return sqlite3_column_double(statement_, column); }
int Statement::column_count() const { return sqlite3_column_count(statement_); }
bool Statement::is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))) : "";
}

void Statement::append_value(int column, std::string& bytes) const {
  const int type = sqlite3_column_type(statement_, column);
  bytes += static_cast<char>('0' + type);
  if (type == SQLITE_NULL) return;
  if (type == SQLITE_INTEGER || type == SQLITE_FLOAT) {
    const auto bits = type == SQLITE_INTEGER ? static_cast<std::uint64_t>(integer(column))
                                             : std::bit_cast<std::uint64_t>(number(column));
    for (unsigned shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(bits >> shift & 0xFFU);
    return;
  }
  const std::string value = text(column);
  bytes += std::to_string(value.size()) + ":" + value;
}

SessionDatabase::SessionDatabase(const std::filesystem::path& file, int flags) : file_(file) {
  const int result = sqlite3_open_v2(file.c_str(), &database_, flags, nullptr);
  if (result == SQLITE_OK) {
    sqlite3_busy_timeout(database_, kWait_ms);
    return;
  }
  const std::string reason = database_ ? sqlite3_errmsg(database_) : "out of memory";
  sqlite3_close(database_);
  throw IoError(file, reason);
}

SessionDatabase::SessionDatabase(SessionDatabase&& other) noexcept
    : file_(std::move(other.file_)), database_(std::exchange(other.database_, nullptr)) {}

SessionDatabase::~SessionDatabase() { sqlite3_close(database_); }

void SessionDatabase::execute(const char* sql) {
  if (sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(database_, file_);
}

SessionDatabase SessionDatabase::create(const std::filesystem::path& file) {
  files::begin_private_file(file);  // the log beside it takes its rights
  SessionDatabase database(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;");
  database.execute(kTables);
  database.execute(("PRAGMA user_version = " + std::to_string(kSchemaVersion)).c_str());
  return database;
}

SessionDatabase SessionDatabase::open(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw IoError(file, "no such file");
  SessionDatabase database(file, SQLITE_OPEN_READWRITE);
  const std::int64_t version = database.version();  // its reading must have ended before leave_wal()
  if (version < 1) throw InvalidInput(file, "", "is not the record of a session");
  if (version > kSchemaVersion) {
    throw InvalidInput(file, "",
                       "was written by a newer Arthronaut (version " + std::to_string(version) +
                           ", this one reads up to " + std::to_string(kSchemaVersion) + ")");
  }
  try {  // a session that could not be sealed at its end, since somebody was reading it
    if (!database.is_sealed() && database.is_finished()) (void)database.leave_wal();
  } catch (const IoError&) {
    // Damaged: who reads it says so.
  }
  return database;
}

std::int64_t SessionDatabase::version() {
  Statement statement = prepare("PRAGMA user_version");
  return statement.step() ? statement.integer(0) : 0;
}

bool SessionDatabase::is_sealed() {
  Statement mode = prepare("PRAGMA journal_mode");
  return mode.step() && mode.text(0) != "wal";
}

bool SessionDatabase::is_finished() { return prepare("SELECT finished FROM ending").step(); }

// False while another connection is open, whatever it does: SQLite asks for the file alone. It does not wait
// for that by itself.
bool SessionDatabase::leave_wal() {
  const int result = sqlite3_exec(database_, "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
  return result == SQLITE_OK && is_sealed();
}

bool SessionDatabase::seal() {
  execute("PRAGMA wal_checkpoint(PASSIVE)");
  const auto until = std::chrono::steady_clock::now() + kSealWait;
  while (!leave_wal()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace arthronaut::recording
