// The sessions of a case as a whole: what an earlier one found that a later one can use.
#pragma once

#include <filesystem>
#include <optional>

#include "navigation/registration/provenance.h"
#include "navigation/registration/registration.h"
#include "navigation/tools/tool_set.h"
#include "planning/bones/bone.h"

namespace arthronaut::recording {

struct KnownRegistration {
  registration::RegistrationSummary registration;
  std::optional<registration::Provenance> of;  // records of older versions do not say
  std::filesystem::path session_folder;
};

// The newest reliable registration that a session of the case found for this bone with this very world marker
// (id and size). Nobody can tell from files whether the marker has been moved since. Sessions that cannot be
// read are passed over.
[[nodiscard]] std::optional<KnownRegistration> find_registration(const std::filesystem::path& case_folder,
                                                                 bones::BoneKind bone,
                                                                 const tools::ToolSet& tools);

}  // namespace arthronaut::recording
