#include "planning/library/case_record.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "planning/cases/case.h"
#include "planning/cases/case_note.h"
#include "planning/cases/case_outline.h"
#include "planning/files/achieved_shape.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::library {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<CaseState, std::string_view>, 6> kStates{{
    {CaseState::Missing, "missing"},
    {CaseState::Unreadable, "unreadable"},
    {CaseState::NotPlanned, "not planned"},
    {CaseState::Planned, "planned"},
    {CaseState::Navigated, "navigated"},
    {CaseState::Drilled, "drilled"},
}};
constexpr std::array<const char*, 4> kFiles{"case.json", "plan.json", "note.json", "achieved.json"};
// Another word when a record holds more than before: what an index kept of it is then read again.
constexpr std::string_view kHolds = "part problem";

// An open folder: what lies in it is looked at by the thousand, and by short names that costs half.
class OpenFolder {
 public:
  explicit OpenFolder(const char* name, int in = AT_FDCWD)
      : descriptor_(::openat(in, name, O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}
  ~OpenFolder() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFolder(const OpenFolder&) = delete;
  OpenFolder& operator=(const OpenFolder&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

// FNV-1a over what the status of files says.
class Fingerprint {
 public:
  // Whether the file is there.
  bool add(const OpenFolder& folder, const char* file) {
    struct stat status {};
    if (::fstatat(folder.descriptor(), file, &status, 0) != 0) {
      add_number(0);
      return false;
    }
    const std::int64_t written = status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
    newest_s_ = std::max<std::int64_t>(newest_s_, status.st_mtim.tv_sec);
    add_number(static_cast<std::uint64_t>(written));
    add_number(S_ISDIR(status.st_mode) ? 0 : static_cast<std::uint64_t>(status.st_size));
    return true;
  }
  void add_name(std::string_view name) {
    for (const char c : name) add_number(static_cast<unsigned char>(c));
  }
  // Never 0, which is no case's.
  [[nodiscard]] std::int64_t value() const {
    return static_cast<std::int64_t>(hash_ == 0 ? std::uint64_t{1} : hash_);
  }
  [[nodiscard]] std::int64_t newest_s() const { return newest_s_; }

 private:
  void add_number(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) {
      hash_ ^= (number >> shift) & 0xFFU;
      hash_ *= 1099511628211U;
    }
  }
  std::uint64_t hash_ = 14695981039346656037U;
  std::int64_t newest_s_ = 0;
};

std::vector<std::string> names_in(const OpenFolder& folder) {
  std::vector<std::string> names;
  const int own = ::fcntl(folder.descriptor(), F_DUPFD_CLOEXEC, 0);  // which closedir() closes
  DIR* directory = own >= 0 ? ::fdopendir(own) : nullptr;
  if (directory == nullptr) return names;
  while (const dirent* entry = ::readdir(directory))
    if (entry->d_name[0] != '.') names.emplace_back(entry->d_name);
  ::closedir(directory);
  std::sort(names.begin(), names.end());
  return names;
}

// Nothing where there is no case.
std::optional<Fingerprint> look_at(const fs::path& case_folder) {
  Fingerprint fingerprint;
  fingerprint.add_name(kHolds);
  const OpenFolder folder(case_folder.c_str());
  if (!folder.is_open()) return std::nullopt;
  for (const char* file : kFiles)
    if (!fingerprint.add(folder, file) && file == kFiles.front()) return std::nullopt;
  const OpenFolder sessions("sessions", folder.descriptor());
  if (!sessions.is_open()) return fingerprint;
  for (const std::string& name : names_in(sessions)) {
    // What is replaced in a session changes its folder; the record grows without.
    fingerprint.add_name(name);
    fingerprint.add(sessions, name.c_str());
    fingerprint.add(sessions, (name + "/session.sqlite").c_str());
    fingerprint.add(sessions, (name + "/session.sqlite-wal").c_str());
  }
  return fingerprint;
}

std::string utc_of(std::int64_t seconds) {
  const std::time_t time = seconds;
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::optional<double> optional_number(const files::JsonObject& node, std::string_view key) {
  return node.has(key) ? std::optional(node.number(key)) : std::nullopt;
}

// Why reading fails; empty: it does not.
std::string problem_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const InvalidInput& error) {
    return error.what();
  } catch (const IoError& error) {
    return error.what();
  } catch (const fs::filesystem_error& error) {
    return error.what();
  }
  return {};
}

std::vector<PostoperativeFacts> read_postoperative(const fs::path& case_folder) {
  std::vector<PostoperativeFacts> facts;
  const fs::path file = case_folder / "achieved.json";
  if (!fs::exists(file)) return facts;
  for (const auto& node : files::read_achieved(file, files::AchievedShape::OfComparison).objects("tunnels")) {
    facts.push_back({.tunnel = tunnels::read_key(node),
                     .entry_offset_mm = optional_number(node, "offset_mm"),
                     .angle_deg = optional_number(node, "angle_deg"),
                     .diameter_mm = optional_number(node, "diameter_mm"),
                     .is_reliable = node.boolean("reliable")});
    if (facts.back().is_reliable || !node.has("reliable_quantities")) continue;
    for (const std::string& name : node.texts("reliable_quantities"))
      if (const auto quantity = tunnels::quantity_from_text(name)) facts.back().known.insert(*quantity);
  }
  return facts;
}

}  // namespace

