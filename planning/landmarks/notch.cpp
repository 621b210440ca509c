#include "planning/landmarks/notch.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

constexpr double kUsualSlope_deg = 37;  // of the roof against the long axis; 26 to 46 in Howell 1995
constexpr double kStep_mm = 0.5, kReach_mm = 36;
constexpr double kBend_mm = 1.0;  // off the line: the roof has ended
constexpr double kFarOff_mm = 3.0, kLongestPit_mm = 6.0, kGap_mm = 3.0;
constexpr double kHill_mm = 1.0;  // into the notch off the line: a hill
constexpr double kLeastRoof_mm = 14;
constexpr double kGreatestTurn = 0.45;  // of the roof against what was taken for its direction, tangent

struct ProfilePoint {
  double s = 0, t = 0;  // along the roof, into the bone; from the middle of the condyles
  Vector3d at;
};

struct Walls {
  double middle_mm = 0, half_width_mm = 0;
};

struct View {
  const geometry::Surface& femur;
  Vector3d center, across, forward, into_bone;
  double scale;
};

// Where the notch is open between two walls: medians over a patch of its inside.
std::optional<Walls> find_walls(const View& view) {
  std::vector<double> middles, widths;
  for (const double s : {-8.0, -4.0, 0.0, 4.0, 8.0}) {
    for (const double t : {-3.0, -6.0, -9.0}) {
      for (const double x : {-4.0, 0.0, 4.0}) {
        const Vector3d inside =
            view.center + view.scale * (s * view.forward + t * view.into_bone + x * view.across);
        const auto plus = view.femur.first_hit(inside, view.across),
                   minus = view.femur.first_hit(inside, -view.across);
        if (!plus || !minus || plus->normal.dot(view.across) > 0 || minus->normal.dot(view.across) < 0)
          continue;
        const double from = (minus->point_mm - view.center).dot(view.across),
                     to = (plus->point_mm - view.center).dot(view.across);
        if (to - from < 6 || to - from > 40) continue;
        middles.push_back((from + to) / 2);
        widths.push_back((to - from) / 2);
      }
    }
  }
  if (middles.size() < 12) return std::nullopt;
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  return Walls{median(middles), median(widths)};
}

// The roof's outline in the lateral view. Of each cross section the third deepest ray, so that a vessel's
// hole does not count.
std::vector<ProfilePoint> outline(const View& view, const Walls& walls) {
  std::vector<ProfilePoint> profile;
  const double start = 9 * view.scale, spread = 0.6 * walls.half_width_mm;
  constexpr int kRays = 13;
  for (double s = -kReach_mm; s <= kReach_mm; s += kStep_mm) {
    std::vector<ProfilePoint> found;
    for (int i = 0; i < kRays; ++i) {
      const double x = walls.middle_mm + spread * (2.0 * i / (kRays - 1) - 1);
      const Vector3d from = view.center + x * view.across + s * view.forward - start * view.into_bone;
      const auto hit = view.femur.first_hit(from, view.into_bone);
      if (!hit || hit->normal.dot(view.into_bone) > 0) continue;
      found.push_back({s, hit->distance_mm - start, hit->point_mm});
    }
    if (found.size() < 4) continue;
    std::nth_element(found.begin(), found.begin() + 2, found.end(),
                     [](const auto& a, const auto& b) { return a.t > b.t; });
    profile.push_back(found[2]);
  }
  return profile;
}

struct Line {
  double offset = 0, slope = 0;
  [[nodiscard]] double at(double s) const { return offset + slope * s; }
};

Line fit(const std::vector<ProfilePoint>& profile, double from, double to, const Line* without_hill_of) {
  double n = 0, s1 = 0, s2 = 0, t1 = 0, st = 0;
  for (const auto& p : profile) {
    if (p.s < from || p.s > to) continue;
    if (without_hill_of != nullptr && p.t < without_hill_of->at(p.s) - 0.7 * kHill_mm) continue;
    n += 1, s1 += p.s, s2 += p.s * p.s, t1 += p.t, st += p.s * p.t;
  }
  const double determinant = n * s2 - s1 * s1;
  if (n < 6 || determinant < 1e-9) return {};
  const double slope = (n * st - s1 * t1) / determinant;
  return {(t1 - slope * s1) / n, slope};
}

// From `inside` outwards to where the outline leaves the line for good: a pit in the roof is shallow or
// short, beyond the end the bone falls away.
double end_of_roof(const std::vector<ProfilePoint>& profile, const Line& line, double inside, double sign) {
  std::vector<const ProfilePoint*> way;
  for (const auto& p : profile) {
    if (sign * (p.s - inside) >= 0) way.push_back(&p);
  }
  if (sign < 0) std::reverse(way.begin(), way.end());
  double end = inside, before = inside;
  for (const auto* p : way) {
    const double off = p->t - line.at(p->s);
    if (off > kFarOff_mm || sign * (p->s - end) > kLongestPit_mm || sign * (p->s - before) > kGap_mm) break;
    before = p->s;
    if (off < kBend_mm) end = p->s;
  }
  return end;
}

