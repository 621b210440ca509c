#include "planning/plan_export/plan_export.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "planning/bones/mesh_file.h"
#include "planning/cases/plan_file.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/files/sha256.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/plan_export/drilled_bone.h"
#include "planning/plan_export/markups_file.h"

namespace arthronaut::plan_export {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kColumns =
    "bone,entry_x_mm,entry_y_mm,entry_z_mm,direction_x,direction_y,direction_z,diameter_mm,"
    "exit_x_mm,exit_y_mm,exit_z_mm,length_mm,wall_mm,bundle";  // as every export had them

std::array<fs::path, 2> drilled_files(const fs::path& folder, bones::BoneKind kind) {
  const std::string name = std::string(bones::to_text(kind)) + "_drilled";
  return {folder / (name + ".stl"), folder / (name + ".ply")};
}

// As far as a file rounds them.
bool are_the_same(const std::map<tunnels::TunnelKey, tunnels::Tunnel>& a,
                  const std::map<tunnels::TunnelKey, tunnels::Tunnel>& b) {
  constexpr double kRounding_mm = 1e-3, kRounding = 1e-5;
  return a.size() == b.size() && std::ranges::all_of(a, [&](const auto& planned) {
           const auto other = b.find(planned.first);
           if (other == b.end()) return false;
           const tunnels::Tunnel &one = planned.second, &two = other->second;
           return (one.entry_mm - two.entry_mm).norm() < kRounding_mm &&
                  (one.direction - two.direction).norm() < kRounding &&
                  std::abs(one.diameter_mm - two.diameter_mm) < kRounding_mm;
         });
}

constexpr const char* kSums = "SHA256SUMS";

std::vector<fs::path> exported_files(const fs::path& folder) {
  std::vector<fs::path> files{folder / "plan.json", folder / "plan.csv", folder / "plan.mrk.json"};
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
    for (const fs::path& file : drilled_files(folder, kind)) files.push_back(file);
  std::erase_if(files, [](const fs::path& file) { return !fs::exists(file); });
  return files;
}

// A line of SHA256SUMS, as sha256sum writes it.
std::string sum_of(const fs::path& file) {
  return files::sha256_of_file(file) + "  " + file.filename().string() + "\n";
}

}  // namespace

std::string plan_csv(const cases::Case& knee) {
  const std::string of_plan = "," + std::string(bones::to_text(knee.side)) + "," +
                              cases::plan_sha256(cases::with_named_meshes(knee)) + "\n";
  std::string text = std::string(kColumns) + ",side,plan_sha256\n";
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
    text += "," + std::string(norms::to_text(key.bundle)) + of_plan;
  }
  return text;
}

void refuse_foreign(const fs::path& folder) {
  const fs::path plan_file = folder / "plan.json", csv = folder / "plan.csv",
                 markups = folder / "plan.mrk.json";
  if (const fs::path sums = folder / kSums; fs::exists(sums)) {
    const std::string known = files::read_text(sums);
    for (const fs::path& file : exported_files(folder))
      if (known.find(sum_of(file)) == std::string::npos)
        throw InvalidInput(file, "",
                           "was changed since it was exported: move it away, or export into another folder");
  }
  cases::Plan plan;
  if (fs::exists(plan_file)) plan = cases::plan_from(files::read_text(plan_file), plan_file);
  if (fs::exists(csv) && !files::read_text(csv).starts_with(kColumns))
    throw InvalidInput(csv, "", "is another program's: export into another folder");
  if (fs::exists(markups) && !are_the_same(read_markups(markups).tunnels, plan.tunnels))
    throw InvalidInput(markups, "",
                       "was changed by another program since it was exported: read it back, or move it away");
}

ExportSummary export_plan(const cases::Case& knee, const fs::path& folder, const std::stop_token& stop) {
  if (knee.plan.tunnels.empty())
    throw InvalidInput("plan: nothing is planned, so there is nothing to export");
  files::refuse_unwritable(folder);  // before seconds of drilling
  refuse_foreign(folder);
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
    auto result = drill(bone->second.mesh, tunnels, stop);
    if (result.is_usable()) {
      drilled[kind] = std::move(result.mesh);
    } else {
      summary.doubts.push_back("the " + name + " could not be drilled: " + result.reason);
    }
  }
  const std::string csv = plan_csv(knee), markups = markups_of(knee), of_plan = cases::plan_in_words(knee);
  const cases::Plan plan = cases::with_named_meshes(knee);
  nlohmann::ordered_json plan_json = cases::to_json(plan);
  plan_json["side"] = bones::to_text(knee.side);
  plan_json["plan_sha256"] = cases::plan_sha256(plan);
  if (stop.stop_requested()) return {.files = {}, .doubts = {}, .was_stopped = true};
  // What an earlier plan left drilled would pass for this one's.
  std::vector<fs::path> gone;
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
    if (!drilled.contains(kind))
      for (const fs::path& file : drilled_files(folder, kind)) gone.push_back(file.filename());
  files::fill_folder(
      folder,
      [&](const fs::path& unfinished) {
        files::write_json(unfinished / "plan.json", plan_json);
        files::write_atomically(unfinished / "plan.csv", csv);
        files::write_atomically(unfinished / "plan.mrk.json", markups);
        for (const auto& [kind, mesh] : drilled) {
          const auto [stl, ply] = drilled_files(unfinished, kind);
          bones::write_mesh_stl(stl, mesh, of_plan);
          bones::write_mesh_ply(ply, mesh, of_plan);
        }
        std::string sums = "# " + of_plan + "\n";  // passed over by sha256sum -c
        for (const fs::path& file : exported_files(unfinished)) sums += sum_of(file);
        files::write_atomically(unfinished / kSums, sums);
      },
      gone);
  summary.files = {folder / "plan.json", folder / "plan.csv", folder / "plan.mrk.json"};
  for (const auto& [kind, mesh] : drilled) {
    const auto [stl, ply] = drilled_files(folder, kind);
    summary.files.insert(summary.files.end(), {stl, ply});
  }
  summary.files.push_back(folder / kSums);
  return summary;
}

}  // namespace arthronaut::plan_export
