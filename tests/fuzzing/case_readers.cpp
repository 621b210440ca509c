#include <cmath>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/cases/case_sides.h"
#include "planning/cases/identity.h"
#include "planning/cases/measurements.h"
#include "planning/cases/plan_file.h"
#include "planning/cases/step_history.h"
#include "planning/cases/study.h"
#include "planning/plan_export/markups_file.h"
#include "tests/fuzzing/reader.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::fuzzing {
namespace {

namespace fs = std::filesystem;
using bones::BoneKind;

cases::Case example() {
  return {
      .name = "Knee",
      .side = bones::Side::Left,
      .created_utc = "2026-01-31T12:00:00Z",
      .bones = {{BoneKind::Femur,
                 {.kind = BoneKind::Femur, .mesh = test::box({40, 30, 50}), .source = "femur.stl"}}},
      .landmarks = {{BoneKind::Femur, {{"native_footprint", {40, 0.1, -1.0 / 3}}}}},
      .images = {{.file = "images/1.nrrd", .modality = "CT", .size = {4, 5, 6}, .spacing_mm = {1, 1, 2}}}};
}

constexpr std::string_view kPlan = R"({"format": "arthronaut.plan", "version": 1, "tunnels": [
  {"bone": "femur", "entry_mm": [40, 0.001, 0.1], "direction": [-0.6, 0, 0.8], "diameter_mm": 8.5},
  {"bone": "tibia", "entry_mm": [1, 2, 3], "direction": [0, 0, -1], "diameter_mm": 9, "mesh_sha256": "ab"}]})";

constexpr std::string_view kMarkups = R"({"markups": [
  {"type": "Line", "name": "femur tunnel", "description": "8.5 mm", "coordinateSystem": "LPS", "coordinateUnits": "mm",
   "controlPoints": [{"id": "1", "label": "entry", "position": [40, 0.1, 0]}, {"id": "2", "label": "exit", "position": [10, 0, 40]}]},
  {"type": "Fiducial", "name": "femur landmarks", "coordinateSystem": "RAS", "coordinateUnits": "mm",
   "controlPoints": [{"id": "1", "label": "notch_apex", "position": [1, 2, 3]}]}]})";

std::string taken_of(const cases::Plan& plan) {
  for (const auto& [bone, tunnel] : plan.tunnels) {
    if (!tunnel.entry_mm.allFinite() || !tunnel.direction.allFinite()) return "a tunnel that is not finite";
    if (!(tunnel.diameter_mm > 0)) return "a tunnel without diameter";
  }
  return "";
}

// The mesh of the case stays; what names it is what is broken.
std::string read_case(const fs::path& folder, std::string_view bytes) {
  if (!fs::exists(folder / "case.json")) cases::save_case(folder, example());
  (void)put(folder, "case.json", bytes);
  return taken_of(cases::load_case(folder).plan);
}

}  // namespace

std::vector<Reader> case_readers() {
  const auto text = [](std::string_view seed) {
    return [seed](const fs::path&) {
      return std::map<std::string, std::string>{{"seed", std::string(seed)}};
    };
  };
  return {{"case", "case.json",
           [](const fs::path& folder) {
             cases::save_case(folder, example());
             return std::map<std::string, std::string>{{"case.json", taken(folder / "case.json")}};
           },
           read_case},
          {"plan", "plan.json", text(kPlan),
           [](const fs::path&, std::string_view bytes) {
             return taken_of(cases::plan_from(std::string(bytes), "plan.json"));
           }},
          {"markups", "input.mrk.json", text(kMarkups),
           [](const fs::path& folder, std::string_view bytes) {
             const auto plan = plan_export::read_markups(put(folder, "input.mrk.json", bytes));
             for (const auto& [key, tunnel] : plan.tunnels)
               if (!tunnel.entry_mm.allFinite() || !(std::abs(tunnel.direction.norm() - 1) < 1e-9))
                 return std::string("a tunnel without a place or a direction");
             return std::string();
           }},
          {"measurements", "measurements.json",
           [](const fs::path& folder) {
             cases::save_measurements(folder, {cases::Measurement{{{1, 2, 3}, {1, 5, 7}}},
                                               cases::Measurement{{{3, 0, 0}, {0, 0, 0}, {0, 4, 0}}}});
             return std::map<std::string, std::string>{{"seed", taken(cases::measurements_file(folder))}};
           },
           [](const fs::path& folder, std::string_view bytes) {
             (void)put(folder, "measurements.json", bytes);
             for (const auto& each : cases::load_measurements(folder)) (void)each.in_words();
             return std::string();
           }},
          {"bone_doubts", "bone_doubts.json",
           [](const fs::path& folder) {
             cases::save_bone_doubts(folder, {{BoneKind::Femur, {"cut off", cases::SideDoubt{}}}});
             return std::map<std::string, std::string>{{"seed", taken(cases::bone_doubts_file(folder))}};
           },
           [](const fs::path& folder, std::string_view bytes) {
             (void)put(folder, "bone_doubts.json", bytes);
             (void)cases::load_bone_doubts(folder);
             return std::string();
           }},
          {"history", "history.json",
           [](const fs::path& folder) {
             const cases::Case knee = example();
             cases::PlanState before{{}, {}, knee.landmarks, {}}, after = before;
             after.plan = cases::plan_from(std::string(kPlan), "plan.json");
             cases::save_step_history(folder, {{{"Plan", before, after}}, 1});
             return std::map<std::string, std::string>{{"seed", taken(cases::step_history_file(folder))}};
           },
           [](const fs::path& folder, std::string_view bytes) {
             (void)put(folder, "history.json", bytes);
             const auto history = cases::load_step_history(folder);
             return history.position <= history.steps.size() ? std::string()
                                                             : std::string("beyond the steps");
           }},
          {"sides", "sides.json",
           [](const fs::path& folder) {
             cases::save_case(folder, example());
             cases::change_side(folder, bones::Side::Right, {});
             return std::map<std::string, std::string>{{"seed", taken(cases::sides_file(folder))}};
           },
           [](const fs::path& folder, std::string_view bytes) {
             (void)put(folder, "sides.json", bytes);
             (void)cases::load_side(folder, {}, bones::Side::Left);
             return std::string();
           }},
          {"identity", "identity.json",
           [](const fs::path& folder) {
             cases::save_identity(folder, {"Muster^Anna", "4711", "19900131"});
             return std::map<std::string, std::string>{{"seed", taken(cases::identity_file(folder))}};
           },
           [](const fs::path& folder, std::string_view bytes) {
             (void)put(folder, "identity.json", bytes);
             (void)cases::load_identity(folder).value().in_words();
             return std::string();
           }},
          {"study", "study.json",
           [](const fs::path& folder) {
             cases::save_studies(folder, {{BoneKind::Femur,
                                           {.study_uid = "1.2.3",
                                            .study_date = "20260130",
                                            .series_uid = "1.2.3.4",
                                            .frame_of_reference_uid = "1.2.3.9",
                                            .sop_class_uid = "1.2.840.10008.5.1.4.1.1.2",
                                            .sop_instance_uids = {"1.2.3.4.1", "1.2.3.4.2"}}}});
             return std::map<std::string, std::string>{{"seed", taken(cases::study_file(folder))}};
           },
           [](const fs::path& folder, std::string_view bytes) {
             (void)put(folder, "study.json", bytes);
             (void)cases::load_studies(folder);
             return std::string();
           }}};
}

}  // namespace arthronaut::fuzzing
