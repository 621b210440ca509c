// A planned tunnel against published norms. The numbers are means of studies and customs, each with its
// source; they are no limits of safety, every one can be changed, and the surgeon decides.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planning/landmarks/insertion_grids.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::tunnels {

struct PlanCheck {
  // Fine: as the norm has it. Look: outside of it. Wrong: the tunnel can't be drilled like this. Note: a
  // number alone.
  enum class Verdict { Fine, Look, Wrong, Note } verdict = Verdict::Note;
  std::string name;    // "Length"
  std::string text;    // "24.1 mm: shorter than 25 mm"
  std::string source;  // where the number to compare with comes from; empty when there is none
};

// A study's mean and how far from it still counts as fine.
struct NormRange {
  double center, radius;
};

struct PlanNorms {
  // "Customary" limits: not defined in the literature (see 10.1007/s10195-017-0448-9 for the femoral length).
  double short_femoral_tunnel_mm = 30, too_short_femoral_tunnel_mm = 25;
  NormRange tibial_length_mm{40, 5};
  double thin_wall_mm = 2, breaking_wall_mm = 1;
  double small_diameter_mm = 8, wide_diameter_mm = 11;
  // Review of 13 studies (Arthroscopy 2016): 28.4 +- 5.1, 35.7 +- 6.9 %.
  NormRange femur_deep_shallow_percent{28.4, 5.1}, femur_high_low_percent{35.7, 6.9};
  // Cho 2017: 40.9 % (38.0 to 45.0). 10.1177/23259671231208678: 46.7 +- 2.0 %.
  NormRange tibia_anterior_posterior_percent{41.5, 3.5}, tibia_medial_lateral_percent{46.7, 4.0};
  // Howell: 65 to 70 deg in the coronal plane is advised, 75 and more costs flexion.
  NormRange tibial_coronal_deg{67.5, 2.5};
  double too_steep_tibial_coronal_deg = 75;
};

// What is known of the bone beside the tunnel; each check that lacks its part is left out.
struct PlanSurroundings {
  std::optional<landmarks::FemoralQuadrant> quadrant;  // femur
  std::optional<landmarks::TibialGrid> plateau;        // tibia
  std::optional<Eigen::Vector3d> native_footprint_mm;  // centre of the native insertion
};
[[nodiscard]] PlanSurroundings surroundings_of(const geometry::TriangleMesh& bone, bones::BoneKind kind,
                                               const landmarks::Landmarks& landmarks, bones::Side side);

// The angle between the tunnel's projection on the coronal plane and the plateau's medial-lateral line,
// degrees in [0, 90]: 90 is a tunnel along the tibia's long axis.
[[nodiscard]] double coronal_angle_deg(const Eigen::Vector3d& direction);

// In a fixed order, length first. A tunnel that misses the bone gives one check, which says so.
[[nodiscard]] std::vector<PlanCheck> check_plan(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                                const PlanSurroundings& surroundings,
                                                const PlanNorms& norms = {});

}  // namespace arthronaut::tunnels
