#include "navigation/recording/case_sessions.h"

#include <algorithm>

#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

bool is_same_marker(const tools::WorldMarker* a, const tools::WorldMarker* b) {
  return a && b && a->marker_id == b->marker_id && a->size_mm == b->size_mm;
}

std::optional<KnownRegistration> registration_of(const std::filesystem::path& folder, bones::BoneKind bone,
                                                 const tools::ToolSet& tools) {
  if (!std::filesystem::exists(folder / "registration.json")) return std::nullopt;
  pipeline::PipelineOptions options;
  if (read_session_header(folder, options).bone != bone) return std::nullopt;
  const tools::ToolSet then = tools::read_tools_file(folder / "tools.json");
  if (!is_same_marker(then.find_world_marker(bone), tools.find_world_marker(bone))) return std::nullopt;
  const auto record = registration::read_registration_record(folder / "registration.json");
  KnownRegistration known{record.registration, record.of, folder};
  if (!known.registration.reliable) return std::nullopt;
  return known;
}

}  // namespace

std::optional<KnownRegistration> find_registration(const std::filesystem::path& case_folder,
                                                   bones::BoneKind bone, const tools::ToolSet& tools) {
  std::vector<std::filesystem::path> folders = cases::session_folders(case_folder);
  std::reverse(folders.begin(), folders.end());
  for (const std::filesystem::path& folder : folders) {
    try {
      if (auto known = registration_of(folder, bone, tools)) return known;
    } catch (const InvalidInput&) {
      // One broken session must not hide the others; opening it by itself says what is wrong.
    } catch (const IoError&) {
    }
  }
  return std::nullopt;
}

}  // namespace arthronaut::recording
