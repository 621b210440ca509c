#include "app/report/plan_sheet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "app/report/report_content.h"
#include "app/scene/grid_lines.h"
#include "app/scene/lateral_plane.h"
#include "app/scene/plan_picture.h"
#include "app/scene/radiograph.h"
#include "app/scene/reslice.h"
#include "planning/cases/case_image.h"
#include "planning/files/format.h"
#include "planning/files/unit_signs.h"
#include "planning/plan_review/landmark_check.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::report {

namespace {

using bones::BoneKind;
using Eigen::Vector3d;
using tunnels::PlanCheck;

constexpr Ink kGrid{0.80, 0.47, 0.65}, kNorm{0.85, 0.72, 0.10}, kPlan{0.20, 0.62, 0.90},
    kBone{0.85, 0.55, 0.20};
constexpr TextStyle kCaption{.size_pt = 7.5, .ink = kGray};
constexpr double kCheck_pt = 7.5;
constexpr double kAspect = 0.78;  // of the two pictures above the slices

// A plane drawn on the page: its picture's place, and what of it lies where.
struct PlanePicture {
  double x_mm, y_mm, width_mm, height_mm;  // on the page
  scene::SlicePlane plane;
  Eigen::Vector2i size_px;

  [[nodiscard]] Eigen::Vector2d on_page(const Vector3d& point) const {
    const Eigen::Vector2d pixel = plane.pixel_of(point, size_px);
    return {x_mm + (pixel.x() + 0.5) * width_mm / size_px.x(),
            y_mm + (pixel.y() + 0.5) * height_mm / size_px.y()};
  }
  // What of a line on the page lies in the picture (Liang and Barsky 1984, ACM Trans. Graphics 3, 1);
  // nullopt: nothing.
  [[nodiscard]] std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> within(
      const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    const Eigen::Vector2d least(x_mm, y_mm), most(x_mm + width_mm, y_mm + height_mm), way = to - from;
    double enters = 0, leaves = 1;
    for (int axis = 0; axis < 2; ++axis) {
      if (way[axis] == 0) {
        if (from[axis] < least[axis] || from[axis] > most[axis]) return std::nullopt;
        continue;
      }
      const auto [first, last] =
          std::minmax({(least[axis] - from[axis]) / way[axis], (most[axis] - from[axis]) / way[axis]});
      enters = std::max(enters, first);
      leaves = std::min(leaves, last);
    }
    if (!(enters < leaves)) return std::nullopt;
    return std::pair{Eigen::Vector2d(from + enters * way), Eigen::Vector2d(from + leaves * way)};
  }
};

class Sheet {
 public:
  Sheet(PdfDocument& pdf, const SheetFrame& frame, const Content& content, norms::Bundle graft)
      : pdf_(pdf),
        frame_(frame),
        content_(content),
        knee_(content.knee),
        graft_(graft),
        review_(*content.review) {}

  void draw();

 private:
  // The heights of the two pictures above the slices, with their captions; of the lateral one also without
  // its bone.
  double lateral(double x_mm, double y_mm, double width_mm);
  double plateau(double x_mm, double y_mm, double width_mm);
  void slices(double y_mm);
  void slice(const PlanePicture& picture, BoneKind kind, const std::optional<images::Volume>& volume);
  void letters(const PlanePicture& picture);
  // Where it ends, whether it is drawn or not.
  double checks(BoneKind kind, double x_mm, double y_mm, double width_mm, double size_pt, bool is_drawn);
  void put_grey(const PlanePicture& picture, const std::vector<std::uint8_t>& grey);
  // As far as it lies in the picture.
  void line(const PlanePicture& picture, const Vector3d& from, const Vector3d& to, double width_mm,
            const Ink& ink);
  // Every tunnel of the bone.
  void tunnel_outlines(const PlanePicture& picture, BoneKind kind);
  // The bone's tunnel of the graft that the sheet is of; null without one.
  [[nodiscard]] const plan_review::MeasuredTunnel* planned(BoneKind kind) const;
  [[nodiscard]] std::optional<images::Volume> volume() const;
  [[nodiscard]] landmarks::AnatomicalAxes axes(BoneKind kind) const;

