// Inner header: what of a session goes into its chain of hashes (hash_chain.h), and how its hash is made.
//
//   session.json, camera.json, tools.json, registration_N.json, achieved*.json, curves.csv    whole files
//   poses.csv, guidance.csv, the encoded video     as they grow, each stretch of bytes by itself
//   a copied video, every copied still             at the end, 64 MiB a record
//   session.sqlite:frames.2, :events, :pictures    rows of the database by their numbers, as they are read
//                                                  back: while it is recorded its bytes change all the time
//   session.sqlite                                 its bytes, once it is sealed: what no row holds, too
//   end                                            nothing: that all before it was said when the session was
//                                                  finished
//
// A video that was not copied, marks and what lies in the folder besides are not in it.
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "navigation/recording/hash_chain.h"
#include "navigation/recording/session_database.h"

namespace arthronaut::recording {

// Tables whose rows have the same number.
inline constexpr const char* kFrameRows = "session.sqlite:frames.2";
// What records of before say, whose hashes leave out the poses of an outside tracker. The chain itself tells
// the one from the other, so that nobody can make a newer record pass for an older one.
inline constexpr const char* kFrameRowsOfBefore = "session.sqlite:frames";
inline constexpr const char* kEventRows = "session.sqlite:events";
inline constexpr const char* kPictureRows = "session.sqlite:pictures";
[[nodiscard]] bool is_of_rows(const std::string& of);
inline constexpr const char* kDatabaseFile = "session.sqlite";
// Of the record that closes a finished session's chain.
inline constexpr const char* kChainEnd = "end";

// SHA-256 of the rows with numbers in [from, to): of all their tables, in the order of their keys. Throws
// IoError.
[[nodiscard]] std::string sha256_of_rows(SessionDatabase& database, const std::string& of, std::int64_t from,
                                         std::int64_t to);
// The number after the last row's; 0 without a row.
[[nodiscard]] std::int64_t rows_end(SessionDatabase& database, const std::string& of);

// Where the file lies: by its name, or as the .part that a session which was cut off leaves.
[[nodiscard]] std::filesystem::path file_of(const std::filesystem::path& session_folder,
                                            const std::string& of);
// 0 when it is not there.
[[nodiscard]] std::int64_t size_of(const std::filesystem::path& file);
// nullopt: the file ends before `to`, or is not there. Throws IoError.
[[nodiscard]] std::optional<std::string> sha256_of_bytes(const std::filesystem::path& file, std::int64_t from,
                                                         std::int64_t to);

// Writes the chain while a session is recorded. One thread at a time. Members throw IoError.
class SessionHashes {
 public:
  explicit SessionHashes(const std::filesystem::path& session_folder);
  // Of a session that is finished already; nullopt where it has no chain, or a broken one: nothing can go on
  // there.
  [[nodiscard]] static std::optional<SessionHashes> of_finished(const std::filesystem::path& session_folder);

  // Writes a file by `write`, and its hash. A program or a machine that ends in between is known to have.
  void write_file(const std::string& name, const std::function<void()>& write);
  void cover_file(const std::string& name);
  // That a file is about to be written: until it is covered, what it holds is not known. Not yet on the disk.
  void announce_file(const std::string& name);
  // What was added since the last call; the first `head` bytes only once they are all there.
  void cover_growth(const std::string& name, std::int64_t head = 0);
  // The same of a file that is whole now, its head anew.
  void cover_to_end(const std::string& name, std::int64_t head = 0);
  // The rows before `end` that are not in it yet. They must be committed.
  void cover_rows(SessionDatabase& database, const std::string& of, std::int64_t end);
  // That event rows are about to be added to a session that is finished. On the disk before they are.
  void announce_events();
  // The database's bytes, sealed, where the chain has spoken of them before. On the disk.
  void cover_sealed_database();
  // That the session is finished, and all of it is in the chain. On the disk.
  void close();
  void sync() { chain_.sync(); }

 private:
  SessionHashes(const std::filesystem::path& session_folder, const ReadChain& read);
  void cover_bytes(const std::string& name, std::int64_t from, std::int64_t to);

  std::filesystem::path folder_;
  HashChain chain_;
  std::map<std::string, std::int64_t> covered_;  // how far, by what
};

}  // namespace arthronaut::recording
