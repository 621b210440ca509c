#include "navigation/simulator/staging.h"

#include <algorithm>
#include <cmath>

#include "navigation/simulator/holding.h"
#include "navigation/simulator/instruments.h"
#include "navigation/simulator/random.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kMinSidePx = 80;  // of a marker's black square
constexpr double kMinTiltDeg = 8, kMaxTiltDeg = 52;
constexpr double kViewShare = 0.93;    // of the view's radius that markers keep within
constexpr double kMinClearanceMm = 5;  // of the lens from the bone

class Stage {
 public:
  Stage(const SimulationOptions& options, const geometry::Surface& bone)
      : options_(options),
        bone_(bone),
        camera_(options.camera, 0, options.refractive_index),
        probe_(probe_of(options.tools)),
        guide_(guide_of(options)),
        world_(world_marker_of(options)),
        random_(options.seed * 7919 + 17) {
    const double lateral_x = options.knee.side == bones::Side::Right ? -1 : 1;
    lateral_ = {lateral_x, 0, 0};
    const Vector3d direction = options.plan.direction.normalized();
    guide_marker_mm_ = options.plan.entry_mm - (guide_.axis->point_mm.norm() - 1) * direction;
  }

  Staging find() {
    // Most places for the world marker fail one of the phases at once: many are tried.
    for (int attempt = 0; attempt < 1500; ++attempt) {
      Staging staging;
      searches_widely_ = attempt % 3 == 2;
      if (place_world_marker(staging) && stage_drill(staging) && (!pivots() || stage_pivot(staging)) &&
          stage_scratch(staging)) {
        return staging;
      }
    }
    throw InvalidInput(
        "simulator: the arthroscope finds no place from which markers and planned entry can be seen");
  }

 private:
  // Above the flat plateau the world marker lies as deep as any tip, and what is near enough to see it is too
  // near for the swing of a probe.
  bool pivots() const { return options_.bone == bones::BoneKind::Femur; }

  Vector3d anatomical(double lateral, double anterior, double superior) const {
    // The tibia is looked at from above, the femur from below.
    const double up = options_.bone == bones::BoneKind::Femur ? superior : -superior;
    return lateral * lateral_ + Vector3d(0, -anterior, up);
  }

  bool place_world_marker(Staging& staging) {
    const Vector3d near =
        options_.plan.entry_mm +
        (searches_widely_
             ? anatomical(random_.between(-8, 6), random_.between(-8, 14), random_.between(-22, 0))
             : anatomical(random_.between(-2, 5), random_.between(-5, 2), random_.between(-23, -18)));
    const geometry::SurfacePoint spot = bone_.closest_point(near);
    // Near enough to where the guide's marker will be to be seen with it.
    if ((spot.point_mm - guide_marker_mm_).norm() > 24) return false;
    // Where the scope will roughly be.
    const Vector3d viewer = options_.plan.entry_mm + anatomical(-14, 8, -34);
    const Vector3d to_viewer = (viewer - spot.point_mm).normalized();
    if (spot.normal.dot(to_viewer) < std::cos(geometry::rad_from_deg(75))) return false;
    const Vector3d normal = turned_towards(spot.normal, to_viewer, geometry::rad_from_deg(30));
    const Vector3d y = Eigen::AngleAxisd(random_.between(-0.6, 0.6), normal) * anatomical(0, 1, 0.3);
    staging.bone_from_world_marker =
        marker_facing(spot.point_mm + random_.between(1.6, 3.2) * spot.normal, normal, y);
    // The whole face is above the bone.
    for (const double sx : {-1.0, 0.0, 1.0}) {
      for (const double sy : {-1.0, 0.0, 1.0}) {
        const double reach = 0.6 * world_.size_mm;
        const Vector3d corner = staging.bone_from_world_marker * Vector3d(sx * reach, sy * reach, 0);
        if (bone_.signed_distance_mm(corner) < 0.2) return false;
      }
    }
    return true;
  }

