// Inner header: session.sqlite, a thin RAII layer over SQLite and the tables of a session. Used by the
// recorder and the reader alone.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace arthronaut::recording {

// A prepared statement, bound by position from 1, read by column from 0. NaN cannot be stored: SQLite reads
// it as NULL.
class Statement {
 public:
  Statement(sqlite3* database, const std::filesystem::path& file, std::string_view sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(int position, std::int64_t value);
  Statement& bind(int position, int value) { return bind(position, static_cast<std::int64_t>(value)); }
  Statement& bind(int position, bool value) { return bind(position, static_cast<std::int64_t>(value)); }
  Statement& bind(int position, double value);
  Statement& bind(int position, std::string_view value);
  Statement& bind_null(int position);

  [[nodiscard]] bool step();  // true: a row is there
  void run();                 // step() and reset()

  [[nodiscard]] std::int64_t integer(int column) const;
  // Throws InvalidInput, which names the column, where an int does not hold it.
  [[nodiscard]] int int32(int column) const;
  // A value of an enumeration that counts from 0 to `last`; throws as int32 does.
  template <typename Enumeration>
  [[nodiscard]] Enumeration one_of(int column, Enumeration last) const {
    return static_cast<Enumeration>(in_range(column, 0, static_cast<int>(last)));
  }
  [[nodiscard]] bool boolean(int column) const { return integer(column) != 0; }
  [[nodiscard]] double number(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] int column_count() const;
  // The value with its type, to the last bit: what two rows differ in, these bytes differ in.
  void append_value(int column, std::string& bytes) const;

 private:
  void check(int result) const;
  [[nodiscard]] int in_range(int column, int first, int last) const;

  sqlite3* database_;
  std::filesystem::path file_;
  sqlite3_stmt* statement_ = nullptr;
};

// Every member throws IoError with SQLite's reason.
class SessionDatabase {
 public:
  // A new database in WAL mode with its tables.
  static SessionDatabase create(const std::filesystem::path& file);
  // An existing one; what a crash left in the WAL is taken in. Works in a read-only folder. While a session
  // is being recorded it is held for as long as one reads, and no longer: see seal(). Throws InvalidInput
  // when the file is no session or of a newer version.
  static SessionDatabase open(const std::filesystem::path& file);
  ~SessionDatabase();
  SessionDatabase(SessionDatabase&& other) noexcept;
  SessionDatabase& operator=(SessionDatabase&&) = delete;

  void execute(const char* sql);
  [[nodiscard]] Statement prepare(std::string_view sql) { return {database_, file_, sql}; }
  // Folds the WAL in, so that one file remains which can be read anywhere. False: another program has it open
  // for longer than is waited for. All is kept then, and whoever opens the finished session next folds it.
  [[nodiscard]] bool seal();
  [[nodiscard]] bool is_sealed();

 private:
  SessionDatabase(const std::filesystem::path& file, int flags);
  [[nodiscard]] std::int64_t version();
  [[nodiscard]] bool is_finished();
  [[nodiscard]] bool leave_wal();

  std::filesystem::path file_;
  sqlite3* database_ = nullptr;
};

}  // namespace arthronaut::recording
