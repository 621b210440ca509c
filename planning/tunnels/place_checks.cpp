#include "planning/tunnels/place_checks.h"

#include "planning/files/fixed_number.h"
#include "planning/files/format.h"
#include "planning/tunnels/footprint_share.h"

namespace arthronaut::tunnels {

namespace {

using Verdict = PlanCheck::Verdict;

// Axes out of the scanner are right only for a patient who lay straight in it.
std::string seen_along(const landmarks::AnatomicalAxes& axes) {
  return "by the shape, seen along " + std::string(to_text(axes.origin));
}

struct Finding {
  Verdict verdict;
  const char* text;
};

Finding say(FemoralEntry entry) {
  switch (entry) {
    case FemoralEntry::LateralWall:
      return {Verdict::Fine, "on the lateral wall of the notch"};
    case FemoralEntry::MedialWall:
      return {Verdict::Wrong, "on the medial wall of the notch: the wrong side"};
    case FemoralEntry::Roof:
      return {Verdict::Look, "on the roof of the notch"};
    case FemoralEntry::OutsideNotch:
      break;
  }
  return {Verdict::Wrong, "not in the notch"};
}

Finding say(FemoralExit exit) {
  switch (exit) {
    case FemoralExit::LateralCortex:
      return {Verdict::Fine, "out of the lateral cortex"};
    case FemoralExit::MedialSide:
      return {Verdict::Wrong, "out of the medial side: the wrong side"};
    case FemoralExit::IntoNotch:
      return {Verdict::Wrong, "into the notch"};
    case FemoralExit::Front:
      return {Verdict::Look, "out of the front of the femur, beneath the extensor muscles"};
    case FemoralExit::Back:
      return {Verdict::Wrong, "out of the back of the femur, towards the vessels"};
    case FemoralExit::Above:
      return {Verdict::Wrong, "up the shaft and out of its cut end"};
    case FemoralExit::JointSurface:
      break;
  }
  return {Verdict::Wrong, "through the joint surface"};
}

Finding say(TibialEntry entry) {
  switch (entry) {
    case TibialEntry::BetweenCondyles:
      return {Verdict::Fine, "between the condyles of the plateau"};
    case TibialEntry::MedialPlateau:
      return {Verdict::Wrong, "on the joint surface of the medial plateau"};
    case TibialEntry::LateralPlateau:
      return {Verdict::Wrong, "on the joint surface of the lateral plateau"};
    case TibialEntry::BesidePlateau:
      break;
  }
  return {Verdict::Wrong, "not on the plateau"};
}

Finding say(TibialExit exit) {
  switch (exit) {
    case TibialExit::AnteromedialFace:
      return {Verdict::Fine, "out of the anteromedial face"};
    case TibialExit::LateralFace:
      return {Verdict::Wrong, "out of the lateral face: the wrong side"};
    case TibialExit::PosteriorFace:
      return {Verdict::Wrong, "out of the back of the tibia"};
    case TibialExit::JointSurface:
      return {Verdict::Wrong, "through the joint surface"};
    case TibialExit::Below:
      break;
  }
  return {Verdict::Wrong, "down the shaft and out of its cut end"};
}

PlanCheck found(const char* name, const Finding& finding, const landmarks::AnatomicalAxes& axes,
                const Eigen::Vector3d& at_mm) {
  return {.verdict = finding.verdict,
          .name = name,
          .text = finding.text,
          .source = seen_along(axes),
          .at_mm = at_mm};
}

// The exit's mouth over a landmark to which something is fixed. That it opens there is a fact; how near is
// too near nobody has said.
PlanCheck check_distance(const char* name, const char* landmark, const char* what,
                         const TunnelGeometry& geometry, const PlanSurroundings& surroundings) {
  const auto at = surroundings.landmarks.find(landmark);
  if (at == surroundings.landmarks.end()) return not_checked(name, std::string("the landmark ") + landmark);
  const double off_mm = (geometry.exit_mm - at->second).norm(), reach_mm = 0.5 * geometry.exit.long_mm;
  PlanCheck check{.verdict = Verdict::Note,
                  .name = name,
                  .text = number_text(off_mm, "mm") + " from the exit",
                  .source = "no published limit; looked at when the exit opens on it",
                  .value = off_mm,
                  .unit = "mm",
                  .least = reach_mm,
                  .at_mm = geometry.exit_mm};
  if (off_mm < reach_mm) {
    check.verdict = Verdict::Look;
    check.text += std::string(": it opens on ") + what;
  }
  return check;
}

}  // namespace

PlanCheck not_checked(const char* name, const std::string& missing) {
  return {.verdict = Verdict::NotChecked, .name = name, .text = "not checked: " + missing + " is missing"};
}

std::string unseen_at_exit(const TunnelGeometry& geometry, const PlanSurroundings& surroundings) {
  return surroundings.unseen.reached(geometry.exit_mm);
}

PlanCheck not_seen(const char* name, const std::string& unseen) {
  return {.verdict = Verdict::NotChecked,
          .name = name,
          .text = "not checked: the tunnel leaves " +
                  (unseen.starts_with("where") ? unseen : "through " + unseen)};
}

PlanCheck not_looked_for() {
  return {.verdict = Verdict::NotChecked,
          .name = "Seen bone",
          .text =
              "not checked: whether the images end within the bone, or a hole of it was filled in, is not "
              "recorded of it; import it again to know"};
}

std::string number_text(double value, const char* unit) { return files::fixed(value, 1) + " " + unit; }

// Without a needless ".0": limits are round numbers mostly.
std::string limit_text(double value, const char* unit) { return files::format("%g %s", value, unit); }

PlanCheck check_entry_place(const Tunnel& tunnel, const TunnelGeometry& geometry,
                            const PlanSurroundings& surroundings) {
  // Seen or not does not hang on the way in: about the entry, as far as the drill reaches.
  if (const std::string unseen = surroundings.unseen.reached(tunnel.entry_mm, tunnel.diameter_mm / 2);
      !unseen.empty())
    return {.verdict = Verdict::Wrong,
            .name = "Entry",
            .text = "it reaches " + unseen + ": nobody has seen bone there",
            .at_mm = geometry.entry.at_mm,
            .rests_on_side = false};
  if (!surroundings.axes) return not_checked("Entry", "the bone's axes");
  const landmarks::AnatomicalAxes& axes = *surroundings.axes;
  if (tunnel.bone == bones::BoneKind::Tibia)
    return found("Entry", say(tibial_entry(geometry.entry, axes, surroundings.extents)), axes,
                 geometry.entry.at_mm);
  if (!surroundings.surface) return not_checked("Entry", "the bone's surface");
  return found("Entry", say(femoral_entry(*surroundings.surface, geometry.entry, axes, surroundings.extents)),
               axes, geometry.entry.at_mm);
}

PlanCheck check_exit_place(const Tunnel& tunnel, const TunnelGeometry& geometry,
                           const PlanSurroundings& surroundings) {
  if (const std::string unseen = unseen_at_exit(geometry, surroundings); !unseen.empty())
    return not_seen("Exit", unseen);
  if (!surroundings.axes) return not_checked("Exit", "the bone's axes");
  const landmarks::AnatomicalAxes& axes = *surroundings.axes;
  if (tunnel.bone == bones::BoneKind::Femur && !surroundings.surface)
    return not_checked("Exit", "the bone's surface");
  const Finding finding = tunnel.bone == bones::BoneKind::Femur
                              ? say(femoral_exit(*surroundings.surface, geometry, axes, surroundings.extents))
                              : say(tibial_exit(geometry, axes));
  return found("Exit", finding, axes, geometry.exit_mm);
}

std::vector<PlanCheck> check_exit_neighbours(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                             const PlanSurroundings& surroundings, const PlanNorms& norms) {
  const bool is_tibia = tunnel.bone == bones::BoneKind::Tibia;
  if (const std::string unseen = unseen_at_exit(geometry, surroundings); !unseen.empty()) {
    if (is_tibia) return {not_seen("Tuberosity", unseen)};
    return {not_seen("Lateral epicondyle", unseen), not_seen("Posterior cortex", unseen)};
  }
  if (is_tibia)
    return {check_distance("Tuberosity", "tuberosity", "the patellar tendon's insertion", geometry,
                           surroundings)};
  std::vector<PlanCheck> checks{check_distance("Lateral epicondyle", "lateral_epicondyle",
                                               "the lateral collateral ligament's origin", geometry,
                                               surroundings)};
  if (!surroundings.axes || !surroundings.surface) {
    checks.push_back(not_checked("Posterior cortex", "the bone's surface or its axes"));
    return checks;
  }
  const auto behind_mm =
      to_posterior_cortex_mm(surroundings.surface->mesh(), geometry.exit_mm, *surroundings.axes);
  if (!behind_mm) {
    checks.push_back(not_checked("Posterior cortex", "bone at the height of the exit"));
    return checks;
  }
  PlanCheck check{.verdict = Verdict::Fine,
                  .name = "Posterior cortex",
                  .text = number_text(*behind_mm, "mm") + " behind the exit",
                  .source = "4.0, 9.7 and 13.2 mm for drilling at 90, 110 and 130 deg of flexion (Basdekis)",
                  .value = *behind_mm,
                  .unit = "mm",
                  .least = norms.near_posterior_cortex_mm,
                  .at_mm = geometry.exit_mm};
  if (*behind_mm < norms.near_posterior_cortex_mm) {
    check.verdict = Verdict::Look;
    check.text += ": less than " + limit_text(norms.near_posterior_cortex_mm, "mm");
  }
  checks.push_back(check);
  return checks;
}

PlanCheck check_mouth(const TunnelGeometry& geometry, const PlanNorms& norms) {
  const TunnelMouth& mouth = geometry.entry;
  PlanCheck check{.verdict = Verdict::Note,
                  .name = "Opening",
                  .text = files::format("%.1f x %.1f mm, %.0f mm2, at %.0f deg to the bone", mouth.long_mm,
                                        mouth.short_mm, mouth.area_mm2, mouth.angle_to_surface_deg),
                  .source = "an ellipse; 9 mm at 40 deg open 14.0 mm and 99 mm2 (Hensler 2011)",
                  .value = mouth.angle_to_surface_deg,
                  .unit = "deg",
                  .least = norms.grazing_mouth_deg,
                  .at_mm = mouth.at_mm};
  if (mouth.angle_to_surface_deg < norms.grazing_mouth_deg) {
    check.verdict = Verdict::Look;
    check.text += ": grazes it";
  }
  return check;
}

std::vector<PlanCheck> check_footprint(const Tunnel& tunnel, const TunnelGeometry& geometry,
                                       const PlanSurroundings& surroundings) {
  std::vector<PlanCheck> checks;
  const auto footprint = surroundings.footprints.find(tunnel.bundle);
  if (footprint != surroundings.footprints.end() && footprint->second.area_mm2 > 0) {
    const FootprintShare share = footprint_share(tunnel, footprint->second);
    checks.push_back(
        {.verdict = Verdict::Note,
         .name = "Footprint opened",
         .text = files::format("%.0f %% of the expected %.0f mm2; %.0f %% of the opening lies in it",
                               100 * share.of_footprint(), share.footprint_mm2, 100 * share.of_opening),
         .source = "no published limit",
         .value = 100 * share.of_footprint(),
         .unit = "%",
         .at_mm = geometry.entry.at_mm});
  } else {
    checks.push_back(not_checked("Footprint opened", "the expected footprint"));
  }
  // The landmark is the middle of the whole ligament.
  if (surroundings.native_footprint_mm && tunnel.bundle == norms::Bundle::Whole) {
    const double off_mm = (geometry.entry_on_surface_mm - *surroundings.native_footprint_mm).norm();
    checks.push_back({.verdict = Verdict::Note,
                      .name = "Footprint",
                      .text = number_text(off_mm, "mm") + " from its centre",
                      .source = "the landmark native_footprint",
                      .value = off_mm,
                      .unit = "mm",
                      .at_mm = surroundings.native_footprint_mm});
  }
  return checks;
}

}  // namespace arthronaut::tunnels
