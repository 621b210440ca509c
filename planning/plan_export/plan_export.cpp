#include "planning/plan_export/plan_export.h"

#include <cerrno>
#include <cstring>
#include <map>
#include <system_error>

#include "planning/bones/mesh_file.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/remove_file.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/plan_export/drilled_bone.h"
#include "planning/plan_export/markups_file.h"

namespace arthronaut::plan_export {

namespace fs = std::filesystem;

namespace {

fs::path drilled_file(const fs::path& folder, bones::BoneKind kind) {
  return folder / (std::string(bones::to_text(kind)) + "_drilled.stl");
}

}  // namespace

std::string plan_csv(const cases::Case& knee) {
  std::string text =
      "bone,entry_x_mm,entry_y_mm,entry_z_mm,direction_x,direction_y,direction_z,diameter_mm,"
      "exit_x_mm,exit_y_mm,exit_z_mm,length_mm,wall_mm,bundle\n";
  for (const auto& [key, tunnel] : knee.plan.tunnels) {
    const auto& e = tunnel.entry_mm;
    const auto& d = tunnel.direction;
    text +=
        files::format("%s,%.4f,%.4f,%.4f,%.7f,%.7f,%.7f,%.3f", std::string(bones::to_text(key.bone)).c_str(),
                      e.x(), e.y(), e.z(), d.x(), d.y(), d.z(), tunnel.diameter_mm);
    const auto bone = knee.bones.find(key.bone);
    const auto measured = bone == knee.bones.end()
                              ? tunnels::TunnelGeometry{}
                              : tunnels::measure(tunnel, geometry::Surface(bone->second.mesh));
    if (measured.enters_bone) {
      const auto& x = measured.exit_mm;
      text += files::format(",%.4f,%.4f,%.4f,%.3f,%.3f", x.x(), x.y(), x.z(), measured.length_mm,
                            measured.wall_mm);
    } else {
      text += ",,,,,";
    }
    text += "," + std::string(norms::to_text(key.bundle)) + "\n";
  }
  return text;
}

ExportSummary export_plan(const cases::Case& knee, const fs::path& folder) {
  if (knee.plan.tunnels.empty())
    throw InvalidInput("plan: nothing is planned, so there is nothing to export");
  files::refuse_unwritable(folder);  // drilling takes half a minute
  ExportSummary summary;
  std::map<bones::BoneKind, geometry::TriangleMesh> drilled;
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const auto keys = knee.plan.of(kind);
    if (keys.empty()) continue;
    const std::string name(bones::to_text(kind));
    const auto bone = knee.bones.find(kind);
    if (bone == knee.bones.end()) {
      summary.doubts.push_back("the case lacks the " + name + " that is planned on");
      continue;
    }
    std::vector<tunnels::Tunnel> tunnels;
    for (const tunnels::TunnelKey& key : keys) {
      tunnels.push_back(knee.plan.tunnels.at(key));
      if (const auto fit = cases::plan_fit(knee, key); !fit.is_valid()) summary.doubts.push_back(fit.reason);
    }
    auto result = drill(bone->second.mesh, tunnels);
    if (result.is_usable()) {
      drilled[kind] = std::move(result.mesh);
    } else {
      summary.doubts.push_back("the " + name + " could not be drilled: " + result.reason);
    }
  }
  const std::string csv = plan_csv(knee), markups = markups_of(knee);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) throw IoError(folder, "cannot make the folder: " + error.message());
  // What an earlier plan left drilled would pass for this one's.
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
    if (!drilled.contains(kind)) files::remove_file(drilled_file(folder, kind));
  cases::save_plan(folder, knee.plan);
  files::write_atomically(folder / "plan.csv", csv);
  files::write_atomically(folder / "plan.mrk.json", markups);
  summary.files = {folder / "plan.json", folder / "plan.csv", folder / "plan.mrk.json"};
  for (const auto& [kind, mesh] : drilled) {
    summary.files.push_back(drilled_file(folder, kind));
    bones::write_mesh_stl(summary.files.back(), mesh);
  }
  return summary;
}

}  // namespace arthronaut::plan_export
