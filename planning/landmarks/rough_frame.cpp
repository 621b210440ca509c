#include "planning/landmarks/rough_frame.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/landmarks/shape_samples.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSamples = 4000;
constexpr double kJointEnd_mm =
    70;  // of the bone from the joint's end on: what the mirror plane is sought in
constexpr double kLeastCut_mm2 = 300;  // a smaller plane face may be the bone's own
constexpr double kRoughCut_mm = 0.3;   // root mean square off its plane; a flat side of a condyle has 0.4
// Under a cut the bone is about as wide as the cut; under a flat side of a condyle it widens at once.
constexpr double kBelowCut_mm = 4, kWidening = 2.2;
// From a cut across its shaft a femur goes on over more than the cut is long; where the images end in front
// of it they cut it lengthwise, over more than is left behind.
constexpr double kLeastBelowCut = 0.8;
constexpr double kAsLarge = 0.4, kAcross = 0.5;  // share of the area; cosine between two cuts
constexpr double kCutThickness_mm = 0.8;         // marching cubes and smoothing round a cut's edge
constexpr double kLongElongation = 1.6;          // of a long piece of a bone
constexpr double kWholeElongation = 3;    // of standard deviations, along and across a bone without a cut
constexpr double kSlantingSine = 0.5;     // a cut 20 degrees off, and the valgus of the shaft
constexpr double kGreatestMisfit_mm = 6;  // a mirrored point further off counts as so far off

struct Cut {
  Vector3d normal = Vector3d::UnitZ();
  double offset_mm = 0, area_mm2 = 0;
  [[nodiscard]] bool holds(const SurfaceSample& s) const {
    return s.normal.dot(normal) > 0.7 && s.point_mm.dot(normal) > offset_mm - 2 * kCutThickness_mm;
  }
};

// A noisy surface's triangles look anywhere: of each sample the mean normal about it.
std::vector<SurfaceSample> smoothed(const std::vector<SurfaceSample>& samples) {
  constexpr double kAbout_mm = 4.5;
  std::vector<SurfaceSample> smooth = samples;
  for (auto& s : smooth) {
    Vector3d sum = Vector3d::Zero();
    for (const auto& other : samples) {
      if ((other.point_mm - s.point_mm).squaredNorm() < kAbout_mm * kAbout_mm &&
          other.normal.dot(s.normal) > 0.3)
        sum += other.normal;
    }
    if (sum.norm() > 0) s.normal = sum.normalized();
  }
  return smooth;
}

struct Cuts {
  std::optional<Cut> shaft;       // across it
  std::optional<Cut> lengthwise;  // of a femur
  std::optional<Cut> aside;       // as deep as the shaft's, and at right angles to it
  // Which of two is the shaft's nobody can tell by them.
  [[nodiscard]] bool is_ambiguous() const { return aside && aside->area_mm2 > kAsLarge * shaft->area_mm2; }
  [[nodiscard]] bool hold(const SurfaceSample& s) const {
    return (shaft && shaft->holds(s)) || (lengthwise && lengthwise->holds(s));
  }
};

