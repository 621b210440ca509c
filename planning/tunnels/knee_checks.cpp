#include "planning/tunnels/knee_checks.h"

#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/graft/graft_course.h"
#include "planning/graft/roof_clearance.h"
#include "planning/tunnels/isometry_map.h"
#include "planning/tunnels/knee_pose.h"
#include "planning/tunnels/place_checks.h"
#include "planning/tunnels/tunnel_pair.h"

namespace arthronaut::tunnels {

namespace {

using Verdict = PlanCheck::Verdict;

// Cone 2019 (10.2106/JBJS.RVW.18.00145), 92 articles: the means of adults' ligaments are 26 to 38 mm, by
// whatever they were measured. The longest later one is 40.6 +- 3.6 mm (PMC7120849).
constexpr double kShortGraft_mm = 26, kLongGraft_mm = 44.2;
// A choice: grafts are measured in steps of half a millimetre.
constexpr double kDiametersApart_mm = 0.5;
// A choice, some 1.5 sigma of what the axes of both bones tell of the flexion: up to here a knee was imaged
// in extension.
constexpr double kStillExtended_deg = 10;

std::string name_of(const char* tunnel, const KneePlan& plan) {
  const norms::Bundle graft = plan.graft;
  if (graft == norms::Bundle::Whole && plan.has_other_tunnels)
    return std::string(tunnel) + ", as one of two bundles is planned there,";
  return tunnel + std::string(graft == norms::Bundle::Whole          ? ""
                              : graft == norms::Bundle::Anteromedial ? " of the AM graft"
                                                                     : " of the PL graft");
}

bool is_there(const Tunnel* tunnel, const TunnelGeometry* measured) {
  return tunnel && measured && measured->enters_bone;
}

// Empty when it is there; when both are.
std::string missing_tibial_tunnel(const KneePlan& plan) {
  return is_there(plan.tibial, plan.tibial_measured) ? "" : name_of("the tibial tunnel", plan);
}
std::string missing_tunnel(const KneePlan& plan) {
  if (!is_there(plan.femoral, plan.femoral_measured)) return name_of("the femoral tunnel", plan);
  return missing_tibial_tunnel(plan);
}

graft::GraftEnd end_of(const Tunnel& tunnel, const TunnelGeometry& measured) {
  return {measured.entry_on_surface_mm, tunnel.direction};
}

// Else it leaves where the images end, and is longer than it was measured.
bool leaves_bone(bones::BoneKind bone, const TunnelGeometry& measured, const KneeSurroundings& knee) {
  const auto cuts = knee.image_cuts.find(bone);
  return cuts == knee.image_cuts.end() || !bones::images_end_at(cuts->second, measured.exit_mm);
}

// Studies measure the ligament, each in its way and in a knee as it lay: what no mean of theirs comes near is
// to be looked at, and only of a graft in place of the whole ligament.
PlanCheck check_graft_length(const KneePlan& plan, const KneeSurroundings& knee) {
  const double in_joint_mm =
      (plan.femoral_measured->entry_on_surface_mm - plan.tibial_measured->entry_on_surface_mm).norm();
  const double all_mm = in_joint_mm + plan.femoral_measured->length_mm + plan.tibial_measured->length_mm;
  const bool is_all_seen = leaves_bone(bones::BoneKind::Femur, *plan.femoral_measured, knee) &&
                           leaves_bone(bones::BoneKind::Tibia, *plan.tibial_measured, knee);
  const char* const at_least = is_all_seen ? "" : "at least ";
  PlanCheck check{.verdict = Verdict::Note,
                  .name = "Graft length",
                  .text = number_text(in_joint_mm, "mm") + " in the joint, " + at_least +
                          number_text(all_mm, "mm") + " in all",
                  .source = "as imaged, straight between the openings; ",
                  .value = in_joint_mm,
                  .unit = "mm"};
  if (plan.graft != norms::Bundle::Whole) {
    check.source += "of one of two bundles: no published limit";
    return check;
  }
  check.source +=
      "the means of studies of the ligament are 26 to 38 mm (Cone 2019, 92 articles), along it in sagittal "
      "MR "
      "images 40.6 +- 3.6 mm (PMC7120849)";
  check.least = kShortGraft_mm;
  check.greatest = kLongGraft_mm;
  const bool is_short = in_joint_mm<kShortGraft_mm, is_long = in_joint_mm> kLongGraft_mm;
  check.verdict = is_short || is_long ? Verdict::Look : Verdict::Fine;
  if (is_short) check.text += ": shorter in the joint than " + limit_text(kShortGraft_mm, "mm");
  if (is_long) check.text += ": longer in the joint than " + limit_text(kLongGraft_mm, "mm");
  return check;
}

// One graft through two tunnels of other widths is loose in the wider one. nullopt: they are alike.
std::optional<PlanCheck> check_graft_diameters(const KneePlan& plan) {
  const double apart_mm = std::abs(plan.femoral->diameter_mm - plan.tibial->diameter_mm);
  if (apart_mm < 0.05) return std::nullopt;  // as they are said
  PlanCheck check{.verdict = Verdict::Note,
                  .name = "Graft diameter",
                  .text = "femur " + number_text(plan.femoral->diameter_mm, "mm") + ", tibia " +
                          number_text(plan.tibial->diameter_mm, "mm") + ", " + number_text(apart_mm, "mm") +
                          " apart",
                  .source =
                      "one graft; the means of studies are 8.2 mm in the femur and 8.4 mm in the tibia "
                      "(PMC6024536), " +
                      limit_text(kDiametersApart_mm, "mm") + " by choice",
                  .value = apart_mm,
                  .unit = "mm",
                  .greatest = kDiametersApart_mm};
  if (apart_mm > kDiametersApart_mm + 1e-9) {
    check.verdict = Verdict::Look;
    check.text += ": one graft is seldom of two widths";
  }
  return check;
}

std::optional<graft::GraftCourse> course_of_insertions(norms::Bundle graft,
                                                       const KneeSurroundings& surroundings) {
  const auto& known = surroundings.insertions_mm;
  const auto femoral = known.find({bones::BoneKind::Femur, graft});
  const auto tibial = known.find({bones::BoneKind::Tibia, graft});
  if (femoral == known.end() || tibial == known.end()) return std::nullopt;
  return graft::graft_course({femoral->second}, {tibial->second}, *surroundings.axis);
}

PlanCheck check_length_change(const graft::GraftCourse& course,
                              const std::optional<graft::GraftCourse>& of_insertions,
                              const graft::FlexionAxis& axis, const PlanNorms& norms) {
  PlanCheck check{.verdict = Verdict::Fine,
                  .name = "Length over flexion",
                  .text = to_text(LengthChange{course.change_mm(), course.longest_at_deg}),
                  .source = "the tibia turned about " + std::string(graft::to_text(axis.origin)) +
                            ", no roll-back; up to 2 to 3 mm is customary",
                  .value = course.change_mm(),
                  .unit = "mm",
                  .greatest = norms.isometric_change_mm};
  if (course.change_mm() <= norms.isometric_change_mm) return check;
  check.verdict = Verdict::Look;
  check.text += ": more than the customary " + limit_text(norms.isometric_change_mm, "mm");
  if (!of_insertions) return check;
  check.text +=
      "; between the insertions' middles in the same hinge " + number_text(of_insertions->change_mm(), "mm");
  // What the knee's own ligament does not keep in this model says nothing about a plan.
  if (of_insertions->change_mm() > norms.isometric_change_mm) check.verdict = Verdict::Note;
  return check;
}

PlanCheck check_against_insertions(const graft::GraftCourse& course,
                                   const std::optional<graft::GraftCourse>& of_insertions,
                                   const KneePlan& plan, const KneeSurroundings& surroundings,
                                   const PlanNorms& norms) {
  const char* name = "Against the insertions";
  if (!of_insertions) {
    std::string missing;
    for (const bones::BoneKind bone : {bones::BoneKind::Femur, bones::BoneKind::Tibia})
      if (!surroundings.insertions_mm.contains({bone, plan.graft}))
        missing += (missing.empty() ? "the grid of the " : " and that of the ") +
                   std::string(bones::to_text(bone)) + ", from its landmarks,";
    return not_checked(name, missing);
  }
  double most_mm = 0, most_at_deg = 0;  // longer than between the insertions
  for (std::size_t i = 0; i < course.states.size(); ++i) {
    const double longer_mm = course.states[i].length_mm - course.states.front().length_mm -
                             (of_insertions->states[i].length_mm - of_insertions->states.front().length_mm);
    if (std::abs(longer_mm) <= std::abs(most_mm)) continue;
    most_mm = longer_mm;
    most_at_deg = course.states[i].flexion_deg;
  }
  PlanCheck check{
      .verdict = Verdict::Fine,
      .name = name,
      .text = std::abs(most_mm) < 0.05
                  ? "the same within 0.1 mm"
                  : "up to " + number_text(std::abs(most_mm), "mm") +
                        (most_mm < 0 ? " slacker, at " : " tighter, at ") + number_text(most_at_deg, "deg"),
      .source =
          "how its length changes from extension on, beside a graft between the insertions' middles in "
          "the same model; 3 mm is the custom for a change, taken for this difference by choice",
      .value = std::abs(most_mm),
      .unit = "mm",
      .greatest = norms.isometric_change_mm};
  if (std::abs(most_mm) > norms.isometric_change_mm) {
    check.verdict = Verdict::Look;
    check.text += ": more than " + limit_text(norms.isometric_change_mm, "mm");
  }
  return check;
}

PlanCheck note_bend(const char* name, double extended_deg, double greatest_deg) {
  return {.verdict = Verdict::Note,
          .name = name,
          .text = number_text(extended_deg, "deg") + " extended, " + number_text(greatest_deg, "deg") +
                  " at most",
          .source =
              "between tunnel and graft; 65 to 85 deg at the femur for drilling at 100 to 130 deg of flexion "
              "(2643247); no accepted limit",
          .value = greatest_deg,
          .unit = "deg"};
}

// By the long axes of both bones, in the femur's lateral view; nullopt where either is the scanner's. Told by
// the joint's ends alone it is good to some 7 degrees.
std::optional<double> imaged_flexion_deg(const KneeSurroundings& surroundings) {
  using Origin = landmarks::AnatomicalAxes::Origin;
  const auto& femur = surroundings.femur_axes;
  const auto& tibia = surroundings.tibia_axes;
  if (!femur || !tibia || femur->origin == Origin::FromScanner) return std::nullopt;
  return geometry::deg_from_rad(
      std::atan2(tibia->proximal.dot(femur->anterior), tibia->proximal.dot(femur->proximal)));
}

PlanCheck check_roof(const KneePlan& plan, const KneeSurroundings& surroundings, const PlanNorms& norms) {
  if (const std::string missing = missing_tibial_tunnel(plan); !missing.empty())
    return not_checked("Roof", missing);
  const auto& marks = surroundings.femur_landmarks;
  const auto anterior = marks.find("blumensaat_anterior"), posterior = marks.find("blumensaat_posterior");
  if (anterior == marks.end() || posterior == marks.end() || !surroundings.femur_axes)
    return not_checked("Roof",
                       "Blumensaat's line, blumensaat_anterior and blumensaat_posterior of the femur,");
  const auto clearance =
      graft::roof_clearance({.tibial_opening_mm = plan.tibial_measured->entry_on_surface_mm,
                             .into_tibia = plan.tibial->direction,
                             .diameter_mm = plan.tibial->diameter_mm,
                             .blumensaat_anterior_mm = anterior->second,
                             .blumensaat_posterior_mm = posterior->second,
                             .femur_axes = *surroundings.femur_axes});
  if (!clearance) return not_checked("Roof", "a Blumensaat's line that the lateral view shows");
  const double least_mm = std::min(clearance->outlet_mm, clearance->opening_mm);
  const auto flexed_deg = imaged_flexion_deg(surroundings);
  const bool is_flexed = flexed_deg && *flexed_deg > kStillExtended_deg;
  PlanCheck check{
      .verdict = Verdict::Fine,
      .name = "Roof",
      .text = number_text(least_mm, "mm") + " between roof and graft",
      .source = "the tibial tunnel prolonged, against Blumensaat's line, as imaged, " +
                (!flexed_deg ? "which is taken for extension: how far it was flexed is not known"
                 : is_flexed ? "flexed by about " + limit_text(std::round(*flexed_deg), "deg") +
                                   " by the axes of both bones; the roof comes nearer as the knee is extended"
                             : "which is taken for extension: by the axes of both bones it is within " +
                                   limit_text(kStillExtended_deg, "deg") + " of it") +
                "; the opening behind the roof's slope (Howell 1995)",
      .value = least_mm,
      .unit = "mm",
      .least = norms.least_roof_clearance_mm,
      .at_mm = anterior->second};
  if (is_flexed)
    check.text += ", as imaged: flexed by about " + limit_text(std::round(*flexed_deg), "deg");
  else
    check.text += " in extension";
  if (least_mm < norms.least_roof_clearance_mm) {
    check.verdict = Verdict::Look;
    check.text += is_flexed ? ", and the roof presses on it already" : ": the roof presses on it";
  } else if (is_flexed) {
    check.verdict = Verdict::Note;
    check.text += ", so it is not judged";
    check.least.reset();
  }
  return check;
}

// Of a graft between two frames no length, no angle and no clearance is one of this knee.
std::vector<PlanCheck> none_checked(bool is_femur, const char* bend, const std::string& why) {
  std::vector<PlanCheck> checks;
  for (const char* name :
       is_femur ? std::vector{"Graft length", "Length over flexion", "Against the insertions", bend}
                : std::vector{"Roof", bend})
    checks.push_back({.verdict = Verdict::NotChecked,
                      .name = name,
                      .text = "not checked: femur and tibia do not lie in one frame",
                      .source = why});
  return checks;
}

}  // namespace

void put_femur(KneeSurroundings& knee, const geometry::TriangleMesh& femur,
               const PlanSurroundings& of_femur) {
  knee.femur_axes = of_femur.axes;
  knee.femur_landmarks = of_femur.landmarks;
  knee.image_cuts[bones::BoneKind::Femur] = of_femur.unseen.image_cuts;
  knee.axis = of_femur.axes ? graft::flexion_axis(of_femur.landmarks, femur, *of_femur.axes) : std::nullopt;
}

void put_tibia(KneeSurroundings& knee, const PlanSurroundings& of_tibia) {
  using Origin = landmarks::AnatomicalAxes::Origin;
  knee.image_cuts[bones::BoneKind::Tibia] = of_tibia.unseen.image_cuts;
  knee.plateau_middle_mm.reset();
  knee.tibia_axes.reset();
  if (!of_tibia.axes) return;
  const landmarks::AnatomicalAxes& axes = *of_tibia.axes;
  if (axes.origin == Origin::FromLandmarks) knee.tibia_axes = axes;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int known = 0;
  for (const char* edge : {"plateau_medial", "plateau_lateral", "plateau_anterior", "plateau_posterior"}) {
    const auto found = of_tibia.landmarks.find(edge);
    if (found == of_tibia.landmarks.end()) continue;
    sum += found->second;
    ++known;
  }
  const BoneExtents& extents = of_tibia.extents;
  if (known == 4) {
    knee.plateau_middle_mm = sum / 4;
  } else if (extents.width_mm() > 0) {
    knee.plateau_middle_mm = extents.highest_mm * axes.proximal +
                             0.5 * (extents.medial_mm + extents.lateral_mm) * axes.lateral +
                             0.5 * (extents.posterior_mm + extents.anterior_mm) * axes.anterior;
  }
}

std::vector<PlanCheck> check_knee(bones::BoneKind bone, const KneePlan& plan,
                                  const KneeSurroundings& surroundings, const PlanNorms& norms) {
  const bool is_femur = bone == bones::BoneKind::Femur;
  const char* bend = is_femur ? "Bend at the femur" : "Bend at the tibia";
  if (const std::string why = why_apart(surroundings); !why.empty()) return none_checked(is_femur, bend, why);
  const std::string missing = missing_tunnel(plan);
  std::vector<PlanCheck> checks;
  if (!is_femur) checks.push_back(check_roof(plan, surroundings, norms));
  if (!missing.empty()) {
    if (is_femur)
      checks = {not_checked("Graft length", missing), not_checked("Length over flexion", missing),
                not_checked("Against the insertions", missing)};
    checks.push_back(not_checked(bend, missing));
    return checks;
  }
  if (is_femur) checks.push_back(check_graft_length(plan, surroundings));
  if (auto diameters = check_graft_diameters(plan)) checks.push_back(*std::move(diameters));
  if (!surroundings.axis) {
    const char* needed = "the flexion axis: two condyles' centres, their posterior points or the epicondyles";
    if (is_femur)
      for (const char* name : {"Length over flexion", "Against the insertions"})
        checks.push_back(not_checked(name, needed));
    checks.push_back(not_checked(bend, needed));
    return checks;
  }
  const graft::GraftCourse course =
      graft::graft_course(end_of(*plan.femoral, *plan.femoral_measured),
                          end_of(*plan.tibial, *plan.tibial_measured), *surroundings.axis);
  const graft::GraftState& extended = course.states.front();
  if (is_femur) {
    const auto of_insertions = course_of_insertions(plan.graft, surroundings);
    checks.push_back(check_length_change(course, of_insertions, *surroundings.axis, norms));
    checks.push_back(check_against_insertions(course, of_insertions, plan, surroundings, norms));
    checks.push_back(note_bend(bend, extended.femoral_bend_deg, course.greatest_femoral_bend_deg));
  } else {
    checks.push_back(note_bend(bend, extended.tibial_bend_deg, course.greatest_tibial_bend_deg));
  }
  return checks;
}

PlanCheck check_pair(const Tunnel& first, const TunnelGeometry& first_measured, const Tunnel& second,
                     const TunnelGeometry& second_measured, const PlanNorms& norms) {
  const TunnelGap gap = gap_between(first, first_measured, second, second_measured);
  PlanCheck check{.verdict = Verdict::Fine,
                  .name = "Between the tunnels",
                  .text = number_text(gap.bone_mm, "mm") + " of bone",
                  .source = limit_text(norms.thin_bone_between_tunnels_mm, "mm") + " is customary",
                  .value = gap.bone_mm,
                  .unit = "mm",
                  .least = norms.thin_bone_between_tunnels_mm,
                  .at_mm = gap.at_mm,
                  .rests_on_side = false};
  if (gap.bone_mm <= 0) {
    check.verdict = Verdict::Wrong;
    check.text = "they run into each other";
  } else if (gap.bone_mm < norms.thin_bone_between_tunnels_mm) {
    check.verdict = Verdict::Look;
    check.text += ": less than " + limit_text(norms.thin_bone_between_tunnels_mm, "mm");
  }
  return check;
}

}  // namespace arthronaut::tunnels
