#include "navigation/recording/session_check.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_files.h"
#include "navigation/recording/session_hashes.h"
#include "planning/files/format.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

namespace fs = std::filesystem;

constexpr const char* kChanged = "not what was recorded";
constexpr const char* kMissing = "missing";
constexpr const char* kCutOff = "cut off: the lines that were written when the session was finished are gone";
constexpr const char* kAdded = "not in the chain: added later, or the chain's end is gone";

// What the chain says at last: a later record takes the place of an earlier one.
std::vector<const ChainRecord*> in_force(const ReadChain& chain) {
  std::map<std::pair<std::string, std::int64_t>, const ChainRecord*> last;
  for (const auto* const records : {&chain.records, &chain.beyond_the_break})
    for (const ChainRecord& record : *records) last[{record.of, record.from}] = &record;
  std::vector<const ChainRecord*> force;
  for (const auto& [place, record] : last) force.push_back(record);
  return force;
}

class Checker {
 public:
  Checker(const fs::path& folder, SessionCheck& check) : folder_(folder), check_(check) {
    try {
      database_.emplace(SessionDatabase::open(database_file(folder)));
      check_.was_finished = database_->prepare("SELECT finished FROM ending").step();
    } catch (const std::runtime_error& error) {
      lose_database(error);
    }
    try {
      says_it_has_a_chain_ = says_it_has_a_chain(folder);
    } catch (const std::runtime_error&) {
      // Such a session has none, or a broken one; with a chain, that the file was changed is a finding.
    }
  }

  // Of a session without chain.csv.
  void look_for_a_reason_without_chain() {
    if (says_it_has_a_chain_.value_or(false)) {
      add("chain.csv", 0, 0, kMissing);
    } else if (!says_it_has_a_chain_) {
      add("session.json", 0, 0, "not readable: nobody knows whether there were hashes");
    }
  }

  void look_at(const ChainRecord& record) {
    if (record.of == kChainEnd) {
      has_end_ = true;
      return;
    }
    const bool is_rows = is_of_rows(record.of);
    std::int64_t& end = ends_[record.of];
    end = std::max(end, record.to);
    if (record.of == kDatabaseFile && !record.is_open()) {
      database_bytes_ = &record;  // its rows first: they tell what was changed
    } else if (record.is_open()) {
      check_.notes.push_back(
          record.of == kDatabaseFile
              ? record.of +
                    ": its rows were looked at, its other bytes not: it was still open when the record ended"
              : record.of + ": was being written when the record ended: not looked at");
      open_.insert(record.of);
    } else if (is_rows) {
      look_at_rows(record);
    } else {
      look_at_bytes(record);
    }
  }

  // What a finished session holds beyond what its chain speaks of.
  void look_beyond() {
    if (!check_.was_finished) return look_at_database_bytes();
    for (const auto& [of, end] : ends_) {
      if (open_.contains(of)) continue;
      const std::int64_t there = is_of_rows(of) ? end : size_of(file_of(folder_, of));
      if (there > end) add(of, end, there, kAdded);
    }
    const char* const frames = ends_.contains(kFrameRowsOfBefore) ? kFrameRowsOfBefore : kFrameRows;
    for (const char* const rows : {frames, kEventRows, kPictureRows})
      if (database_ && !open_.contains(rows)) look_beyond_rows(rows);
    look_at_database_bytes();
    // Without its last lines the chain says nothing of a video that was copied at the session's end.
    if (!has_end_ && says_it_has_a_chain_.value_or(false)) add("chain.csv", 0, 0, kCutOff);
  }

  void look_at_database_bytes() {
    const auto is_of_database = [](const CheckFinding& finding) {
      return finding.of.starts_with(kDatabaseFile);
    };
    if (database_bytes_ && std::none_of(check_.findings.begin(), check_.findings.end(), is_of_database))
      look_at_bytes(*database_bytes_);
  }

 private:
  void look_at_rows(const ChainRecord& record) {
    if (!database_) return;
    try {
      if (sha256_of_rows(*database_, record.of, record.from, record.to) != record.sha256)
        add(record.of, record.from, record.to, kChanged);
    } catch (const std::runtime_error& error) {
      add(record.of, record.from, record.to, not_readable(error));
    }
  }

  void look_at_bytes(const ChainRecord& record) {
    const fs::path file = file_of(folder_, record.of);
    try {
      const auto hash = sha256_of_bytes(file, record.from, record.to);
      if (!hash)
        lose_bytes(record, size_of(file));
      else if (*hash != record.sha256)
        add(record.of, record.from, record.to, kChanged);
      else
        check_.covered_bytes += record.to - record.from;
    } catch (const IoError& error) {
      add(record.of, record.from, record.to, not_readable(error));
    }
  }

  // Of a file that is `size` long.
  void lose_bytes(const ChainRecord& record, std::int64_t size) {
    add(record.of, std::max(record.from, size), record.to, kMissing);
    if (size > record.from)
      check_.notes.push_back(files::format(
          "%s: bytes %lld to %lld: not looked at, their hash is also of the "
          "missing ones",
          record.of.c_str(), static_cast<long long>(record.from), static_cast<long long>(size - 1)));
  }

  void look_beyond_rows(const std::string& rows) {
    try {
      const std::int64_t there = rows_end(*database_, rows), end = ends_[rows];
      if (there > end) add(rows, end, there, kAdded);
    } catch (const std::runtime_error& error) {
      lose_database(error);
    }
  }

