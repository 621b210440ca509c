// 3D Slicer's markups (`.mrk.json`, schema 1.0.3): the plan in the form in which other programs draw and move
// it.
//
// A tunnel is a line of two control points, "femur tunnel", "femur AM tunnel" or "femur PL tunnel", from
// "entry" to "exit"; its diameter stands in the description, with the side and the plan that it was written
// of. Landmarks are a point list, "femur landmarks". Written in LPS and mm; read in LPS or RAS, as the file
// says.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/cases/case.h"
#include "planning/cases/plan_versions.h"
#include "planning/geometry/surface.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::plan_export {

// The text of a markups file with every tunnel of the plan on a bone of the case, and the bones' landmarks.
[[nodiscard]] std::string markups_of(const cases::Case& knee);

struct MarkupsPlan {
  std::map<tunnels::TunnelKey, tunnels::Tunnel> tunnels;
  std::set<tunnels::TunnelKey> without_diameter;  // of them, of which the file does not say it
};
// Reads the tunnels that markups_of wrote, also after 3D Slicer moved them: lines by their names; all else is
// passed over, the landmarks too. A diameter that is not said is what is usual of the bundle. Throws IoError
// or InvalidInput (file, place, reason): no markups, a unit other than mm, a line without two points or
// without length, a point that was taken away or not placed yet ("positionStatus"), a position that is not
// finite, a diameter that cannot be planned (tunnels/diameter_range.h), a tunnel that is there twice, a
// bone's single tunnel beside one of a bundle.
[[nodiscard]] MarkupsPlan read_markups(const std::filesystem::path& file);

struct TakenTunnels {
  std::map<tunnels::TunnelKey, tunnels::Tunnel> tunnels;
  std::string note;  // which diameters are not of the file; empty where all are
};
// The tunnels of such a file that are of bones that there are; `surface_of` is null for others. One whose
// diameter the file does not say has that of the same tunnel in `plan`, else what is usual. Throws as
// read_markups, and InvalidInput where there is none of them, or one does not enter its bone.
[[nodiscard]] TakenTunnels read_tunnels(
    const std::filesystem::path& file, const cases::Plan& plan,
    const std::function<const geometry::Surface*(bones::BoneKind)>& surface_of);

// What a file that says of which knee and plan it was written says against this case: throws InvalidInput
// where it was the other knee; words where it was another plan than the case's of now and every one of
// `kept`. Empty where nothing is against it, as where descriptions were emptied.
[[nodiscard]] std::string origin_doubt(const std::filesystem::path& file, const cases::Case& knee,
                                       const std::vector<cases::PlanVersion>& kept);

}  // namespace arthronaut::plan_export