std::string word_of(const std::optional<bones::BoneKind>& bone) {
  return bone ? std::string(bones::to_text(*bone)) : std::string();
}

std::string word_of(const std::optional<bones::Side>& side) {
  return side ? std::string(bones::to_text(*side)) : std::string();
}

std::string_view to_text(CaseState state) {
  return std::find_if(kStates.begin(), kStates.end(), [&](const auto& one) { return one.first == state; })
      ->second;
}

CaseState case_state_from_text(std::string_view text) {
  for (const auto& [state, word] : kStates)
    if (word == text) return state;
  throw InvalidInput("\"" + std::string(text) + "\" is no state of a case");
}

std::string SessionFacts::outcome() const {
  if (is_drilled())
    return files::format("drilled, %.1f mm and %.1f\u00B0 from the plan", *entry_offset_mm,
                         angle_deg.value_or(0));
  if (!problem.empty()) return "cannot be read: " + problem;
  const std::string end = was_finished ? "" : is_being_recorded ? ", being recorded" : ", cut off";
  const std::string drilled = is_drilled_by_word ? ", drilled by word alone" : "";
  if (!registration_is_reliable) return "not registered" + drilled + end;
  if (!*registration_is_reliable) return "registration not reliable" + drilled + end;
  return "registered" + (is_drilled_by_word ? drilled : ", not drilled") + end;
}

std::string SessionFacts::what() const {
  constexpr double kShort_min = 1;
  std::string words, length;
  if (length_min)
    length = *length_min < kShort_min ? files::format("%.0f s", 60 * *length_min)
                                      : files::format("%.1f min", *length_min);
  for (const std::string& part : {is_exercise ? std::string("exercise") : source_kind, word_of(bone), length})
    if (!part.empty()) words += (words.empty() ? "" : ", ") + part;
  return words;
}

std::string SessionFacts::damage() const {
  return is_drilled() && !problem.empty() ? "cannot be read whole: " + problem : "";
}

std::vector<std::string> SessionFacts::doubts() const {
  std::vector<std::string> doubts;
  const bool was_registered = registration_is_reliable.has_value();
  if (is_drilled() && was_registered && !*registration_is_reliable)
    doubts.emplace_back("registration not reliable");
  if (is_drilled() && !was_registered && problem.empty()) doubts.emplace_back("not registered");
  if (was_registered && *registration_is_reliable && !was_verified) doubts.emplace_back("not verified");
  if (alarm_count > 0)
    doubts.push_back(std::to_string(alarm_count) + (alarm_count == 1 ? " alarm" : " alarms"));
  if (is_drilled() && !was_finished && problem.empty())
    doubts.emplace_back(is_being_recorded ? "being recorded" : "cut off");
  if (const std::string words = damage(); !words.empty()) doubts.push_back(words);
  return doubts;
}