  PdfDocument& pdf_;
  SheetFrame frame_;
  const Content& content_;
  const cases::Case& knee_;
  norms::Bundle graft_;
  const plan_review::CaseReview& review_;
};

const plan_review::MeasuredTunnel* Sheet::planned(BoneKind kind) const {
  auto found = review_.tunnels().find({kind, graft_});
  if (found == review_.tunnels().end()) found = review_.tunnels().find(kind);
  return found == review_.tunnels().end() ? nullptr : &found->second;
}

landmarks::AnatomicalAxes Sheet::axes(BoneKind kind) const {
  const auto marks = knee_.landmarks.find(kind);
  return landmarks::anatomical_axes(kind, knee_.side,
                                    marks == knee_.landmarks.end() ? landmarks::Landmarks{} : marks->second,
                                    knee_.bones.at(kind).mesh);
}

// Grey images, not label maps; the newest.
std::optional<images::Volume> Sheet::volume() const {
  const auto grey = std::find_if(knee_.images.rbegin(), knee_.images.rend(),
                                 [](const cases::CaseImage& image) { return !image.is_label_map; });
  if (grey == knee_.images.rend()) return std::nullopt;
  return cases::load_image(content_.folder, *grey);
}

void Sheet::put_grey(const PlanePicture& picture, const std::vector<std::uint8_t>& grey) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * grey.size());
  for (const std::uint8_t value : grey) rgb.insert(rgb.end(), 3, value);
  pdf_.image(picture.x_mm, picture.y_mm, picture.width_mm, rgb, picture.size_px.x(), picture.size_px.y());
}

void Sheet::line(const PlanePicture& picture, const Vector3d& from, const Vector3d& to, double width_mm,
                 const Ink& ink) {
  const auto seen = picture.within(picture.on_page(from), picture.on_page(to));
  if (!seen) return;
  pdf_.line(seen->first.x(), seen->first.y(), seen->second.x(), seen->second.y(), width_mm, ink);
}

double Sheet::lateral(double x_mm, double y_mm, double width_mm) {
  PlanePicture picture{x_mm, y_mm, width_mm, kAspect * width_mm, {}, {760, static_cast<int>(kAspect * 760)}};
  if (!review_.has_bone(BoneKind::Femur)) return picture.height_mm;
  const auto& quadrant = review_.bone(BoneKind::Femur).surroundings.quadrant;
  const geometry::TriangleMesh& mesh = knee_.bones.at(BoneKind::Femur).mesh;
  const landmarks::AnatomicalAxes bone_axes = axes(BoneKind::Femur);
  picture.plane = scene::lateral_plane(
      bone_axes, quadrant, scene::joint_bounds(mesh, BoneKind::Femur, bone_axes), picture.size_px);
  put_grey(picture, scene::radiograph_from(scene::thickness_along(mesh, picture.plane, picture.size_px)));
  const auto marks = knee_.landmarks.find(BoneKind::Femur);
  std::string caption = scene::lateral_plane_in_words(
      bone_axes, quadrant, marks == knee_.landmarks.end() ? landmarks::Landmarks{} : marks->second);
  if (quadrant) {
    const scene::GridLines grid = scene::grid_lines(*quadrant);
    for (const auto& rim : grid.rims) line(picture, rim.front(), rim.back(), 0.35, kGrid);
    for (const auto& division : grid.divisions) line(picture, division.front(), division.back(), 0.15, kGrid);
    const norms::Bundle bundle =
        planned(BoneKind::Femur) != nullptr ? planned(BoneKind::Femur)->tunnel.bundle : norms::Bundle::Whole;
    const scene::NormEllipse norm = scene::norm_ellipse(*quadrant, bundle);
    for (std::size_t i = 0; i < norm.outline_mm.size(); ++i)
      line(picture, norm.outline_mm[i], norm.outline_mm[(i + 1) % norm.outline_mm.size()], 0.3, kNorm);
    caption += ". Yellow: mean and one standard deviation. " + norm.words;
  }
  if (const auto doubt = plan_review::landmark_doubt(review_.landmark_check(BoneKind::Femur)))
    caption += ". Look: " + *doubt;
  tunnel_outlines(picture, BoneKind::Femur);
  if (const auto* femoral = planned(BoneKind::Femur); femoral != nullptr) {
    if (quadrant) {
      const auto percent = quadrant->percent_of(tunnels::entry_on_bone(femoral->tunnel, femoral->geometry));
      caption += files::format(". Entry at %.1f %% deep to shallow, %.1f %% high to low",
                               percent.deep_shallow, percent.high_low);
    }
  }
  return pdf_.paragraph(x_mm, y_mm + picture.height_mm + 3.5, width_mm, caption, kCaption) - y_mm;
}