  void lose_database(const std::runtime_error& error) {
    database_.reset();
    check_.findings.push_back({"session.sqlite", 0, 0, not_readable(error)});
  }

  // Where the session lies is no finding: a folder may bear the patient's name.
  [[nodiscard]] std::string not_readable(const std::runtime_error& error) const {
    return "not readable: " + files::within_folder(folder_, error.what());
  }

  // Stretches that lie side by side and are wrong alike are one finding.
  void add(const std::string& of, std::int64_t from, std::int64_t to, const std::string& what) {
    auto& findings = check_.findings;
    if (!findings.empty() && findings.back().of == of && findings.back().to == from &&
        findings.back().what == what)
      findings.back().to = to;
    else
      findings.push_back({of, from, to, what});
  }

  const fs::path& folder_;
  SessionCheck& check_;
  std::optional<SessionDatabase> database_;
  std::map<std::string, std::int64_t> ends_;
  std::set<std::string> open_;
  const ChainRecord* database_bytes_ = nullptr;
  bool has_end_ = false;
  std::optional<bool> says_it_has_a_chain_;  // nullopt: session.json cannot be read
};

void say_what_is_outside(const fs::path& folder, SessionCheck& check) {
  try {
    pipeline::PipelineOptions options;
    const fs::path video = read_session_header(folder, options).video;
    if (video.is_absolute()) check.notes.push_back(video.string() + ": lies elsewhere: not looked at");
  } catch (const std::runtime_error&) {
    // session.json is a file of the chain: that it was changed is a finding.
  }
}

}  // namespace

std::string CheckFinding::text() const {
  const std::size_t colon = of.find(':');
  std::string words = colon == std::string::npos ? of + ": " : of.substr(0, colon) + ": ";
  if (from == 0 && to == 0) return words + "is " + what;
  // "session.sqlite:frames.2": frames.
  const std::string unit =
      colon == std::string::npos ? "bytes" : of.substr(colon + 1, of.find('.', colon) - colon - 1);
  return words + unit + " " + std::to_string(from) + " to " + std::to_string(to - 1) + " are " + what;
}

SessionCheck check_session(const fs::path& session_folder,
                           const std::function<void(std::int64_t, std::int64_t)>& progress,
                           const std::function<bool()>& stops) {
  if (!fs::is_directory(session_folder)) throw IoError(session_folder, "no such session");
  SessionCheck check;
  check.is_being_recorded = is_being_recorded(session_folder);
  Checker checker(session_folder, check);
  if (!fs::exists(chain_file(session_folder))) {
    check.findings.clear();  // a database alone that cannot be read says nothing of hashes
    checker.look_for_a_reason_without_chain();
    check.outcome = check.findings.empty() ? SessionCheck::Outcome::NoChain : SessionCheck::Outcome::Broken;
    return check;
  }
  const ReadChain chain = read_chain(session_folder);
  check.record_count = static_cast<std::int64_t>(chain.records.size());
  if (!chain.records.empty()) check.head = chain.records.back().chain;
  if (!chain.problem.empty()) check.findings.push_back({"chain.csv", 0, 0, "broken: " + chain.problem});
  if (chain.ends_in_half_a_line && check.was_finished)
    check.findings.push_back({"chain.csv", 0, 0, "cut off in the middle of a record"});
  const std::vector<const ChainRecord*> records = in_force(chain);
  std::int64_t done = 0;
  for (const ChainRecord* const record : records) {
    if (stops && stops()) {
      check.outcome = SessionCheck::Outcome::Stopped;
      return check;
    }
    checker.look_at(*record);
    if (progress) progress(++done, static_cast<std::int64_t>(records.size()));
  }
  if (chain.problem.empty()) {
    checker.look_beyond();
  } else {  // a line that is gone may have spoken of whatever no other speaks of
    checker.look_at_database_bytes();
    check.notes.push_back("what the broken place of chain.csv spoke of: not looked at");
  }
  say_what_is_outside(session_folder, check);
  check.outcome = check.findings.empty() ? SessionCheck::Outcome::Unbroken : SessionCheck::Outcome::Broken;
  return check;
}

std::string check_words(const SessionCheck& check) {
  using Outcome = SessionCheck::Outcome;
  switch (check.outcome) {
    case Outcome::NotRun:
    case Outcome::Stopped:
      return "not checked";
    case Outcome::NoChain:
      return "holds no hashes";
    case Outcome::Unbroken:
      return files::format(
          "as recorded: nothing that was hashed was changed or lost, %.1f MB of files, by %lld hashes%s",
          static_cast<double>(check.covered_bytes) / 1e6, static_cast<long long>(check.record_count),
          check.was_finished        ? ""
          : check.is_being_recorded ? "; being recorded, whole up to its last hash"
                                    : "; cut off, whole up to its last hash");
    case Outcome::Broken:
      return check.findings.front().text() +
             (check.findings.size() > 1 ? "; and " + std::to_string(check.findings.size() - 1) + " more"
                                        : "");
  }
  return "not checked";
}

std::string chain_head(const fs::path& session_folder) {
  if (!fs::exists(chain_file(session_folder))) return "";
  const ReadChain chain = read_chain(session_folder);
  return chain.records.empty() || !chain.problem.empty() ? "" : chain.records.back().chain;
}

}  // namespace arthronaut::recording
