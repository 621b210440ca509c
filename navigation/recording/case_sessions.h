// The sessions of a case as a whole: what an earlier one found that a later one can use.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "navigation/registration/provenance.h"
#include "navigation/registration/registration.h"
#include "navigation/tools/tool_set.h"
#include "planning/bones/bone.h"

namespace arthronaut::recording {

struct SessionHeader;

// The session is an exercise's: a simulation of sources::kExerciseSource. It is no operation: it is never
// resumed, and neither its registration nor its tunnel stands for anything.
[[nodiscard]] bool is_exercise(const SessionHeader& header);
// The same of a session's folder. False where its header cannot be read. Does not throw for that.
[[nodiscard]] bool is_exercise(const std::filesystem::path& session_folder);
// Whose pictures a case may hold, by the sources of its sessions, exercises among them.
enum class PicturedKnee { Patient, Nobody, Either };
[[nodiscard]] PicturedKnee pictured_knee(const std::filesystem::path& case_folder);
// The sessions of a case that are operations, oldest first: what is reported, trended or sent counts no
// other.
[[nodiscard]] std::vector<std::filesystem::path> operation_folders(const std::filesystem::path& case_folder);
// Why nothing may be practised in this case: the first of its sessions that is not of a simulation, as a
// sentence for the user. One whose kind is not known or cannot be read counts as real. Empty: there is none.
[[nodiscard]] std::string real_session(const std::filesystem::path& case_folder);

// What the newest session that says anything about a bone says.
struct KnownRegistration {
  registration::RegistrationSummary registration;
  std::optional<registration::Provenance> of;  // records of older versions do not say
  std::filesystem::path session_folder;
  // Why it must not be guided by: it was not reliable, or an alarm came after it. Empty when it may.
  std::string refusal;
  // Newer sessions that cannot be read, with the reason each: whoever uses the registration says so.
  std::vector<std::string> passed_over;

  [[nodiscard]] bool is_usable() const { return refusal.empty(); }
};

// The registration of the newest session (by its number, see cases::session_folders) that has one for this
// bone with this very world marker (id and size). That session decides: when its registration is not to be
// guided by, an older one is not taken in its place, since what made the newer one bad (a marker that was
// bumped, say) made the older one bad as well. Exercises are passed over. nullopt when no session has one.
// Nobody can tell from files whether the marker has been moved since.
[[nodiscard]] std::optional<KnownRegistration> find_registration(const std::filesystem::path& case_folder,
                                                                 bones::BoneKind bone,
                                                                 const tools::ToolSet& tools);

}  // namespace arthronaut::recording
