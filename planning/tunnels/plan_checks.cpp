#include "planning/tunnels/plan_checks.h"

#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

using Verdict = PlanCheck::Verdict;

std::string number(double value, const char* unit) { return files::format("%.1f %s", value, unit); }

// Without a needless ".0": limits are round numbers mostly.
std::string limit(double value, const char* unit) { return files::format("%g %s", value, unit); }

PlanCheck check_length(const Tunnel& tunnel, const TunnelGeometry& geometry, const PlanNorms& norms) {
  PlanCheck check{Verdict::Fine, "Length", number(geometry.length_mm, "mm"), ""};
  if (tunnel.bone == bones::BoneKind::Femur) {
    check.source = "studies find 34 to 39 mm (Tompkins 2013, Sim 2017); " +
                   limit(norms.too_short_femoral_tunnel_mm, "") + "to " +
                   limit(norms.short_femoral_tunnel_mm, "mm") + " as a limit is customary";
    if (geometry.length_mm < norms.too_short_femoral_tunnel_mm) {
      check.verdict = Verdict::Look;
      check.text +=
          ": shorter than " + limit(norms.too_short_femoral_tunnel_mm, "mm") + ", little graft in bone";
    } else if (geometry.length_mm < norms.short_femoral_tunnel_mm) {
      check.verdict = Verdict::Look;
      check.text += ": shorter than " + limit(norms.short_femoral_tunnel_mm, "mm");
    }
    return check;
  }
  const auto& [center, radius] = norms.tibial_length_mm;
  check.source = limit(center - radius, "") + "to " + limit(center + radius, "mm") + " is customary";
  if (std::abs(geometry.length_mm - center) > radius) {
    check.verdict = Verdict::Look;
    check.text += geometry.length_mm < center ? ": short" : ": long";
  }
  return check;
}

// The back wall is a femoral matter. A tibial tunnel leaves through a slanting face, where its wall thins out
// by itself: there only a wall that is nearly gone is worth a look.
PlanCheck check_wall(const Tunnel& tunnel, const TunnelGeometry& geometry, const PlanNorms& norms) {
  PlanCheck check{Verdict::Fine, "Wall", number(geometry.wall_mm, "mm"), ""};
  if (tunnel.bone == bones::BoneKind::Tibia) {
    check.source = "no published limit for the tibia";
    if (geometry.wall_mm < norms.breaking_wall_mm) {
      check.verdict = Verdict::Look;
      check.text +=
          ": less than " + limit(norms.breaking_wall_mm, "mm") + " beside the tunnel or at its slanting exit";
    }
    return check;
  }
  check.source = "a rim of 2.5 mm (Piefer 2012, PubMed 22301358); 1 to 2 mm as a limit is customary";
  if (geometry.wall_mm <= 0) {
    check.verdict = Verdict::Wrong;
    check.text += ": breaks out of the bone";
  } else if (geometry.wall_mm < norms.breaking_wall_mm) {
    check.verdict = Verdict::Wrong;
    check.text += ": may break out, less than " + limit(norms.breaking_wall_mm, "mm");
  } else if (geometry.wall_mm < norms.thin_wall_mm) {
    check.verdict = Verdict::Look;
    check.text += ": thinner than " + limit(norms.thin_wall_mm, "mm");
  }
  return check;
}

PlanCheck check_diameter(const Tunnel& tunnel, const PlanNorms& norms) {
  PlanCheck check{Verdict::Fine, "Diameter", number(tunnel.diameter_mm, "mm"),
                  "grafts of 8 mm and more are called adequate (PMC6024536); up to 11 mm is customary"};
  const bool is_small =
      tunnel.diameter_mm<norms.small_diameter_mm, is_wide = tunnel.diameter_mm> norms.wide_diameter_mm;
  if (is_small || is_wide) {
    check.verdict = Verdict::Look;
    check.text += is_small ? ": small" : ": wide";
  }
  return check;
}

PlanCheck check_share(const char* name, double percent, const NormRange& norm, const char* below,
                      const char* above, const char* source) {
  PlanCheck check{Verdict::Fine, name, number(percent, "%"), source};
  if (std::abs(percent - norm.center) > norm.radius) {
    check.verdict = Verdict::Look;
    check.text += std::string(": ") + (percent < norm.center ? below : above) + " than " +
                  limit(percent < norm.center ? norm.center - norm.radius : norm.center + norm.radius, "%");
  }
  return check;
}