// The largest plane faces that support the whole surface and that the bone goes on under with about its
// width.
Cuts find_cuts(const geometry::TriangleMesh& mesh, const std::vector<SurfaceSample>& given,
               double area_each_mm2, bones::BoneKind bone, const std::stop_token& stop) {
  const auto samples = smoothed(given);
  Cuts cuts;
  for (std::size_t i = 0; i < samples.size() && !stop.stop_requested(); i += 8) {
    Vector3d normal = samples[i].normal;
    double offset = samples[i].point_mm.dot(normal);
    std::size_t held = 0;
    double off_plane_mm = 0, length_mm = 0;
    for (int round = 0; round < 3; ++round) {  // each about the plane through what the one before it held
      const double reach = round == 0 ? 2 * kCutThickness_mm : kCutThickness_mm;
      Vector3d center = Vector3d::Zero();
      Matrix3d moment = Matrix3d::Zero();
      held = 0;
      for (const auto& s : samples) {
        if (s.normal.dot(normal) < (round == 0 ? 0.95 : 0.98) ||
            std::abs(s.point_mm.dot(normal) - offset) > reach)
          continue;
        center += s.point_mm;
        moment += s.point_mm * s.point_mm.transpose();
        ++held;
      }
      if (held < 8) break;
      center /= static_cast<double>(held);
      moment = moment / static_cast<double>(held) - center * center.transpose();
      const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moment);
      length_mm = std::sqrt(12 * std::max(0.0, solver.eigenvalues()[2]));  // were it even
      const Vector3d fitted = solver.eigenvectors().col(0);
      off_plane_mm = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
      normal = fitted.dot(normal) < 0 ? Vector3d(-fitted) : fitted;
      offset = center.dot(normal);
    }
    const double area = static_cast<double>(held) * area_each_mm2;
    if (held < 8 || area < kLeastCut_mm2 || off_plane_mm > kRoughCut_mm) continue;
    double deepest_mm = 0;
    for (const auto& s : samples) deepest_mm = std::max(deepest_mm, offset - s.point_mm.dot(normal));
    const bool is_lengthwise = bone == bones::BoneKind::Femur && deepest_mm < kLeastBelowCut * length_mm;
    std::optional<Cut>& best = is_lengthwise ? cuts.lengthwise : cuts.shaft;
    const bool is_aside = bone == bones::BoneKind::Femur && !is_lengthwise && cuts.shaft &&
                          std::abs(cuts.shaft->normal.dot(normal)) < kAcross;
    if (best && area <= best->area_mm2 && !(is_aside && (!cuts.aside || area > cuts.aside->area_mm2)))
      continue;
    const auto beyond = std::count_if(samples.begin(), samples.end(), [&](const auto& s) {
      return s.point_mm.dot(normal) > offset + kCutThickness_mm;
    });
    if (static_cast<double>(beyond) > 0.004 * static_cast<double>(samples.size())) continue;
    if (sections_across(mesh, normal, offset - kBelowCut_mm, 1, 1)[0].area_mm2 > kWidening * area) continue;
    const Cut cut{normal, offset, area};
    if (is_aside) cuts.aside = area > best->area_mm2 ? *best : cut;
    if (!best || area > best->area_mm2) best = cut;
  }
  return cuts;
}

// A plane: normal and offset.
struct Mirror {
  Vector3d normal;
  double offset_mm = 0, cost = 0;  // cost: the less, the better a mirror
};

class MirrorSearch {
 public:
  MirrorSearch(std::vector<Vector3d> points, const geometry::Surface& surface)
      : points_(std::move(points)), surface_(surface) {
    center_ = std::accumulate(points_.begin(), points_.end(), Vector3d(Vector3d::Zero())) /
              static_cast<double>(points_.size());
    for (const Vector3d& p : points_) moment_ += (p - center_) * (p - center_).transpose();
    moment_ /= static_cast<double>(points_.size());
  }

  // The best plane among those whose normal lies across `joint`, the direction of the joint's end, to at most
  // this sine; nullopt where what the search comes to leans further than that.
  [[nodiscard]] std::optional<Mirror> find(const Vector3d& joint, double greatest_sine,
                                           const std::stop_token& stop) const {
    std::vector<Mirror> starts;
    const Vector3d u = joint.unitOrthogonal(), v = joint.cross(u);
    constexpr int kTurns = 18;
    for (const double lean : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      for (int i = 0; i < kTurns; ++i) {
        if (stop.stop_requested()) return std::nullopt;
        const double angle = geometry::kPi * i / kTurns;
        const Vector3d across = std::cos(angle) * u + std::sin(angle) * v;
        Mirror start{(std::cos(lean) * across + std::sin(lean) * joint).normalized()};
        start.offset_mm = center_.dot(start.normal);
        start.cost = misfit_of(partners(start, 5)) / breadth(start.normal);
        starts.push_back(start);
      }
    }
    std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    std::optional<Mirror> best;
    for (std::size_t i = 0; i < 4 && i < starts.size(); ++i) {
      Mirror refined = starts[i];
      for (int k = 0; k < 15 && !stop.stop_requested(); ++k) refined = step(refined);
      if (std::abs(refined.normal.dot(joint)) < greatest_sine && (!best || refined.cost < best->cost))
        best = refined;
    }
    return best;
  }

 private:
  // Every `stride`th point, what of the surface is nearest to its mirror image, and how far that is off.
  using Pair = std::pair<double, std::pair<Vector3d, Vector3d>>;
  [[nodiscard]] std::vector<Pair> partners(const Mirror& plane, std::size_t stride) const {
    std::vector<Pair> pairs;
    pairs.reserve(points_.size() / stride + 1);
    for (std::size_t i = 0; i < points_.size(); i += stride) {
      const Vector3d& p = points_[i];
      const Vector3d mirrored = p - 2 * (p.dot(plane.normal) - plane.offset_mm) * plane.normal;
      const Vector3d nearest = surface_.closest_point(mirrored).point_mm;
      pairs.push_back({(nearest - mirrored).norm(), {p, nearest}});
    }
    return pairs;
  }

