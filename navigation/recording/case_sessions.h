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
// bumped, say) made the older one bad as well. nullopt when no session has one. Nobody can tell from files
// whether the marker has been moved since.
[[nodiscard]] std::optional<KnownRegistration> find_registration(const std::filesystem::path& case_folder,
                                                                 bones::BoneKind bone,
                                                                 const tools::ToolSet& tools);

}  // namespace arthronaut::recording
