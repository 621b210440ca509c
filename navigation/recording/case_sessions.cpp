#include "navigation/recording/case_sessions.h"

#include <algorithm>

#include "navigation/recording/last_registration.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"
#include "navigation/sources/exercise_source.h"
#include "planning/cases/case.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

bool is_same_marker(const tools::WorldMarker* a, const tools::WorldMarker* b) {
  return a && b && a->marker_id == b->marker_id && a->size_mm == b->size_mm &&
         tools::are_same(a->markers, b->markers);
}

std::optional<KnownRegistration> registration_of(const std::filesystem::path& folder, bones::BoneKind bone,
                                                 const tools::ToolSet& tools) {
  if (!std::filesystem::exists(folder / "registration.json")) return std::nullopt;
  pipeline::PipelineOptions options;
  if (read_session_header(folder, options).bone != bone) return std::nullopt;
  const tools::ToolSet then = tools::read_tools_file(folder / "tools.json");
  if (!is_same_marker(then.find_world_marker(bone), tools.find_world_marker(bone))) return std::nullopt;
  const auto record = registration::read_registration_record(folder / "registration.json");
  KnownRegistration known{record.registration, record.of, folder, "", {}};
  // The newest is what would be guided by: one that is void, or none, is no reason to take the one before it.
  if (!known.registration.reliable) {
    known.refusal = doubt_of(known.registration);
  } else {
    const RecordedSession session(folder);
    LastRegistration last;
    last.follow(session);
    // A record that tells of none says nothing against the file beside it.
    if (std::ranges::any_of(session.events(), is_registration) || !last.alarm().empty())
      known.refusal = last.refusal();
  }
  return known;
}

// Empty where it cannot be read.
std::optional<SessionHeader> header_of(const std::filesystem::path& session_folder) {
  try {
    pipeline::PipelineOptions options;
    return read_session_header(session_folder, options);
  } catch (const InvalidInput&) {
  } catch (const IoError&) {
  }
  return std::nullopt;
}

}  // namespace

bool is_exercise(const SessionHeader& header) {
  return header.source_kind == sources::SourceKind::Simulation && header.source == sources::kExerciseSource;
}

bool is_exercise(const std::filesystem::path& session_folder) {
  const auto header = header_of(session_folder);
  return header && is_exercise(*header);  // without it nothing says that it is one
}

PicturedKnee pictured_knee(const std::filesystem::path& case_folder) {
  bool has_simulation = false, has_other = false;
  for (const std::filesystem::path& folder : cases::session_folders(case_folder)) {
    const auto header = header_of(folder);
    const bool is_simulation = header && header->source_kind == sources::SourceKind::Simulation;
    (is_simulation ? has_simulation : has_other) = true;
  }
  return !has_simulation ? PicturedKnee::Patient : has_other ? PicturedKnee::Either : PicturedKnee::Nobody;
}

std::vector<std::filesystem::path> operation_folders(const std::filesystem::path& case_folder) {
  std::vector<std::filesystem::path> folders = cases::session_folders(case_folder);
  std::erase_if(folders, [](const auto& folder) { return is_exercise(folder); });
  return folders;
}

std::string real_session(const std::filesystem::path& case_folder) {
  if (case_folder.empty()) return "";
  for (const std::filesystem::path& folder : cases::session_folders(case_folder)) {
    const std::string name = folder.filename().string();
    try {
      pipeline::PipelineOptions options;
      const auto kind = read_session_header(folder, options).source_kind;
      if (kind == sources::SourceKind::Simulation) continue;
      return "its session " + name +
             (!kind                                ? " may be of a patient"
              : *kind == sources::SourceKind::Live ? " is no simulation, but of a live camera"
                                                   : " is no simulation, but of a recording");
    } catch (const InvalidInput&) {
    } catch (const IoError&) {
    }
    return "its session " + name + " cannot be read, and may be of a patient";
  }
  return "";
}

std::optional<KnownRegistration> find_registration(const std::filesystem::path& case_folder,
                                                   bones::BoneKind bone, const tools::ToolSet& tools) {
  std::vector<std::filesystem::path> folders = operation_folders(case_folder);
  std::reverse(folders.begin(), folders.end());
  std::vector<std::string> passed_over;
  for (const std::filesystem::path& folder : folders) {
    // One broken session must not hide the others for good; that it was passed over is told.
    try {
      if (auto known = registration_of(folder, bone, tools)) {
        known->passed_over = std::move(passed_over);
        return known;
      }
    } catch (const InvalidInput& error) {
      passed_over.emplace_back(error.what());
    } catch (const IoError& error) {
      passed_over.emplace_back(error.what());
    }
  }
  return std::nullopt;
}

}  // namespace arthronaut::recording