double Sheet::plateau(double x_mm, double y_mm, double width_mm) {
  if (!review_.has_bone(BoneKind::Tibia)) return 0;
  scene::PictureRequest request;
  request.knee = &knee_;
  request.view = scene::ViewDirection::Plateau;
  request.width = static_cast<int>(frame_.picture_px_per_mm * width_mm);
  request.height = static_cast<int>(frame_.picture_px_per_mm * kAspect * width_mm);
  request.light_background = true;
  const auto picture = scene::render_plan_picture(request);
  const double height = pdf_.image(x_mm, y_mm, width_mm, picture.rgb, picture.width, picture.height);
  std::string caption = "The tibial plateau from above";
  const auto* tibial = planned(BoneKind::Tibia);
  if (const auto doubt = plan_review::landmark_doubt(review_.landmark_check(BoneKind::Tibia)))
    caption += ". Look: " + *doubt;
  if (const auto& grid = review_.bone(BoneKind::Tibia).surroundings.plateau; grid && tibial != nullptr) {
    const auto percent = grid->percent_of(tunnels::entry_on_bone(tibial->tunnel, tibial->geometry));
    caption += files::format(". Entry at %.1f %% from anterior, %.1f %% from medial",
                             percent.anterior_posterior, percent.medial_lateral);
  }
  return pdf_.paragraph(x_mm, y_mm + height + 3.5, width_mm, caption, kCaption) - y_mm;
}

// A tunnel's two sides, its mouth and its end, as they lie in the picture's plane; thin what is not the
// sheet's.
void Sheet::tunnel_outlines(const PlanePicture& picture, BoneKind kind) {
  for (const auto& [key, planned_tunnel] : review_.tunnels()) {
    if (key.bone != kind) continue;
    const auto& [tunnel, geometry] = planned_tunnel;
    const Vector3d side =
        tunnel.diameter_mm / 2 * tunnel.direction.cross(picture.plane.normal()).normalized();
    const double length_mm = geometry.enters_bone ? geometry.length_mm : 30;
    const Vector3d from = tunnels::entry_on_bone(tunnel, geometry), to = from + length_mm * tunnel.direction;
    const double width = &planned_tunnel == planned(kind) ? 0.4 : 0.15;
    line(picture, from + side, to + side, width, kPlan);
    line(picture, from - side, to - side, width, kPlan);
    line(picture, from + side, from - side, width, kPlan);
    line(picture, to + side, to - side, width, kPlan);
  }
}

void Sheet::slice(const PlanePicture& picture, BoneKind kind, const std::optional<images::Volume>& volume) {
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(picture.size_px.prod()), 255);
  if (volume) {
    scene::reslice(
        *volume, picture.plane, picture.size_px,
        volume->modality == images::Modality::Ct ? scene::kBoneWindow : scene::automatic_window(*volume),
        grey);
  }
  put_grey(picture, grey);
  for (const auto& [from, to] :
       scene::outline_of(knee_.bones.at(kind).mesh, picture.plane.center_mm, picture.plane.normal()))
    line(picture, from, to, 0.2, volume ? kBone : kBlack);
  tunnel_outlines(picture, kind);
  letters(picture);
}

// Which side of the patient each border is of.
void Sheet::letters(const PlanePicture& picture) {
  constexpr double kIn_mm = 1, kLine_mm = 2.6;
  const TextStyle style{.size_pt = 7.5, .ink = kPlan};
  const double middle_x = picture.x_mm + picture.width_mm / 2,
               middle_y = picture.y_mm + picture.height_mm / 2;
  const Vector3d &right = picture.plane.right, &down = picture.plane.down;
  const auto put = [&](double x_mm, double y_mm, const Vector3d& side, double share_left) {
    const std::string text = scene::orientation_letters(side);
    pdf_.text(x_mm - share_left * pdf_.text_width_mm(text, style), y_mm, text, style);
  };
  put(picture.x_mm + kIn_mm, middle_y, -right, 0);
  put(picture.x_mm + picture.width_mm - kIn_mm, middle_y, right, 1);
  put(middle_x, picture.y_mm + kLine_mm, -down, 0.5);
  put(middle_x, picture.y_mm + picture.height_mm - kIn_mm, down, 0.5);
}

// Two planes through each axis: one as upright as it can stand, one square to it.
void Sheet::slices(double y_mm) {
  constexpr int kCount = 4;
  constexpr double kGap_mm = 3, kShown_mm = 70;
  const double width_mm = (frame_.width_mm - (kCount - 1) * kGap_mm) / kCount;
  const auto volume = this->volume();
  double x_mm = frame_.left_mm;
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    const auto* of_graft = planned(kind);
    for (const bool is_upright : {true, false}) {
      if (of_graft != nullptr) {
        const Vector3d direction = of_graft->tunnel.direction.normalized();
        PlanePicture picture{x_mm, y_mm, width_mm, width_mm, {}, {320, 320}};
        const Vector3d up = axes(kind).proximal;
        Vector3d across = direction.cross(up);
        across = across.norm() > 0.1 ? across.normalized() : direction.unitOrthogonal();
        const Vector3d in_plane = is_upright ? across.cross(direction) : across;
        // Up on the page is up in the bone, as far as the plane allows.
        const Vector3d normal = direction.cross(in_plane);
        Vector3d page_up = up - up.dot(normal) * normal;
        page_up = page_up.norm() > 0.1 ? page_up.normalized() : direction;
        picture.plane = {of_graft->tunnel.entry_mm + 0.3 * kShown_mm * direction,
                         (-page_up).cross(normal).normalized(), -page_up, kShown_mm / picture.size_px.x()};
        slice(picture, kind, volume);
        pdf_.text(x_mm, y_mm + width_mm + 3.5,
                  tunnels::name_of(of_graft->tunnel.key()) +
                      (is_upright ? ", along it, 70 mm" : ", turned by 90\u00B0"),
                  kCaption);
      }
      x_mm += width_mm + kGap_mm;
    }
  }
}