  // A lens position that sees the world marker well, looking between it and `other`. usual: from the world
  // marker to the lens in most knees.
  std::optional<RigidTransform> random_view(const Staging& staging, const Vector3d& other,
                                            const Vector3d& usual, double min_back, double max_back) {
    const RigidTransform& world = staging.bone_from_world_marker;
    const double back = random_.between(min_back, max_back);
    const Vector3d jitter(random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1));
    const Vector3d direction = searches_widely_ ? world.rotate(Vector3d::UnitZ()) + 0.6 * jitter
                                                : usual.normalized() + 0.35 * jitter;
    const Vector3d eye = world.translation_mm + back * direction.normalized();
    if (bone_.signed_distance_mm(eye) < kMinClearanceMm) return std::nullopt;
    const double share = random_.between(0.35, 0.65);
    const Vector3d forward =
        share * (world.translation_mm - eye).normalized() + (1 - share) * (other - eye).normalized();
    const RigidTransform view = bone_from_camera(eye, forward, anatomical(0, 1, random_.between(0, 0.6)));
    Solids solids;
    add_world_marker(world_, view.inverse() * world, solids);
    if (!sees(view, world, world_.size_mm, solids, 0, true)) return std::nullopt;
    return view;
  }

  // The marker's square, with a margin, is inside the view, large, not too oblique and hidden by nothing.
  bool sees(const RigidTransform& bone_from_view, const RigidTransform& bone_from_marker, double size_mm,
            const Solids& solids, std::size_t own, bool bone_hides) const {
    const RigidTransform camera_from_marker = bone_from_view.inverse() * bone_from_marker;
    const Vector3d& center = camera_from_marker.translation_mm;
    if (center.z() < 6) return false;
    const double tilt_deg = geometry::deg_from_rad(
        geometry::angle_between_rad(camera_from_marker.rotate(Vector3d::UnitZ()), -center));
    if (tilt_deg < kMinTiltDeg || tilt_deg > kMaxTiltDeg) return false;
    std::array<Eigen::Vector2d, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3d corner(i == 0 || i == 3 ? -1 : 1, i < 2 ? 1 : -1, 0);
      const Vector3d in_camera = camera_from_marker * (0.62 * size_mm * corner);
      const auto pixel = camera_.project(in_camera);
      if (!pixel || !camera_.is_inside_view(*pixel)) return false;
      const camera::Boundary& boundary = camera_.boundary();
      if ((*pixel - boundary.center_px).norm() > kViewShare * boundary.radius_px) return false;
      corners[i] = *pixel;
      if (is_hidden(in_camera, solids, own)) return false;
      if (bone_hides && is_behind_bone(bone_from_view, bone_from_marker * (0.5 * size_mm * corner)))
        return false;
    }
    if (is_hidden(center, solids, own)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      if ((corners[i] - corners[(i + 1) % 4]).norm() < 1.24 * kMinSidePx) return false;
    }
    return true;
  }

  static bool is_hidden(const Vector3d& in_camera, const Solids& solids, std::size_t own) {
    for (std::size_t i = 0; i < solids.size(); ++i) {
      SolidHit hit;
      if (i != own && solids[i]->hit(in_camera / in_camera.z(), hit) && hit.depth_mm < in_camera.z())
        return true;
    }
    return false;
  }

  bool is_behind_bone(const RigidTransform& bone_from_view, const Vector3d& point) const {
    const Vector3d eye = bone_from_view.translation_mm;
    const auto hit = bone_.first_hit(eye, point - eye);
    return hit && hit->distance_mm < (point - eye).norm() - 0.1;
  }

  // World marker and tool marker both seen with the tool held so.
  bool sees_both(const Staging& staging, const RigidTransform& view, const tools::Tool& tool,
                 const RigidTransform& bone_from_tool) const {
    const RigidTransform camera_from_bone = view.inverse();
    Solids solids;
    add_world_marker(world_, camera_from_bone * staging.bone_from_world_marker, solids);
    add_tool(tool, camera_from_bone * bone_from_tool, solids);
    return sees(view, bone_from_tool, tool.size_mm, solids, 1, false) &&
           sees(view, staging.bone_from_world_marker, world_.size_mm, solids, 0, false);
  }

  bool stage_drill(Staging& staging) {
    const tunnels::Tunnel& plan = options_.plan;
    const Vector3d direction = plan.direction.normalized();
    // How far off the guide is when its marker comes into view: the further the better, and 4 mm at least.
    double best_mm = 3.5;
    for (int attempt = 0; attempt < 200 && best_mm < 10; ++attempt) {
      const auto view = random_view(staging, guide_marker_mm_, anatomical(-4, 2, -25), 19, 28);
      if (!view) continue;
      double off_mm = 0;
      for (double off = 0; off <= 11; off += 1) {
        const RigidTransform pose =
            guide_pose(*guide_.axis, plan.entry_mm - off * direction, direction, view->translation_mm);
        if (!sees_both(staging, *view, guide_, pose)) break;
        off_mm = off;
      }
      if (off_mm <= best_mm) continue;
      best_mm = off_mm;
      staging.bone_from_camera_drill = *view;
    }
    return best_mm > 3.5;
  }

  bool stage_scratch(Staging& staging) {
    for (int attempt = 0; attempt < 25; ++attempt) {
      const auto view = random_view(staging, options_.plan.entry_mm, anatomical(-14, -9, -22), 24, 33);
      if (!view) continue;
      auto strokes = find_strokes(staging, *view);
      double total = 0;
      for (const auto& stroke : strokes) total += 0.5 * static_cast<double>(stroke.size());
      if (total < 200) continue;
      staging.bone_from_camera_scratch = *view;
      staging.strokes = std::move(strokes);
      return true;
    }
    return false;
  }

  // Strokes along rows and columns of the picture, where the probe can touch what the lens sees.
  std::vector<std::vector<ProbePose>> find_strokes(const Staging& staging, const RigidTransform& view) {
    std::vector<std::vector<ProbePose>> strokes;
    double total = 0;
    for (int line = 0; line < 14 && total < 235; ++line) {
      const bool is_row = line % 2 == 0;
      // From the middle outwards, to both sides in turn.
      const int step = (line / 2 + 1) / 2 * ((line / 2) % 2 ? 1 : -1);
      const double across = 0.19 * step + 0.03;
      std::vector<ProbePose> best;
      // Held so or so: the best of a few ways.
      for (int way = 0; way < 4; ++way) {
        const Vector3d hold =
            view * Vector3d(random_.between(-9, 9), random_.between(-9, 9), random_.between(12, 18));
        auto stroke = longest_stroke(staging, view, hold, is_row, across);
        if (stroke.size() > best.size()) best = std::move(stroke);
      }
      if (best.size() < 20) continue;
      best.resize(std::min<std::size_t>(best.size(), 80));
      total += 0.5 * static_cast<double>(best.size());
      strokes.push_back(std::move(best));
    }
    return strokes;
  }

  // The longest run along one row or column of the picture, by share of the view's radius.
  std::vector<ProbePose> longest_stroke(const Staging& staging, const RigidTransform& view,
                                        const Vector3d& hold, bool is_row, double across) const {
    constexpr int kRays = 150;
    const camera::Boundary& boundary = camera_.boundary();
    std::vector<ProbePose> stroke, best;
    const auto end_stroke = [&] {
      if (stroke.size() > best.size()) best = stroke;
      stroke.clear();
    };
    for (int i = 0; i <= kRays; ++i) {
      const double along = -0.85 + 1.7 * i / kRays;
      const Eigen::Vector2d share = is_row ? Eigen::Vector2d(along, across) : Eigen::Vector2d(across, along);
      const auto ray = camera_.ray(boundary.center_px + boundary.radius_px * share);
      const auto hit = ray ? bone_.first_hit(view.translation_mm, view.rotate(*ray)) : std::nullopt;
      if (hit) {
        extend(staging, view, hold, hit->point_mm, stroke, end_stroke);
      } else {
        end_stroke();
      }
    }
    end_stroke();
    return best;
  }

  // Goes on to `point` in steps of 0.5 mm on the surface, or ends the stroke where the surface jumps or a
  // marker is lost.
  template <class End>
  void extend(const Staging& staging, const RigidTransform& view, const Vector3d& hold, const Vector3d& point,
              std::vector<ProbePose>& stroke, End end_stroke) const {
    if (!stroke.empty() && (point - stroke.back().tip_mm).norm() > 3) end_stroke();
    while (stroke.empty() || (point - stroke.back().tip_mm).norm() >= 0.5) {
      Vector3d tip = point;
      if (!stroke.empty()) {
        const Vector3d towards = (point - stroke.back().tip_mm).normalized();
        tip = bone_.closest_point(stroke.back().tip_mm + 0.5 * towards).point_mm;
        if ((tip - stroke.back().tip_mm).norm() < 0.3) {
          end_stroke();
          return;
        }
      }
      const auto pose = hold_probe(*probe_.tip_mm, tip, hold, view.translation_mm);
      if (!pose || !sees_both(staging, view, probe_, *pose)) {
        end_stroke();
        return;
      }
      stroke.push_back({tip, *pose});
    }
  }

  bool stage_pivot(Staging& staging) {
    for (int attempt = 0; attempt < 150; ++attempt) {
      const Vector3d spread =
          searches_widely_
              ? anatomical(random_.between(-6, 8), random_.between(-6, 18), random_.between(-18, 4))
              : anatomical(-1, random_.between(-4, 10), random_.between(-6, 2));
      const Vector3d tip = bone_.closest_point(options_.plan.entry_mm + spread).point_mm;
      const auto view = random_view(staging, tip, anatomical(-7, -7, -26), 22, 33);
      if (!view) continue;
      const RigidTransform camera_from_bone = view->inverse();
      const Vector3d tip_in_camera = camera_from_bone * tip;
      if (tip_in_camera.z() < 28) continue;
      const Vector3d hold = tip_in_camera + Vector3d(random_.between(-12, 12), random_.between(-12, 12), -19);
      const Vector3d mean = view->rotate((hold - tip_in_camera).normalized());
      for (const double cone_deg : {34.0, 31.0, 28.0, 25.0}) {
        auto swing = swing_about(tip, mean, cone_deg, view->translation_mm);
        const bool all =
            !swing.empty() && std::all_of(swing.begin(), swing.end(), [&](const ProbePose& pose) {
              return sees_both(staging, *view, probe_, pose.bone_from_marker);
            });
        if (!all) continue;
        staging.bone_from_camera_pivot = *view;
        staging.pivot = std::move(swing);
        staging.pivot_cone_deg = cone_deg;
        return true;
      }
    }
    return false;
  }

  // Twice around the cone, once on its rim and once half-way in.
  std::vector<ProbePose> swing_about(const Vector3d& tip, const Vector3d& mean, double cone_deg,
                                     const Vector3d& viewer) const {
    constexpr int kStops = 48;
    const Vector3d side = mean.unitOrthogonal(), up = mean.cross(side);
    std::vector<ProbePose> swing;
    for (int i = 0; i < kStops; ++i) {
      const double turn = 4 * geometry::kPi * i / kStops;
      const double tilt = geometry::rad_from_deg(cone_deg) * (0.75 + 0.25 * std::cos(0.5 * turn));
      const Vector3d u =
          std::cos(tilt) * mean + std::sin(tilt) * (std::cos(turn) * side + std::sin(turn) * up);
      const auto pose = hold_probe(*probe_.tip_mm, tip, tip + 20 * u, viewer);
      if (!pose) return {};
      swing.push_back({tip, *pose});
    }
    return swing;
  }

  const SimulationOptions& options_;
  const geometry::Surface& bone_;
  camera::CameraModel camera_;
  const tools::Tool& probe_;
  const tools::Tool& guide_;
  const tools::WorldMarker& world_;
  Random random_;
  Vector3d lateral_;
  bool searches_widely_ = false;  // else near where most knees have their places
  Vector3d guide_marker_mm_;      // about, with its point at the planned entry
};

}  // namespace

