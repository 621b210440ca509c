#include "navigation/recording/hash_chain.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "planning/files/atomic_file.h"
#include "planning/files/private_folder.h"
#include "planning/files/sha256.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::string_view kColumns = "record,from,to,sha256,chain,of\n";
constexpr std::size_t kHashDigits = 64;
constexpr std::int64_t kMostRecords = 1'000'000'000'000;

std::string link_of(const std::string& before, const ChainRecord& record) {
  return files::sha256_of(before + "\n" + std::to_string(record.number) + "," + std::to_string(record.from) +
                          "," + std::to_string(record.to) + "," + record.sha256 + "," + record.of);
}

bool take_number(std::string_view& line, std::int64_t& value) {
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc() || end == line.data() + line.size() || *end != ',') return false;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()) + 1);
  return true;
}

bool take_hash(std::string_view& line, std::string& hash) {
  if (line.size() <= kHashDigits || line[kHashDigits] != ',') return false;
  hash = line.substr(0, kHashDigits);
  line.remove_prefix(kHashDigits + 1);
  return hash.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::optional<ChainRecord> parsed(std::string_view line) {
  ChainRecord record;
  if (!take_number(line, record.number) || !take_number(line, record.from) || !take_number(line, record.to) ||
      !take_hash(line, record.sha256) || !take_hash(line, record.chain) || line.empty())
    return std::nullopt;
  record.of = line;
  return record;
}

}  // namespace

std::filesystem::path chain_file(const std::filesystem::path& session_folder) {
  return session_folder / "chain.csv";
}

ReadChain read_chain(const std::filesystem::path& session_folder) {
  const std::string text = files::read_text(chain_file(session_folder));
  ReadChain read;
  if (!text.starts_with(kColumns)) {
    read.problem = "line 1: is not the heading of a chain of hashes";
    return read;
  }
  std::string last(kHashDigits, '0');
  std::size_t at = kColumns.size();
  for (std::int64_t number = 0; at < text.size(); ++number) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) {
      read.ends_in_half_a_line = true;
      break;
    }
    const std::string line = "line " + std::to_string(number + 2) + ": ";
    std::optional<ChainRecord> record = parsed(std::string_view(text).substr(at, end - at));
    at = end + 1;
    if (!record) {
      if (read.problem.empty()) read.problem = line + "is not a record of the chain";
      last.clear();
      continue;
    }
    const bool follows = record->number == number && record->chain == link_of(last, *record);
    if (!follows && read.problem.empty())
      read.problem = line + "does not follow from the one before: it, or one before it, was changed";
    last = record->chain;
    number = std::min(record->number, kMostRecords);  // where lines are missing
    if (follows) (read.problem.empty() ? read.records : read.beyond_the_break).push_back(std::move(*record));
  }
  return read;
}

HashChain::HashChain(const std::filesystem::path& session_folder)
    : file_(chain_file(session_folder)), last_(kHashDigits, '0') {
  files::begin_private_file(file_);
  open(O_TRUNC);
  write(std::string(kColumns));
}

HashChain::HashChain(const std::filesystem::path& session_folder, const ReadChain& read)
    : file_(chain_file(session_folder)),
      next_(static_cast<std::int64_t>(read.records.size())),
      last_(read.records.empty() ? std::string(kHashDigits, '0') : read.records.back().chain) {
  open(0);
}

HashChain::~HashChain() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

HashChain::HashChain(HashChain&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      next_(other.next_),
      last_(std::move(other.last_)) {}

void HashChain::open(int flags) {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | flags, 0666);
  if (descriptor_ < 0) throw IoError(file_, std::string("cannot write: ") + std::strerror(errno));
}

void HashChain::write(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw IoError(file_, std::string("cannot write: ") + std::strerror(errno));
    done += static_cast<std::size_t>(written);
  }
}

void HashChain::append(const std::string& of, std::int64_t from, std::int64_t to, const std::string& sha256) {
  ChainRecord record{next_, from, to, sha256, {}, of};
  record.chain = link_of(last_, record);
  write(std::to_string(record.number) + "," + std::to_string(from) + "," + std::to_string(to) + "," + sha256 +
        "," + record.chain + "," + of + "\n");
  last_ = std::move(record.chain);
  ++next_;
}

void HashChain::sync() {
  if (::fdatasync(descriptor_) != 0)
    throw IoError(file_, std::string("cannot write: ") + std::strerror(errno));
}

}  // namespace arthronaut::recording