const ProfilePoint& nearest(const std::vector<ProfilePoint>& profile, double s) {
  return *std::min_element(profile.begin(), profile.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.s - s) < std::abs(b.s - s);
  });
}

struct Roof {
  double from = 0, to = 0;
  Line line;
};

std::optional<Roof> grow_roof(const std::vector<ProfilePoint>& profile, Roof roof) {
  for (int round = 0; round < 10; ++round) {
    const double inset = 0.08 * (roof.to - roof.from);
    const Line all = fit(profile, roof.from + inset, roof.to - inset, nullptr);
    roof.line = fit(profile, roof.from + inset, roof.to - inset, &all);
    if (std::abs(roof.line.slope) > kGreatestTurn) return std::nullopt;
    const double middle = (roof.from + roof.to) / 2;
    roof.from = end_of_roof(profile, roof.line, middle, -1);
    roof.to = end_of_roof(profile, roof.line, middle, 1);
    if (roof.to - roof.from < kLeastRoof_mm) return std::nullopt;
  }
  return roof;
}

// The longest straight stretch, wherever it is looked for first.
std::optional<Roof> find_roof(const std::vector<ProfilePoint>& profile, double scale) {
  std::optional<Roof> longest;
  for (double start = -10; start <= 18; start += 4) {
    const auto grown = grow_roof(profile, {(start - 6) * scale, (start + 6) * scale, {}});
    if (grown && (!longest || grown->to - grown->from > longest->to - longest->from)) longest = grown;
  }
  return longest;
}

}  // namespace

std::optional<Notch> find_notch(const geometry::Surface& femur, const Condyles& condyles,
                                RoofConvention convention) {
  const Eigen::Matrix3d& axes = condyles.bone_from_frame;
  double slope = geometry::rad_from_deg(kUsualSlope_deg);
  View view{femur, condyles.center_mm, axes.col(0), {}, {}, condyles.depth_mm / 65};
  std::vector<ProfilePoint> profile;
  std::optional<Roof> roof;
  std::optional<Walls> walls;
  for (int round = 0; round < 6; ++round) {
    view.forward = std::sin(slope) * axes.col(1) - std::cos(slope) * axes.col(2);
    view.into_bone = std::cos(slope) * axes.col(1) + std::sin(slope) * axes.col(2);
    walls = find_walls(view);
    if (!walls) return std::nullopt;
    profile = outline(view, *walls);
    if (profile.size() < 20) return std::nullopt;
    roof = find_roof(profile, view.scale);
    if (!roof) return std::nullopt;
    const double turn = std::atan(roof->line.slope);
    if (round == 5 || std::abs(turn) < 1e-4) break;
    slope += turn;
  }
  Notch notch;
  notch.half_width_mm = walls->half_width_mm;
  double deepest_hill = 0, hill_at = 0;
  for (const auto& p : profile) {
    if (p.s < roof->from + 2 || p.s > roof->to - 2) continue;
    if (roof->line.at(p.s) - p.t > deepest_hill) deepest_hill = roof->line.at(p.s) - p.t, hill_at = p.s;
  }
  notch.hill_mm = deepest_hill;
  if (deepest_hill > kHill_mm) {
    // Yahagi 2018: the small hill stands in the posterior half of the line alone.
    notch.shape = hill_at < (roof->from + roof->to) / 2 ? RoofShape::SmallHill : RoofShape::LargeHill;
  }
  const ProfilePoint &front = nearest(profile, roof->to), &back = nearest(profile, roof->from);
  // Which ray is the deepest wanders over the vault; its middle does not.
  double ridge = 0, of = 0;
  for (const auto& p : profile) {
    if (p.s >= roof->from && p.s <= roof->to) ridge += (p.at - view.center).dot(view.across), of += 1;
  }
  ridge /= of;
  const auto laid = [&](const ProfilePoint& p) -> Vector3d {
    const double t = convention == RoofConvention::Ends ? p.t : roof->line.at(p.s);
    return view.center + ridge * view.across + p.s * view.forward + t * view.into_bone;
  };
  notch.anterior_mm = laid(front);
  notch.posterior_mm = laid(back);
  const ProfilePoint& middle = nearest(profile, (roof->from + roof->to) / 2);
  notch.apex_mm = view.center + ridge * view.across + middle.s * view.forward + middle.t * view.into_bone;
  const Vector3d along = notch.anterior_mm - notch.posterior_mm;
  notch.forward = (along - along.dot(view.across) * view.across).normalized();
  notch.into_bone = (view.into_bone - view.into_bone.dot(notch.forward) * notch.forward).normalized();
  return notch;
}

}  // namespace arthronaut::landmarks