Staging stage_operation(const SimulationOptions& options, const geometry::Surface& bone) {
  // The places are looked for with the first marker of each body, as with one marker alone: the further ones
  // are seen where they happen to be, and so the same operation is staged with them and without.
  SimulationOptions of_one = options;
  for (tools::Tool& tool : of_one.tools.tools) tool.markers.clear();
  for (tools::WorldMarker& world : of_one.tools.world_markers) world.markers.clear();
  return Stage(of_one, bone).find();
}

const tools::Tool& probe_of(const tools::ToolSet& tools) {
  for (const tools::Tool& tool : tools.tools) {
    if (tool.tip_mm) return tool;
  }
  throw InvalidInput("simulator: the tools hold no probe, a tool with tip_mm");
}

const tools::Tool& guide_of(const SimulationOptions& options) {
  const tools::Tool* const named = options.tools.find_tool(tools::standard_guide_name(options.bone));
  if (named != nullptr && named->axis) return *named;
  for (const tools::Tool& tool : options.tools.tools) {
    if (tool.axis) return tool;
  }
  throw InvalidInput("simulator: the tools hold no drill guide, a tool with axis_point_mm");
}

const tools::WorldMarker& world_marker_of(const SimulationOptions& options) {
  if (const tools::WorldMarker* marker = options.tools.find_world_marker(options.bone)) return *marker;
  throw InvalidInput("simulator: the tools hold no world marker for the " +
                     std::string(bones::to_text(options.bone)));
}

}  // namespace arthronaut::simulator