  [[nodiscard]] static double misfit_of(const std::vector<Pair>& pairs) {
    double misfit = 0;
    for (const Pair& pair : pairs) misfit += std::min(pair.first, kGreatestMisfit_mm);
    return misfit / static_cast<double>(pairs.size());
  }

  // One step of the nearest-point iteration: of all planes the one that takes the points nearest to their
  // partners, which is the eigenvector of the smallest eigenvalue of their mutual moment.
  [[nodiscard]] Mirror step(const Mirror& plane) const {
    std::vector<Pair> pairs = partners(plane, 1);
    const double misfit = misfit_of(pairs);
    const auto kept = static_cast<std::ptrdiff_t>(0.85 * static_cast<double>(pairs.size()));
    std::nth_element(pairs.begin(), pairs.begin() + kept, pairs.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    pairs.resize(static_cast<std::size_t>(kept));
    Vector3d mean = Vector3d::Zero();
    for (const auto& [d, pair] : pairs) mean += (pair.first + pair.second) / 2;
    mean /= static_cast<double>(kept);
    Matrix3d moment = Matrix3d::Zero();
    for (const auto& [d, pair] : pairs) moment += (pair.first - mean) * (pair.second - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moment + moment.transpose());
    Mirror next{solver.eigenvectors().col(0)};
    next.offset_mm = mean.dot(next.normal);
    next.cost = misfit / breadth(plane.normal);
    return next;
  }

  // How wide the joint's end is along the normal, one standard deviation: of two planes that mirror it alike
  // the one between its sides is meant, since condyles and plateau are wider than they are deep.
  [[nodiscard]] double breadth(const Vector3d& normal) const {
    return std::sqrt(normal.dot(moment_ * normal));
  }

  std::vector<Vector3d> points_;
  const geometry::Surface& surface_;
  Vector3d center_;
  Matrix3d moment_ = Matrix3d::Zero();  // about the center
};

// Which way along `forward` is the front: of a femur the notch lies behind; of a tibia the rim is bent in
// behind.
double forwardness(const std::vector<Vector3d>& points, const geometry::Surface& surface,
                   const Matrix3d& axes, const Vector3d& origin, bones::BoneKind bone) {
  if (bone == bones::BoneKind::Tibia) {
    const auto reach = [&](double sign, bool middle) {
      double furthest = -1e9;
      for (const Vector3d& p : points) {
        const Vector3d q = axes.transpose() * (p - origin);
        const double x = std::abs(q.x());
        if (q.z() < -22 || (middle ? x > 5 : (x < 13 || x > 26))) continue;
        furthest = std::max(furthest, sign * q.y());
      }
      return furthest;
    };
    return (reach(1, true) - reach(1, false)) - (reach(-1, true) - reach(-1, false));
  }
  double sum = 0, cells = 0;
  for (double y = -45; y <= 45; y += 3) {
    for (double z = 0; z <= 45; z += 3) {
      const Vector3d start = origin + axes * Vector3d(-80, y, z);
      const auto hits = surface.all_hits(start, axes.col(0));
      const auto before =
          std::count_if(hits.begin(), hits.end(), [](const auto& hit) { return hit.distance_mm < 80; });
      if (before == 0 || before == static_cast<std::ptrdiff_t>(hits.size()) || before % 2 == 1) continue;
      sum -= y;  // open in the middle and bone on both sides
      cells += 1;
    }
  }
  return cells > 0 ? sum / cells : 0;
}

struct JointEnd {
  Vector3d direction;           // from the shaft to the joint
  double greatest_sine = 0.75;  // of what it may be off
};

struct PrincipalAxes {
  Matrix3d axes;  // columns, the longest last
  double elongation = 1;
};

PrincipalAxes principal_axes_of(const std::vector<SurfaceSample>& samples) {
  Vector3d mean = Vector3d::Zero();
  for (const auto& s : samples) mean += s.point_mm / static_cast<double>(samples.size());
  Matrix3d moment = Matrix3d::Zero();
  for (const auto& s : samples) moment += (s.point_mm - mean) * (s.point_mm - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moment);
  return {solver.eigenvectors(), std::sqrt(solver.eigenvalues()[2] / solver.eigenvalues()[1])};
}

std::vector<JointEnd> joint_ends(const PrincipalAxes& principal, const Cuts& cuts) {
  const std::optional<Cut>& cut = cuts.shaft;
  const Vector3d longest = principal.axes.col(2);
  const double elongation = principal.elongation;
  // What parted the joint may have left its end as flat as a saw.
  if (cuts.lengthwise && elongation > kLongElongation) return {{longest}, {-longest}};
  if (cuts.is_ambiguous() && elongation <= kLongElongation) return {};
  if (cut) {
    // A long piece's axis tells more than the saw's plane.
    if (elongation > kLongElongation)
      return {{longest.dot(cut->normal) > 0 ? Vector3d(-longest) : longest, kSlantingSine}};
    return {{-cut->normal, kSlantingSine}};
  }
  if (elongation > kWholeElongation) return {{longest}, {-longest}};
  std::vector<JointEnd> ends;
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {1.0, -1.0}) ends.push_back({sign * principal.axes.col(k)});
  }
  return ends;
}

}  // namespace

