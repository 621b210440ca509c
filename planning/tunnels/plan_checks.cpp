#include "planning/tunnels/plan_checks.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/breach.h"
#include "planning/tunnels/place_checks.h"

namespace arthronaut::tunnels {

namespace {

using Verdict = PlanCheck::Verdict;

PlanCheck check_length_in_images(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                 const PlanNorms& norms) {
  PlanCheck check{.verdict = Verdict::Fine,
                  .name = "Length",
                  .text = number_text(geometry.length_mm, "mm"),
                  .value = geometry.length_mm,
                  .unit = "mm",
                  .at_mm = geometry.exit_mm,
                  .rests_on_side = false};
  if (tunnel.bone == bones::BoneKind::Femur) {
    check.source = "studies find 34 to 39 mm (Tompkins 2013, Sim 2017), 29.6 to 50.5 mm (Hodel 2021); " +
                   limit_text(norms.too_short_femoral_tunnel_mm, "") + "to " +
                   limit_text(norms.short_femoral_tunnel_mm, "mm") + " as a limit is customary";
    check.least = norms.short_femoral_tunnel_mm;
    check.greatest = norms.long_femoral_tunnel_mm;
    if (geometry.length_mm < norms.too_short_femoral_tunnel_mm) {
      check.verdict = Verdict::Look;
      check.text +=
          ": shorter than " + limit_text(norms.too_short_femoral_tunnel_mm, "mm") + ", little graft in bone";
    } else if (geometry.length_mm < norms.short_femoral_tunnel_mm) {
      check.verdict = Verdict::Look;
      check.text += ": shorter than " + limit_text(norms.short_femoral_tunnel_mm, "mm");
    } else if (geometry.length_mm > norms.long_femoral_tunnel_mm) {
      check.verdict = Verdict::Wrong;
      check.text +=
          ": longer than " + limit_text(norms.long_femoral_tunnel_mm, "mm") + ", it runs across the bone";
    }
    return check;
  }
  const auto& [center, radius] = norms.tibial_length_mm;
  check.source =
      limit_text(center - radius, "") + "to " + limit_text(center + radius, "mm") + " is customary";
  check.least = center - radius;
  check.greatest = center + radius;
  if (std::abs(geometry.length_mm - center) > radius) {
    check.verdict = Verdict::Look;
    check.text += geometry.length_mm < center ? ": short" : ": long";
  }
  return check;
}

PlanCheck check_length(const Tunnel& tunnel, const TunnelGeometry& geometry,
                       const PlanSurroundings& surroundings, const PlanNorms& norms) {
  PlanCheck check = check_length_in_images(tunnel, geometry, norms);
  // What is too long in them is so beyond them.
  const bool is_too_long = check.greatest && geometry.length_mm > *check.greatest;
  const std::string unseen = unseen_at_exit(geometry, surroundings);
  return !unseen.empty() && !is_too_long ? not_seen("Length", unseen) : check;
}

// Along the axis from the entry. A slanting mouth reaches before the entry and beyond the exit, where a depth
// says nothing.
std::string depth_text(const TunnelGeometry& geometry) {
  if (geometry.thinnest_station_mm < 0.05) return "at the mouth";
  if (geometry.thinnest_station_mm > geometry.length_mm - 0.05) return "at the exit";
  return "at " + number_text(geometry.thinnest_station_mm, "mm") + " of depth";
}

// "breaks out of the bone over 4.0 mm, from the mouth to 4.0 mm of depth"; of more than two places, as in
// thin bone that was imaged coarsely, where they lie and how much they are together.
std::string breach_text(const Tunnel& tunnel, const TunnelGeometry& geometry,
                        const geometry::Surface* surface) {
  constexpr double kAtMouth_mm = 0.05;
  std::string text;
  const auto breaches =
      surface != nullptr ? breaches_of(tunnel, geometry, *surface) : std::vector<DepthRange>{};
  if (breaches.size() > 2) {
    double together_mm = 0;
    for (const DepthRange& breach : breaches)
      together_mm += std::min(breach.to_mm, geometry.length_mm) - std::max(breach.from_mm, 0.0);
    return "breaks out of the bone in " + std::to_string(breaches.size()) + " places, over " +
           number_text(together_mm, "mm") + " in all, from " +
           number_text(std::max(breaches.front().from_mm, 0.0), "mm") + " to " +
           number_text(std::min(breaches.back().to_mm, geometry.length_mm), "mm") + " of depth";
  }
  for (const DepthRange& breach : breaches) {
    const double from = std::max(breach.from_mm, 0.0), to = std::min(breach.to_mm, geometry.length_mm);
    const bool from_mouth = from < kAtMouth_mm;
    const bool to_exit = geometry.length_mm - to < kAtMouth_mm;
    text += text.empty() ? " " : " and ";
    if (to - from < kAtMouth_mm) {  // in a slanting rim, or too short for a number
      text += from_mouth ? "at the mouth" : to_exit ? "at the exit" : "at " + number_text(from, "mm");
      continue;
    }
    text += "over " + number_text(to - from, "mm") + ", from ";
    text += from_mouth ? "the mouth" : files::format(to_exit ? "%.1f mm of depth" : "%.1f", from);
    text += to_exit ? " to the exit" : " to " + number_text(to, "mm") + " of depth";
  }
  return "breaks out of the bone" + text;
}

// The limits of the back wall are the femur's; of the tibia nobody has published one.
PlanCheck check_wall(const Tunnel& tunnel, const TunnelGeometry& geometry, const geometry::Surface* surface,
                     const PlanNorms& norms) {
  PlanCheck check{
      .verdict = Verdict::Fine,
      .name = "Wall",
      .text = number_text(geometry.wall_mm, "mm") + " " + depth_text(geometry),
      .value = geometry.wall_mm,
      .unit = "mm",
      .least = tunnel.bone == bones::BoneKind::Femur ? norms.thin_wall_mm : norms.breaking_wall_mm,
      .at_mm = geometry.thinnest_mm,
      .rests_on_side = false};
  if (tunnel.bone == bones::BoneKind::Tibia) {
    check.source = "no published limit for the tibia";
    if (geometry.wall_mm < norms.breaking_wall_mm) {
      check.verdict = geometry.wall_mm <= 0 ? Verdict::Wrong : Verdict::Look;
      check.text += ": " + (geometry.wall_mm <= 0 ? breach_text(tunnel, geometry, surface)
                                                  : "less than " + limit_text(norms.breaking_wall_mm, "mm"));
    }
    return check;
  }
  check.source = "a rim of 2.5 mm (Piefer 2012, PubMed 22301358); 1 to 2 mm as a limit is customary";
  if (geometry.wall_mm <= 0) {
    check.verdict = Verdict::Wrong;
    check.text += ": " + breach_text(tunnel, geometry, surface);
  } else if (geometry.wall_mm < norms.breaking_wall_mm) {
    check.verdict = Verdict::Wrong;
    check.text += ": may break out, less than " + limit_text(norms.breaking_wall_mm, "mm");
  } else if (geometry.wall_mm < norms.thin_wall_mm) {
    check.verdict = Verdict::Look;
    check.text += ": thinner than " + limit_text(norms.thin_wall_mm, "mm");
  }
  return check;
}

PlanCheck check_diameter(const Tunnel& tunnel, const PlanNorms& norms) {
  if (tunnel.bundle != norms::Bundle::Whole)
    return {.verdict = Verdict::Note,
            .name = "Diameter",
            .text = number_text(tunnel.diameter_mm, "mm"),
            .source = "of one of two bundles: no published limit",
            .value = tunnel.diameter_mm,
            .unit = "mm"};
  PlanCheck check{
      .verdict = Verdict::Fine,
      .name = "Diameter",
      .text = number_text(tunnel.diameter_mm, "mm"),
      .source = "grafts of 8 mm and more are called adequate (PMC6024536); up to 11 mm is customary",
      .value = tunnel.diameter_mm,
      .unit = "mm",
      .least = norms.small_diameter_mm,
      .greatest = norms.wide_diameter_mm,
      .rests_on_side = false};
  const bool is_small =
      tunnel.diameter_mm<norms.small_diameter_mm, is_wide = tunnel.diameter_mm> norms.wide_diameter_mm;
  if (is_small || is_wide) {
    check.verdict = Verdict::Look;
    check.text += is_small ? ": small" : ": wide";
  }
  return check;
}

PlanCheck check_share(const char* name, double percent, const NormRange& norm, const char* below,
                      const char* above, std::string source) {
  PlanCheck check{.verdict = Verdict::Fine,
                  .name = name,
                  .text = number_text(percent, "%"),
                  .source = std::move(source),
                  .value = percent,
                  .unit = "%",
                  .least = norm.center - norm.radius,
                  .greatest = norm.center + norm.radius};
  if (std::abs(percent - norm.center) > norm.radius) {
    check.verdict = Verdict::Look;
    check.text +=
        std::string(": ") + (percent < norm.center ? below : above) + " than " +
        limit_text(percent < norm.center ? norm.center - norm.radius : norm.center + norm.radius, "%");
  }
  return check;
}

PlanCheck check_coronal_angle(const Tunnel& tunnel, const landmarks::AnatomicalAxes& axes,
                              const PlanNorms& norms) {
  const double angle = coronal_angle_deg(tunnel.direction, axes);
  const auto& [center, radius] = norms.tibial_coronal_deg;
  PlanCheck check{
      .verdict = Verdict::Fine,
      .name = "Coronal angle",
      .text = number_text(angle, "deg"),
      .source = "65 to 70 deg is advised; at 75 deg and more flexion and tightness suffer (Howell); by " +
                std::string(to_text(axes.origin)),
      .value = angle,
      .unit = "deg",
      .least = center - radius,
      .greatest = center + radius};
  if (angle >= norms.too_steep_tibial_coronal_deg) {
    check.verdict = Verdict::Look;
    check.text += ": " + limit_text(norms.too_steep_tibial_coronal_deg, "deg") + " or steeper";
  } else if (std::abs(angle - center) > radius) {
    check.verdict = Verdict::Note;
    check.text += angle < center ? ": flatter than advised" : ": steeper than advised";
  }
  return check;
}

}  // namespace

std::string_view to_text(PlanCheck::Verdict verdict) {
  switch (verdict) {
    case Verdict::Fine:
      return "fine";
    case Verdict::Look:
      return "look";
    case Verdict::Wrong:
      return "wrong";
    case Verdict::Note:
      return "note";
    case Verdict::NotChecked:
      return "not checked";
  }
  return "unknown";
}

bool is_failed(const PlanCheck& check) {
  return check.verdict == Verdict::Look || check.verdict == Verdict::Wrong;
}

std::vector<std::string> wrong_in_words(const std::vector<PlanCheck>& checks) {
  std::vector<std::string> wrong;
  for (const PlanCheck& check : checks)
    if (check.verdict == Verdict::Wrong) wrong.push_back(check.name + ": " + check.text);
  return wrong;
}

double coronal_angle_deg(const Eigen::Vector3d& direction, const landmarks::AnatomicalAxes& axes) {
  return geometry::deg_from_rad(
      std::atan2(std::abs(direction.dot(axes.proximal)), std::abs(direction.dot(axes.lateral))));
}

PlanSurroundings surroundings_of(const geometry::TriangleMesh& bone, bones::BoneKind kind,
                                 const landmarks::Landmarks& landmarks, bones::Side side,
                                 std::shared_ptr<const geometry::Surface> surface) {
  PlanSurroundings known;
  if (kind == bones::BoneKind::Femur) known.quadrant = landmarks::femoral_quadrant(bone, landmarks, side);
  if (kind == bones::BoneKind::Tibia) known.plateau = landmarks::tibial_grid(landmarks);
  if (const auto at = landmarks.find("native_footprint"); at != landmarks.end())
    known.native_footprint_mm = at->second;
  known.axes = landmarks::anatomical_axes(kind, side, landmarks, bone);
  known.extents = bone_extents(bone, kind, *known.axes);
  known.landmarks = landmarks;
  known.surface = std::move(surface);
  return known;
}

namespace {

struct ShareNorm {
  NormRange range;
  std::string source;
};
// Of the whole ligament what PlanNorms says; of a bundle the mean of its own study and one sigma.
ShareNorm share_norm(const Tunnel& tunnel, const NormRange& whole, const char* whole_source,
                     norms::PercentNorm norms::InsertionNorm::*share) {
  if (tunnel.bundle == norms::Bundle::Whole) return {whole, whole_source};
  const norms::InsertionNorm& norm = norms::default_norm(tunnel.bone, tunnel.bundle);
  return {{(norm.*share).mean, (norm.*share).sd},
          (tunnel.bundle == norms::Bundle::Anteromedial ? "AM: " : "PL: ") + norms::cited(norm)};
}

void add_grid_checks(const Tunnel& tunnel, const Eigen::Vector3d& entry, const PlanSurroundings& surroundings,
                     const PlanNorms& norms, std::vector<PlanCheck>& checks) {
  if (tunnel.bone == bones::BoneKind::Femur) {
    if (!surroundings.quadrant) {
      for (const char* name : {"Deep to shallow", "High to low"})
        checks.push_back(
            not_checked(name, "Blumensaat's line, blumensaat_anterior and blumensaat_posterior,"));
      return;
    }
    const auto percent = surroundings.quadrant->percent_of(entry);
    const ShareNorm along =
        share_norm(tunnel, norms.femur_deep_shallow_percent,
                   "Bernard-Hertel 28.4 +- 5.1 %, review of 13 studies (Arthroscopy 2016); of 16 grafts "
                   "that failed 15 were shallower than 35 % (de Mees 2022)",
                   &norms::InsertionNorm::along);
    const ShareNorm across =
        share_norm(tunnel, norms.femur_high_low_percent,
                   "Bernard-Hertel 35.7 +- 6.9 %, review of 13 studies (Arthroscopy 2016)",
                   &norms::InsertionNorm::across);
    checks.push_back(check_share("Deep to shallow", percent.deep_shallow, along.range, "deeper", "shallower",
                                 along.source));
    checks.push_back(
        check_share("High to low", percent.high_low, across.range, "higher", "lower", across.source));
    const auto is_known = [&](const char* name) { return surroundings.landmarks.contains(name); };
    // As landmarks::femoral_quadrant() takes its extents.
    if (is_known("blumensaat_anterior") &&
        !(is_known("lateral_condyle_deep") && is_known("lateral_condyle_shallow") &&
          is_known("lateral_condyle_low")))
      for (PlanCheck* share : {&checks.end()[-2], &checks.end()[-1]}) {
        share->text += "; grid from the outline";
        share->source +=
            "; the grid touches the outline of the bone's surface, since lateral_condyle_deep, "
            "lateral_condyle_shallow and lateral_condyle_low are not all known";
      }
    return;
  }
  if (!surroundings.plateau) {
    for (const char* name : {"Anterior to posterior", "Medial to lateral"})
      checks.push_back(not_checked(name, "one of the four plateau landmarks"));
    return;
  }
  const auto percent = surroundings.plateau->percent_of(entry);
  const ShareNorm along =
      share_norm(tunnel, norms.tibia_anterior_posterior_percent,
                 "Amis-Jakob 40.9 %, 38.0 to 45.0 (Cho 2017, PMC5686853)", &norms::InsertionNorm::along);
  const ShareNorm across =
      share_norm(tunnel, norms.tibia_medial_lateral_percent, "46.7 +- 2.0 % (10.1177/23259671231208678)",
                 &norms::InsertionNorm::across);
  checks.push_back(check_share("Anterior to posterior", percent.anterior_posterior, along.range,
                               "more anterior", "more posterior", along.source));
  checks.push_back(check_share("Medial to lateral", percent.medial_lateral, across.range, "more medial",
                               "more lateral", across.source));
}

}  // namespace

std::vector<PlanCheck> check_plan(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                  const PlanSurroundings& surroundings, const PlanNorms& norms) {
  if (!geometry.enters_bone) {
    return {{.verdict = Verdict::Wrong,
             .name = "Axis",
             .text = "misses the bone: place the entry on it and aim inwards"}};
  }
  std::vector<PlanCheck> checks{
      check_length(tunnel, geometry, surroundings, norms),
      check_wall(tunnel, geometry, surroundings.surface.get(), norms), check_diameter(tunnel, norms),
      check_entry_place(tunnel, geometry, surroundings), check_exit_place(tunnel, geometry, surroundings)};
  if (!surroundings.unseen.was_looked_for) checks.push_back(not_looked_for());
  add_grid_checks(tunnel, geometry.entry_on_surface_mm, surroundings, norms, checks);
  if (tunnel.bone == bones::BoneKind::Tibia) {
    checks.push_back(surroundings.axes ? check_coronal_angle(tunnel, *surroundings.axes, norms)
                                       : not_checked("Coronal angle", "the bone's axes"));
  }
  for (PlanCheck& check : check_exit_neighbours(tunnel, geometry, surroundings, norms))
    checks.push_back(std::move(check));
  checks.push_back(check_mouth(geometry, norms));
  for (PlanCheck& check : check_footprint(tunnel, geometry, surroundings)) checks.push_back(std::move(check));
  return checks;
}

}  // namespace arthronaut::tunnels