bool SessionFacts::is_in_doubt() const {
  const bool was_cut_off = !was_finished && !is_being_recorded;
  return !problem.empty() || !doubts().empty() || !registration_is_reliable.value_or(true) ||
         is_drilled_by_word || was_cut_off;
}

CaseState CaseRecord::state() const {
  if (!is_there) return CaseState::Missing;
  if (!problem.empty()) return CaseState::Unreadable;
  const bool was_found = std::any_of(postoperative.begin(), postoperative.end(),
                                     [](const auto& found) { return found.entry_offset_mm.has_value(); });
  if (was_found ||
      std::any_of(sessions.begin(), sessions.end(), [](const auto& s) { return s.is_drilled(); }))
    return CaseState::Drilled;
  if (!sessions.empty()) return CaseState::Navigated;
  return planned.empty() ? CaseState::NotPlanned : CaseState::Planned;
}

std::string CaseRecord::plan_in_words() const {
  if (planned.empty()) return "no tunnel planned";
  std::string words;
  for (const bones::BoneKind kind : planned)
    words += (words.empty() ? "" : " and ") + std::string(bones::to_text(kind));
  words += " planned";
  for (const bones::BoneKind kind : bones)
    if (!planned.contains(kind)) words += ", " + std::string(bones::to_text(kind)) + " not";
  return words;
}

bool CaseRecord::is_simulated() const {
  const auto is_known = [](const SessionFacts& session) { return !session.source_kind.empty(); };
  return std::ranges::any_of(sessions, is_known) &&
         std::ranges::all_of(sessions, [&](const SessionFacts& session) {
           return !is_known(session) || session.is_simulated();
         });
}

std::string CaseRecord::last_outcome() const {
  if (!is_there) return "its folder is not there now";
  if (!problem.empty()) return "cannot be read: " + problem;
  return last_session() != nullptr ? files::within_folder(folder, last_session()->outcome()) : std::string();
}

CaseRecord read_case_record(const fs::path& case_folder, const SessionReader& read_session) {
  CaseRecord record;
  record.folder = case_folder;
  const auto looked = look_at(case_folder);
  record.is_there = looked.has_value();
  if (!looked) return record;
  record.changed_utc = utc_of(looked->newest_s());
  // Another user's or a broken case is one line of the list, not the end of it; a broken part of it no more
  // than that part.
  record.problem = problem_of([&] {
    const cases::CaseOutline outline = cases::read_case_outline(case_folder);
    record.name = outline.name;
    record.side = outline.side;
    record.created_utc = outline.created_utc;
    record.bones = outline.bones;
    record.planned = outline.planned;
  });
  const auto read_part = [&](const auto& read) {
    if (const std::string problem = problem_of(read); !problem.empty())
      record.part_problem += (record.part_problem.empty() ? "" : "; ") + problem;
  };
  if (record.problem.empty()) {
    read_part([&] { record.note = cases::load_note(case_folder).text; });
    read_part([&] { record.postoperative = read_postoperative(case_folder); });
    read_part([&] {
      for (const fs::path& session : cases::session_folders(case_folder)) {
        SessionFacts facts = read_session(session);
        if (!facts.is_exercise) record.sessions.push_back(std::move(facts));
      }
    });
  }
  if (record.name.empty()) record.name = case_folder.stem().string();
  return record;
}

std::int64_t fingerprint_of(const fs::path& case_folder) {
  const auto looked = look_at(case_folder);
  return looked ? looked->value() : 0;
}

}  // namespace arthronaut::library