std::vector<RoughFrame> rough_frames(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                                     bones::BoneKind bone, const std::stop_token& stop) {
  const auto samples = sample_surface(mesh, geometry::surface_area_mm2(mesh) / kSamples);
  if (samples.empty()) return {};
  const double area_each = geometry::surface_area_mm2(mesh) / static_cast<double>(samples.size());
  const PrincipalAxes principal = principal_axes_of(samples);
  Cuts cuts = find_cuts(mesh, samples, area_each, bone, stop);
  // The only cut of a stump, which is no deeper than the cut is long, is the shaft's.
  if (!cuts.shaft && principal.elongation <= kLongElongation) std::swap(cuts.shaft, cuts.lengthwise);
  std::vector<std::pair<double, RoughFrame>> found;
  for (const JointEnd& end : joint_ends(principal, cuts)) {
    double tip = -1e9;
    for (const auto& s : samples) tip = std::max(tip, s.point_mm.dot(end.direction));
    std::vector<Vector3d> points;
    for (const auto& s : samples) {
      if (s.point_mm.dot(end.direction) > tip - kJointEnd_mm && !cuts.hold(s)) points.push_back(s.point_mm);
    }
    if (points.size() < 200) continue;
    if (points.size() > 500) {
      std::vector<Vector3d> fewer;
      for (std::size_t i = 0; i < 500; ++i) fewer.push_back(points[i * points.size() / 500]);
      points = std::move(fewer);
    }
    const MirrorSearch search(points, surface);
    const auto mirror = search.find(end.direction, end.greatest_sine, stop);
    if (!mirror) continue;
    RoughFrame frame;
    const double up = bone == bones::BoneKind::Femur ? -1 : 1;
    const Vector3d z =
        (up * (end.direction - end.direction.dot(mirror->normal) * mirror->normal)).normalized();
    frame.bone_from_frame.col(0) = mirror->normal;
    frame.bone_from_frame.col(2) = z;
    frame.bone_from_frame.col(1) = z.cross(mirror->normal);
    const double tip_z = bone == bones::BoneKind::Femur ? 1e9 : -1e9;
    double end_z = tip_z;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : points) {
      end_z = bone == bones::BoneKind::Femur ? std::min(end_z, p.dot(z)) : std::max(end_z, p.dot(z));
      middle += p / static_cast<double>(points.size());
    }
    frame.origin_mm = middle + (mirror->offset_mm - middle.dot(mirror->normal)) * mirror->normal;
    frame.origin_mm += (end_z - frame.origin_mm.dot(z)) * z;
    if (forwardness(points, surface, frame.bone_from_frame, frame.origin_mm, bone) < 0) {
      frame.bone_from_frame.col(0) *= -1;
      frame.bone_from_frame.col(1) *= -1;
    }
    if (cuts.shaft) {
      frame.cut_normal = cuts.shaft->normal;
      frame.cut_offset_mm = cuts.shaft->offset_mm;
    }
    found.push_back({mirror->cost, frame});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<RoughFrame> frames;
  for (const auto& [cost, frame] : found) frames.push_back(frame);
  return frames;
}

}  // namespace arthronaut::landmarks
