// What the library knows of a case: everything in it is read from the case's folder, and can be read again.
//
// It names the case, never the patient: identity.json is not read here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/tunnels/tunnel.h"
#include "planning/tunnels/tunnel_quantity.h"

namespace arthronaut::library {

// "femur", "left"; empty where it is not known.
[[nodiscard]] std::string word_of(const std::optional<bones::BoneKind>& bone);
[[nodiscard]] std::string word_of(const std::optional<bones::Side>& side);

// One session of a case. What is not recorded stays empty.
struct SessionFacts {
  std::string id, started_utc;
  std::optional<bones::BoneKind> bone;
  std::optional<bones::Side> side;  // as which it was recorded; not in the library's index
  std::string source_kind;          // "live", "recording", "simulation"; empty in older records
  bool is_exercise = false;         // training: no operation, and in no CaseRecord
  bool was_finished = false;
  bool is_being_recorded = false;                // when it was looked at: not cut off
  std::optional<bool> registration_is_reliable;  // of the last registration
  std::optional<double> registration_rms_mm;
  std::optional<double> predicted_error_mm;  // of that registration: one sigma at its target
  bool was_verified = false;                 // by touches, after the last registration
  int alarm_count = 0;
  std::optional<double> length_min;  // from the first frame to the last
  // The tunnel as navigation measured it, against the plan: between the entries, between the axes.
  std::optional<double> entry_offset_mm, angle_deg, depth_mm;
  bool is_drilled_by_word = false;  // of a tunnel at least: said to be, and no pose shows where it runs
  // Minutes from the first frame to the first registration, from there to the first time it was verified or
  // confirmed, and from there to the drilled tunnel.
  std::optional<double> registering_min, verifying_min, drilling_min;
  std::string problem;  // why it, or a part of it, cannot be read; empty when it can

  [[nodiscard]] bool is_simulated() const { return source_kind == "simulation"; }
  [[nodiscard]] bool is_drilled() const { return entry_offset_mm.has_value(); }
  // "drilled, 1.2 mm and 0.8° from the plan", "registered, drilled by word alone", "not registered, cut off"
  [[nodiscard]] std::string outcome() const;
  // "simulation, femur, 5.2 min"; what is not known is left out.
  [[nodiscard]] std::string what() const;
  // What whoever reads the outcome should know beside it: "not verified", "2 alarms", "cut off", ...
  [[nodiscard]] std::vector<std::string> doubts() const;
  // One of them: "cannot be read whole: ...". Empty: nothing is, or the outcome says it.
  [[nodiscard]] std::string damage() const;
  // A doubt, or an outcome that is one: no registration to rely on, cut off, cannot be read.
  [[nodiscard]] bool is_in_doubt() const;
};
// Reads one session's folder. Does not throw for what it finds there: see SessionFacts::problem.
using SessionReader = std::function<SessionFacts(const std::filesystem::path& session_folder)>;

// What `compare` found in a post-operative CT of this case, where achieved.json was written into its folder.
struct PostoperativeFacts {
  tunnels::TunnelKey tunnel = bones::BoneKind::Femur;
  std::optional<double> entry_offset_mm, angle_deg, diameter_mm;  // empty: no tunnel was found
  bool is_reliable = false;                                       // all of it
  tunnels::Quantities known = {};  // what may be relied on all the same, where not all of it may

  [[nodiscard]] bool is_known(tunnels::Quantity quantity) const {
    return is_reliable || known.contains(quantity);
  }
};

enum class CaseState {
  Missing,     // its folder is not there now: moved, deleted, or on a drive that is not plugged in
  Unreadable,  // its case.json or plan.json is broken, newer, or not to be read by this user
  NotPlanned,
  Planned,    // a tunnel at least
  Navigated,  // a session at least, that is no exercise
  Drilled,    // a session with a drilled tunnel, or one found in a post-operative CT
};
[[nodiscard]] std::string_view to_text(CaseState state);  // "missing", "unreadable", "not planned", ...
// Throws InvalidInput for any other word.
[[nodiscard]] CaseState case_state_from_text(std::string_view text);

struct CaseRecord {
  std::filesystem::path folder;  // absolute
  bool is_there = true;          // false: the rest is what was known when it was there last
  std::string problem;           // why it cannot be read; empty when it can
  // Why something beside case and plan cannot be read: note, comparison, list of sessions; the rest is told.
  // Empty: all of it can.
  std::string part_problem;
  std::string name;
  std::optional<bones::Side> side;
  std::string created_utc;  // ISO 8601
  std::string changed_utc;  // when case, plan, note or a session was written last
  std::set<bones::BoneKind> bones, planned;
  std::string note;
  std::vector<SessionFacts> sessions;  // operations alone, oldest first: exercises count nowhere
  std::vector<PostoperativeFacts> postoperative;

  [[nodiscard]] CaseState state() const;
  // Whether every bone of the case has a tunnel.
  [[nodiscard]] bool is_planned_whole() const { return !planned.empty() && planned == bones; }
  // "femur and tibia planned", "femur planned, tibia not", "no tunnel planned", ...
  [[nodiscard]] std::string plan_in_words() const;
  // Null without a session.
  [[nodiscard]] const SessionFacts* last_session() const {
    return sessions.empty() ? nullptr : &sessions.back();
  }
  // A rehearsal: there are sessions, and all of which anything is known were simulated.
  [[nodiscard]] bool is_simulated() const;
  // Of what the last session came to; of what is wrong with the case; empty without either.
  [[nodiscard]] std::string last_outcome() const;
};

// Does not throw for what it finds: is_there, problem and part_problem say it.
[[nodiscard]] CaseRecord read_case_record(const std::filesystem::path& case_folder,
                                          const SessionReader& read_session);

// Changes when anything changes that read_case_record() reads; 0 where there is no case. Looks at names,
// sizes and times alone: some 20 microseconds a case.
[[nodiscard]] std::int64_t fingerprint_of(const std::filesystem::path& case_folder);

}  // namespace arthronaut::library