PlanCheck check_coronal_angle(const Tunnel& tunnel, const PlanNorms& norms) {
  const double angle = coronal_angle_deg(tunnel.direction);
  const auto& [center, radius] = norms.tibial_coronal_deg;
  PlanCheck check{Verdict::Fine, "Coronal angle", number(angle, "deg"),
                  "65 to 70 deg is advised; at 75 deg and more flexion and tightness suffer (Howell)"};
  if (angle >= norms.too_steep_tibial_coronal_deg) {
    check.verdict = Verdict::Look;
    check.text += ": " + limit(norms.too_steep_tibial_coronal_deg, "deg") + " or steeper";
  } else if (std::abs(angle - center) > radius) {
    check.verdict = Verdict::Note;
    check.text += angle < center ? ": flatter than advised" : ": steeper than advised";
  }
  return check;
}

}  // namespace

double coronal_angle_deg(const Eigen::Vector3d& direction) {
  return geometry::deg_from_rad(std::atan2(std::abs(direction.z()), std::abs(direction.x())));
}

PlanSurroundings surroundings_of(const geometry::TriangleMesh& bone, bones::BoneKind kind,
                                 const landmarks::Landmarks& landmarks, bones::Side side) {
  PlanSurroundings known;
  if (kind == bones::BoneKind::Femur) known.quadrant = landmarks::femoral_quadrant(bone, landmarks, side);
  if (kind == bones::BoneKind::Tibia) known.plateau = landmarks::tibial_grid(landmarks);
  if (const auto at = landmarks.find("native_footprint"); at != landmarks.end())
    known.native_footprint_mm = at->second;
  return known;
}

std::vector<PlanCheck> check_plan(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                  const PlanSurroundings& surroundings, const PlanNorms& norms) {
  if (!geometry.enters_bone) {
    return {{Verdict::Wrong, "Axis", "misses the bone: place the entry on it and aim inwards", ""}};
  }
  std::vector<PlanCheck> checks{check_length(tunnel, geometry, norms), check_wall(tunnel, geometry, norms),
                                check_diameter(tunnel, norms)};
  const Eigen::Vector3d& entry = geometry.entry_on_surface_mm;
  if (tunnel.bone == bones::BoneKind::Femur && surroundings.quadrant) {
    const auto percent = surroundings.quadrant->percent_of(entry);
    checks.push_back(check_share(
        "Deep to shallow", percent.deep_shallow, norms.femur_deep_shallow_percent, "deeper", "shallower",
        "Bernard-Hertel 28.4 +- 5.1 %, review of 13 studies (Arthroscopy 2016); of 16 grafts "
        "that failed 15 were shallower than 35 % (de Mees 2022)"));
    checks.push_back(check_share("High to low", percent.high_low, norms.femur_high_low_percent, "higher",
                                 "lower",
                                 "Bernard-Hertel 35.7 +- 6.9 %, review of 13 studies (Arthroscopy 2016)"));
  }
  if (tunnel.bone == bones::BoneKind::Tibia) {
    if (surroundings.plateau) {
      const auto percent = surroundings.plateau->percent_of(entry);
      checks.push_back(check_share("Anterior to posterior", percent.anterior_posterior,
                                   norms.tibia_anterior_posterior_percent, "more anterior", "more posterior",
                                   "Amis-Jakob 40.9 %, 38.0 to 45.0 (Cho 2017, PMC5686853)"));
      checks.push_back(check_share("Medial to lateral", percent.medial_lateral,
                                   norms.tibia_medial_lateral_percent, "more medial", "more lateral",
                                   "46.7 +- 2.0 % (10.1177/23259671231208678)"));
    }
    checks.push_back(check_coronal_angle(tunnel, norms));
  }
  if (surroundings.native_footprint_mm) {
    checks.push_back({Verdict::Note, "Footprint",
                      number((entry - *surroundings.native_footprint_mm).norm(), "mm") + " from its centre",
                      ""});
  }
  return checks;
}

}  // namespace arthronaut::tunnels
