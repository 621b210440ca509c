// What a replay needs of a case.
#include "navigation/recording/replay.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/geometry/surface.h"

namespace arthronaut::recording {

ReplayOptions replay_options_of(const std::filesystem::path& case_folder, const RecordedSession& session,
                                const std::function<bool()>& stops) {
  ReplayOptions options;
  options.stops = stops;
  const auto is_stopped = [&] { return stops && stops(); };
  if (is_stopped()) return options;
  const cases::Case knee = cases::load_case(case_folder);
  const auto found = knee.bones.find(session.header().bone);
  if (found == knee.bones.end()) return options;
  if (is_of_another_surface(session.header(), bones::mesh_sha256(found->second.mesh))) {
    options.other_bone = "the case's " + std::string(bones::to_text(found->first)) +
                         " is not the mesh that this session was recorded with: nothing is registered again";
    return options;
  }
  if (is_stopped()) return options;
  options.bone = std::make_shared<const registration::SurfaceIndex>(
      found->second.mesh, cases::surface_index_file(case_folder, found->first));
  if (is_stopped()) return options;
  options.surface = std::make_shared<const geometry::Surface>(found->second.mesh);
  if (const auto cartilage = cases::load_cartilage(case_folder, found->first))
    options.cartilage.emplace().points_mm = cartilage->vertices_mm;
  return options;
}

}  // namespace arthronaut::recording
