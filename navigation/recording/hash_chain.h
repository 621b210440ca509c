// Inner header: chain.csv of a session, the hashes of what was recorded, each bound to all before it.
//
//   record,from,to,sha256,chain,of
//
// A line says that of `of` what lies in [from, to) has this SHA-256; `of` is a file of the session's folder
// (bytes), or a part of its database (session_hashes.h). chain(n) = SHA-256 of chain(n - 1), 64 zeros before
// the first, a line feed, and "record,from,to,sha256,of". So no line can be changed, left out or put in
// without those after it being wrong. It holds no secret: who makes every line anew from some place on is
// found by the last `chain` alone, where somebody else has kept it.
//
// A line of the same `of` and `from` takes the place of the one before. to = -1: it is about to be written,
// and the line with its hash follows; where none does, the program ended in between.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace arthronaut::recording {

[[nodiscard]] std::filesystem::path chain_file(const std::filesystem::path& session_folder);

struct ChainRecord {
  std::int64_t number = 0;  // from 0
  std::int64_t from = 0, to = 0;
  std::string sha256, chain;
  std::string of;

  [[nodiscard]] bool is_open() const { return to < 0; }
};

struct ReadChain {
  std::vector<ChainRecord> records;  // as far as each follows from the one before
  std::string problem;               // where it breaks and how; empty where it does not
  // Beyond the break, each that follows from what the line before it says: with `records` they tell which
  // stretches are as recorded, but not that nothing was left out or put in.
  std::vector<ChainRecord> beyond_the_break;
  bool ends_in_half_a_line = false;  // the program ended while it wrote it
};
// Throws IoError when there is no chain, or it cannot be read.
[[nodiscard]] ReadChain read_chain(const std::filesystem::path& session_folder);

// Writes at the chain's end. One thread at a time. Members throw IoError.
class HashChain {
 public:
  // A new chain, in a session's folder that has none.
  explicit HashChain(const std::filesystem::path& session_folder);
  // Goes on after what was read, which ends with a whole line. Precondition: no problem was found.
  HashChain(const std::filesystem::path& session_folder, const ReadChain& read);
  ~HashChain();
  HashChain(HashChain&& other) noexcept;
  HashChain& operator=(HashChain&&) = delete;

  void append(const std::string& of, std::int64_t from, std::int64_t to, const std::string& sha256);
  // On the disk, whatever happens to the machine.
  void sync();

 private:
  void open(int flags);
  void write(const std::string& text);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t next_ = 0;
  std::string last_;
};

}  // namespace arthronaut::recording