double Sheet::checks(BoneKind kind, double x_mm, double y_mm, double width_mm, double size_pt,
                     bool is_drawn) {
  const double word_mm = 17 * size_pt / kCheck_pt, gap_mm = 1.1 * size_pt / kCheck_pt;
  const auto* of_graft = planned(kind);
  if (is_drawn)
    pdf_.text(x_mm, y_mm,
              "Checks of the " + (of_graft != nullptr ? tunnels::name_of(of_graft->tunnel.key())
                                                      : std::string(bones::to_text(kind))),
              {.size_pt = 9, .bold = true});
  y_mm += 4;
  const auto row = [&](std::string_view verdict, bool is_amiss, const std::string& text) {
    if (is_drawn) {
      pdf_.text(x_mm, y_mm, verdict,
                {.size_pt = size_pt, .bold = is_amiss, .ink = is_amiss ? kWarning : kGray});
      pdf_.paragraph(x_mm + word_mm, y_mm, width_mm - word_mm, text, {.size_pt = size_pt});
    }
    y_mm += pdf_.paragraph_height_mm(width_mm - word_mm, text, {.size_pt = size_pt}) + gap_mm;
  };
  const std::string side = plan_review::side_doubt(content_.bone_doubts);
  if (!side.empty()) row("wrong", true, "Side: " + side);
  if (const std::string note = plan_review::side_note(content_.bone_doubts); !note.empty())
    row("note", false, "Side: " + note);
  for (const std::string& doubt : plan_review::doubts_but_side(content_.bone_doubts, kind))
    row("look", true, "Bone: " + doubt);
  if (const std::string doubt = grid_doubt(content_, kind); !doubt.empty())
    row("look", true, "Grid: " + doubt);
  if (of_graft == nullptr) {
    if (is_drawn)
      pdf_.text(x_mm, y_mm, review_.has_bone(kind) ? "No tunnel is planned." : "The case has no such bone.",
                kCaption);
    return y_mm;
  }
  for (const PlanCheck& check : review_.checks(of_graft->tunnel.key())) {
    const bool is_amiss =
        check.verdict == PlanCheck::Verdict::Look || check.verdict == PlanCheck::Verdict::Wrong;
    const std::string source = is_amiss && !check.source.empty() ? " [" + check.source + "]" : "";
    row(to_text(check.verdict), is_amiss, files::with_signs(check.name + ": " + check.text + source));
  }
  return y_mm;
}

void Sheet::draw() {
  const double half_mm = (frame_.width_mm - 6) / 2, right_mm = frame_.left_mm + half_mm + 6;
  double y_mm = frame_.top_mm;
  const double plateau_mm = plateau(right_mm, y_mm, half_mm);
  y_mm += std::max(lateral(frame_.left_mm, y_mm, half_mm), plateau_mm) + 3;
  slices(y_mm);
  y_mm += (frame_.width_mm - 9) / 4 + 11;
  constexpr double kLeast_pt = 5;
  double size_pt = kCheck_pt;
  const auto lowest = [&] {
    return std::max(checks(BoneKind::Femur, frame_.left_mm, y_mm, half_mm, size_pt, false),
                    checks(BoneKind::Tibia, right_mm, y_mm, half_mm, size_pt, false));
  };
  while (size_pt > kLeast_pt && lowest() > frame_.bottom_mm) size_pt -= 0.25;
  checks(BoneKind::Femur, frame_.left_mm, y_mm, half_mm, size_pt, true);
  checks(BoneKind::Tibia, right_mm, y_mm, half_mm, size_pt, true);
}

}  // namespace

std::vector<norms::Bundle> planned_grafts(const cases::Plan& plan) {
  std::set<norms::Bundle> grafts;
  for (const auto& [key, tunnel] : plan.tunnels) grafts.insert(key.bundle);
  // A single tunnel beside bundles of the other bone stands on their sheets.
  if (grafts.size() > 1) grafts.erase(norms::Bundle::Whole);
  return {grafts.begin(), grafts.end()};
}

void draw_plan_sheet(PdfDocument& pdf, const SheetFrame& frame, const Content& content, norms::Bundle graft) {
  Sheet(pdf, frame, content, graft).draw();
}

}  // namespace arthronaut::report
