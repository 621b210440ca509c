#include "navigation/registration/registration_file.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "navigation/camera/medium.h"
#include "planning/bones/bone_json.h"
#include "planning/bones/mesh_hash.h"
#include "planning/files/json_covariance.h"
#include "planning/files/json_document.h"

namespace arthronaut::registration {

namespace {
using Json = nlohmann::ordered_json;
constexpr const char* kFormat = "arthronaut.registration";
constexpr int kVersion = 1;

std::string_view to_text(CartilageUse use) {
  switch (use) {
    case CartilageUse::None:
      return "none";
    case CartilageUse::Solved:
      return "solved";
    case CartilageUse::LeftOut:
      return "left out";
  }
  return "unknown";
}

void read_cartilage(const files::JsonObject& document, RegistrationSummary& summary) {
  // Where nothing is said, nobody knows how far off the mesh the probe touches on it.
  summary.cartilage_use = CartilageUse::LeftOut;
  if (!document.has("cartilage_use")) return;
  const std::string word = document.text("cartilage_use");
  constexpr std::array kUses{CartilageUse::None, CartilageUse::Solved, CartilageUse::LeftOut};
  const auto* const use =
      std::find_if(kUses.begin(), kUses.end(), [&](CartilageUse known) { return to_text(known) == word; });
  if (use == kUses.end()) document.fail("cartilage_use", "must be none, solved or left out");
  summary.cartilage_use = *use;
  if (*use == CartilageUse::Solved)
    summary.cartilage_thickness_mm = document.number("cartilage_thickness_mm");
}

RegistrationSummary summary_from(const files::JsonObject& document) {
  RegistrationSummary summary;
  // Other programs' files have a pose and don't say so.
  summary.has_pose = !document.has("has_pose") || document.boolean("has_pose");
  if (summary.has_pose) {
    summary.marker_from_bone = document.rigid_transform("marker_from_bone");
    summary.rms_mm = document.number("rms_mm");
    summary.predicted_tre_mm = document.number("predicted_tre_mm");
    for (const char* key : {"rms_mm", "predicted_tre_mm"})
      if (document.number(key) < 0) document.fail(key, "must not be negative");
  }
  summary.inlier_fraction = document.number("inlier_fraction");
  summary.point_count = document.int32("point_count");
  summary.reliable = document.boolean("reliable");
  summary.reasons = document.texts("reasons");
  if (summary.reliable && !summary.has_pose)
    document.fail("reliable", "must be false where no pose was found");
  if (document.has("runner_up_ratio")) summary.runner_up_ratio = document.number("runner_up_ratio");
  if (document.has("misfit_mm")) summary.misfit_mm = document.number("misfit_mm");
  if (document.has("shared_misfit_mm")) summary.shared_misfit_mm = document.number("shared_misfit_mm");
  if (document.has("stroke_scale")) {
    const files::JsonObject scale = document.object("stroke_scale");
    summary.stroke_scale = {scale.number("ratio"), scale.number("sigma")};
  }
  if (document.has("assumptions")) summary.assumptions = document.texts("assumptions");
  read_cartilage(document, summary);
  if (document.has("covariance")) {
    summary.covariance = files::read_covariance(document, "covariance", 6);
  } else {
    // As far off at every place as it is said to be at the target, each coordinate alike.
    summary.covariance.topLeftCorner<3, 3>() =
        summary.predicted_tre_mm * summary.predicted_tre_mm / 3 * Eigen::Matrix3d::Identity();
  }
  return summary;
}

constexpr double kSamePlace_mm = 1.0;

}  // namespace

RegisteredMesh registered_mesh(const geometry::TriangleMesh& mesh) {
  return {bones::mesh_sha256(mesh), geometry::bounds_of(mesh)};
}

bool may_be(const RegisteredMesh& mesh, const geometry::TriangleMesh& bone) {
  const geometry::Bounds bounds = geometry::bounds_of(bone);
  const double off_mm = std::max((mesh.bounds.min_mm - bounds.min_mm).lpNorm<Eigen::Infinity>(),
                                 (mesh.bounds.max_mm - bounds.max_mm).lpNorm<Eigen::Infinity>());
  return off_mm <= kSamePlace_mm || mesh.sha256 == bones::mesh_sha256(bone);
}

nlohmann::ordered_json to_json(const Provenance& of) {
  Json json;
  json["mesh_sha256"] = of.mesh_sha256;
  json["bone"] = bones::to_text(of.bone);
  json["marker_id"] = of.world_marker_id;
  json["camera"] = of.camera;
  json["tools"] = of.tools;
  json["medium"] = camera::medium_to_text(of.refractive_index);
  json["source"] = sources::to_text(of.source);
  return json;
}

Provenance provenance_from(const files::JsonObject& json) {
  Provenance of;
  of.mesh_sha256 = json.text("mesh_sha256");
  of.bone = bones::read_bone_kind(json, "bone");
  of.world_marker_id = json.int32("marker_id");
  of.camera = json.text("camera");
  of.tools = json.text("tools");
  of.refractive_index = camera::refractive_index_from(json, "medium");
  const auto source = sources::source_kind_from_text(json.text("source"));
  if (!source) json.fail("source", "must be live, recording or simulation");
  of.source = *source;
  return of;
}

RegistrationSummary read_registration_file(const std::filesystem::path& file) {
  return read_registration_record(file).registration;
}

RegistrationRecord read_registration_record(const std::filesystem::path& file) {
  const files::JsonObject document = files::read_json(file, kFormat, kVersion);
  return registration_record_from(document);
}

RegistrationRecord registration_record_from(const files::JsonObject& document) {
  RegistrationRecord record{summary_from(document), std::nullopt, std::nullopt};
  if (document.has("of")) record.of = provenance_from(document.object("of"));
  if (document.has("mesh")) {
    const files::JsonObject mesh = document.object("mesh");
    record.mesh = RegisteredMesh{mesh.text("sha256"), {mesh.vector3("min_mm"), mesh.vector3("max_mm")}};
  }
  return record;
}

void write_registration_file(const std::filesystem::path& file, const RegistrationSummary& registration,
                             const Provenance* of) {
  files::write_json(file, to_json(registration, of));
}

void write_registration_file(const std::filesystem::path& file, const RegistrationSummary& registration,
                             const RegisteredMesh& mesh) {
  Json document = to_json(registration, nullptr);
  document["mesh"] = {{"sha256", mesh.sha256},
                      {"min_mm", files::to_json(mesh.bounds.min_mm)},
                      {"max_mm", files::to_json(mesh.bounds.max_mm)}};
  files::write_json(file, document);
}

nlohmann::ordered_json to_json(const RegistrationSummary& registration, const Provenance* of) {
  Json document;
  document["format"] = kFormat;
  document["version"] = kVersion;
  document["has_pose"] =
      registration.has_pose;  // the format wants a pose in any case: without one it is the identity
  document["marker_from_bone"] = files::to_json(registration.marker_from_bone);
  // Of no pose there is no error: a 0 would read as none.
  const auto of_pose = [&](double value) { return registration.has_pose ? Json(value) : Json(); };
  document["rms_mm"] = of_pose(registration.rms_mm);
  document["inlier_fraction"] = registration.inlier_fraction;
  document["point_count"] = registration.point_count;
  document["reliable"] = registration.reliable;
  document["reasons"] = registration.reasons;
  document["predicted_tre_mm"] = of_pose(registration.predicted_tre_mm);
  document["runner_up_ratio"] = registration.runner_up_ratio;
  document["misfit_mm"] = registration.misfit_mm;
  document["shared_misfit_mm"] = registration.shared_misfit_mm;
  if (registration.has_pose)
    document["stroke_scale"] = {{"ratio", registration.stroke_scale.ratio},
                                {"sigma", registration.stroke_scale.sigma}};
  document["assumptions"] = registration.assumptions;
  document["cartilage_use"] = to_text(registration.cartilage_use);
  if (registration.cartilage_use == CartilageUse::Solved)
    document["cartilage_thickness_mm"] = registration.cartilage_thickness_mm;
  document["covariance"] = files::covariance_to_json(registration.covariance);
  if (of != nullptr) document["of"] = to_json(*of);
  return document;
}

}  // namespace arthronaut::registration
