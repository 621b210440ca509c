#include "planning/library/library_index.h"

#include <sqlite3.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "planning/files/private_folder.h"
#include "planning/geometry/error.h"
#include "planning/library/case_record_json.h"

namespace arthronaut::library {

namespace {

namespace fs = std::filesystem;
constexpr int kWait_ms = 10'000;
constexpr int kApplicationId = 0x41525448;  // "ARTH": another program's database is not taken for ours

// Names of folders are bytes, not text: a BLOB keeps them whatever their character set.
constexpr const char* kTable =
    "CREATE TABLE IF NOT EXISTS cases("
    "folder BLOB PRIMARY KEY, fingerprint INTEGER NOT NULL, record TEXT NOT NULL) WITHOUT ROWID";

}  // namespace

struct LibraryIndex::State {
  fs::path file;
  sqlite3* database = nullptr;

  ~State() { sqlite3_close(database); }
  void check(int result) const {
    if (result == SQLITE_OK || result == SQLITE_ROW || result == SQLITE_DONE) return;
    const std::string reason = database != nullptr ? sqlite3_errmsg(database) : "out of memory";
    const int kind = result & 0xFF;
    if (kind == SQLITE_CORRUPT || kind == SQLITE_NOTADB || kind == SQLITE_ERROR) throw IndexIsDamaged(reason);
    throw IoError(file, reason);
  }
  void execute(const char* sql) const { check(sqlite3_exec(database, sql, nullptr, nullptr, nullptr)); }
};

namespace {

using Bytes = std::string_view;

// Bound by position from 1, read by column from 0.
class Statement {
 public:
  template <class Check>
  Statement(sqlite3* database, const char* sql, const Check& check) {
    check(sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr));
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  void bind_blob(int at, Bytes bytes) const {
    sqlite3_bind_blob(statement_, at, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
  }
  void bind_text(int at, Bytes text) const {
    sqlite3_bind_text(statement_, at, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }
  void bind(int at, std::int64_t number) const { sqlite3_bind_int64(statement_, at, number); }
  [[nodiscard]] int step() const { return sqlite3_step(statement_); }
  void reset() const { sqlite3_reset(statement_); }
  [[nodiscard]] std::int64_t number(int column) const { return sqlite3_column_int64(statement_, column); }
  [[nodiscard]] Bytes bytes(int column) const {
    const void* data = sqlite3_column_blob(statement_, column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return data != nullptr ? Bytes(static_cast<const char*>(data), size) : Bytes();
  }

 private:
  sqlite3_stmt* statement_ = nullptr;
};

// Ends a transaction that was not committed.
class Transaction {
 public:
  template <class Execute>
  Transaction(sqlite3* database, const Execute& execute) : database_(database) {
    execute("BEGIN IMMEDIATE");
  }
  ~Transaction() {
    if (database_ != nullptr) sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  template <class Execute>
  void commit(const Execute& execute) {
    execute("COMMIT");
    database_ = nullptr;
  }

 private:
  sqlite3* database_;
};

std::string text_of(const CaseRecord& record) {
  return to_json(record).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

fs::path index_file(const fs::path& data_folder) { return data_folder / "library-4.sqlite"; }

LibraryIndex::LibraryIndex(const fs::path& file) : state_(std::make_unique<State>()) {
  state_->file = file;
  files::begin_private_file(file);
  const int opened =
      sqlite3_open_v2(file.c_str(), &state_->database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  if (opened != SQLITE_OK) throw IoError(file, sqlite3_errstr(opened));
  sqlite3_busy_timeout(state_->database, kWait_ms);
  const auto check = [this](int result) { state_->check(result); };
  const Statement application(state_->database, "PRAGMA application_id", check);
  const Statement tables(state_->database, "SELECT count(*) FROM sqlite_master", check);
  check(application.step());
  check(tables.step());
  if (tables.number(0) == 0) {
    tables.reset();
    state_->execute(("PRAGMA application_id = " + std::to_string(kApplicationId)).c_str());
    state_->execute(kTable);
  } else if (application.number(0) != kApplicationId) {
    throw IndexIsDamaged("is not the index of the library");
  }
  // A whole page is read for each check: of a thousand cases some milliseconds.
  const Statement whole(state_->database, "PRAGMA quick_check(1)", check);
  check(whole.step());
  if (whole.bytes(0) != "ok") throw IndexIsDamaged(std::string(whole.bytes(0)));
}

LibraryIndex::~LibraryIndex() = default;

std::unordered_set<std::string> LibraryIndex::folders() const {
  const auto check = [this](int result) { state_->check(result); };
  const Statement rows(state_->database, "SELECT folder FROM cases", check);
  std::unordered_set<std::string> folders;
  int result = SQLITE_DONE;
  while ((result = rows.step()) == SQLITE_ROW) folders.emplace(rows.bytes(0));
  check(result);
  return folders;
}

std::vector<IndexedCase> LibraryIndex::cases() const {
  const auto check = [this](int result) { state_->check(result); };
  const Statement rows(state_->database, "SELECT folder, fingerprint, record FROM cases", check);
  std::vector<IndexedCase> cases;
  int result = SQLITE_DONE;
  while ((result = rows.step()) == SQLITE_ROW) {
    IndexedCase one;
    one.fingerprint = rows.number(1);
    try {
      if (const Bytes text = rows.bytes(2); !text.empty())
        one.record = record_from(nlohmann::json::parse(text.begin(), text.end()));
    } catch (const nlohmann::json::exception&) {
      one = {};  // is read again
    } catch (const InvalidInput&) {
      one = {};
    }
    one.record.folder = fs::path(std::string(rows.bytes(0)));
    cases.push_back(std::move(one));
  }
  check(result);
  return cases;
}

void LibraryIndex::put(std::span<const IndexedCase> cases) {
  if (cases.empty()) return;
  const auto check = [this](int result) { state_->check(result); };
  const auto execute = [this](const char* sql) { state_->execute(sql); };
  Transaction transaction(state_->database, execute);
  {
    const Statement row(state_->database, "INSERT OR REPLACE INTO cases VALUES(?, ?, ?)", check);
    for (const IndexedCase& one : cases) {
      row.bind_blob(1, one.record.folder.string());
      row.bind(2, one.fingerprint);
      row.bind_text(3, text_of(one.record));
      check(row.step());
      row.reset();
    }
  }
  transaction.commit(execute);
}

void LibraryIndex::add(std::span<const fs::path> folders) {
  if (folders.empty()) return;
  const auto check = [this](int result) { state_->check(result); };
  const auto execute = [this](const char* sql) { state_->execute(sql); };
  Transaction transaction(state_->database, execute);
  {
    const Statement row(state_->database, "INSERT OR IGNORE INTO cases VALUES(?, 0, '')", check);
    for (const fs::path& folder : folders) {
      row.bind_blob(1, folder.string());
      check(row.step());
      row.reset();
    }
  }
  transaction.commit(execute);
}

void LibraryIndex::forget(std::span<const fs::path> folders) {
  if (folders.empty()) return;
  const auto check = [this](int result) { state_->check(result); };
  const auto execute = [this](const char* sql) { state_->execute(sql); };
  Transaction transaction(state_->database, execute);
  {
    const Statement row(state_->database, "DELETE FROM cases WHERE folder = ?", check);
    for (const fs::path& folder : folders) {
      row.bind_blob(1, folder.string());
      check(row.step());
      row.reset();
    }
  }
  transaction.commit(execute);
}

}  // namespace arthronaut::library
