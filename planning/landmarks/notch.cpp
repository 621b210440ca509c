#include "planning/landmarks/notch.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "planning/geometry/quantile.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

constexpr double kUsualSlope_deg = 37;  // of the roof against the long axis; 26 to 46 in Howell 1995
constexpr double kStep_mm = 0.5, kReach_mm = 36;
constexpr double kBeyond_mm = 8.0, kLeastBeyond_mm = 5.0;  // of the back of the shaft and of the groove
constexpr double kLeastBend_rad = 0.4;                     // of either against the roof
constexpr double kUnusual_rad = 0.3;  // of the slope: 5.5 degrees, and what the long axis is uncertain by
constexpr double kCoarse_mm = 2.0, kFine_mm = 0.75,
                 kRound_mm = 3.0;                           // steps of the search; how round an end may be
constexpr double kAboutAsGood = 0.15;                       // of the cost of the best
constexpr double kHill_mm = 1.0;                            // into the notch off the line: a hill
constexpr double kLeastRoof_mm = 17, kLongestRoof_mm = 45;  // of a femur 65 mm deep

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
  return Walls{geometry::median(std::move(middles)), geometry::median(std::move(widths))};
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

// Each depth the mean of those within 1 mm: what a noisy surface adds is not the outline's.
std::vector<ProfilePoint> smoothed(const std::vector<ProfilePoint>& profile) {
  constexpr double kAbout_mm = 1;
  std::vector<ProfilePoint> smooth = profile;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    double sum = 0, count = 0;
    for (std::size_t k = i < 4 ? 0 : i - 4; k < std::min(profile.size(), i + 5); ++k) {
      if (std::abs(profile[k].s - profile[i].s) <= kAbout_mm) sum += profile[k].t, count += 1;
    }
    smooth[i].t = sum / count;
  }
  return smooth;
}

// A groove that runs back over the roof is met by no ray: the outline is taken on steeply where it ends in
// front.
std::vector<ProfilePoint> carried_on(std::vector<ProfilePoint> profile) {
  constexpr double kSteep = 1.7;  // tangent
  for (ProfilePoint p = profile.back(); p.s + kStep_mm <= kReach_mm + kBeyond_mm;) {
    p.s += kStep_mm;
    p.t += kSteep * kStep_mm;
    profile.push_back(p);
  }
  return profile;
}

struct Line {
  double offset = 0, slope = 0;
  [[nodiscard]] double at(double s) const { return offset + slope * s; }
};

// The outline's depth at a place, smoothed over 4 mm.
double outline_at(const std::vector<ProfilePoint>& profile, double s) {
  constexpr double kAbout_mm = 2;
  double sum = 0, weights = 0;
  for (const auto& p : profile) {
    const double off = (p.s - s) / kAbout_mm;
    if (std::abs(off) >= 1) continue;
    const double weight = std::pow(1 - off * off, 2);
    sum += weight * p.t;
    weights += weight;
  }
  if (weights > 0) return sum / weights;
  return std::min_element(profile.begin(), profile.end(),
                          [&](const auto& a, const auto& b) { return std::abs(a.s - s) < std::abs(b.s - s); })
      ->t;
}

// The straight line through the roof by least squares, and again without what stands off it into the notch.
Line without_hill(const std::vector<ProfilePoint>& profile, double from, double to, Line line) {
  for (int round = 0; round < 6; ++round) {
    double n = 0, s1 = 0, s2 = 0, t1 = 0, st = 0;
    for (const auto& p : profile) {
      if (p.s < from || p.s > to || p.t < line.at(p.s) - 0.7 * kHill_mm) continue;
      n += 1, s1 += p.s, s2 += p.s * p.s, t1 += p.t, st += p.s * p.t;
    }
    const double determinant = n * s2 - s1 * s1;
    if (n < 6 || determinant < 1e-9) return line;
    const double slope = (n * st - s1 * t1) / determinant;
    line = {(t1 - slope * s1) / n, slope};
  }
  return line;
}

// The outline as the lateral view shows it: the back of the shaft, the roof, the groove of the kneecap, each
// straight over kBeyond_mm next to the roof. `from` and `to` are where they meet.
struct Roof {
  double from = 0, to = 0;
  Line line;
  double cost = 0;
};

// Three straight pieces that meet at `from` and `to`, by least squares. `usual` is the slope that a usual
// roof would have in the outline.
std::optional<Roof> three_pieces(const std::vector<ProfilePoint>& profile, double from, double to,
                                 std::optional<double> usual_rad) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double squares = 0, count = 0, behind = 0, ahead = 0;
  for (const auto& p : profile) {
    if (p.s < from - kBeyond_mm || p.s > to + kBeyond_mm) continue;
    const Eigen::Vector4d row(1, p.s, std::max(0.0, from - p.s), std::max(0.0, p.s - to));
    normal += row * row.transpose();
    right += p.t * row;
    squares += p.t * p.t;
    count += 1, behind += p.s<from, ahead += p.s> to;
  }
  if (std::min(behind, ahead) < kLeastBeyond_mm / kStep_mm) return std::nullopt;
  const Eigen::Vector4d pieces = normal.ldlt().solve(right);
  // Behind and in front of the roof the bone falls away.
  const double turn = std::atan(pieces[1]), bend_behind = turn - std::atan(pieces[1] - pieces[2]),
               bend_ahead = std::atan(pieces[1] + pieces[3]) - turn;
  const double unusual = usual_rad ? (turn - *usual_rad) / kUnusual_rad : 0;
  if (std::min(bend_behind, bend_ahead) < kLeastBend_rad || std::abs(unusual) > 2) return std::nullopt;
  // Of a bent roof a short piece is straighter, but it does not end in corners.
  const double misfit_mm = std::sqrt(std::max(0.0, squares - pieces.dot(right)) / count);
  return Roof{from,
              to,
              {pieces[0], pieces[1]},
              misfit_mm * (1 + unusual * unusual) / ((to - from) * bend_behind * bend_ahead)};
}

// Of all places of both ends the ones that the outline comes nearest to.
std::optional<Roof> find_roof(const std::vector<ProfilePoint>& profile, double scale, double usual_rad) {
  std::optional<Roof> best;
  for (double from = -kReach_mm; from < kReach_mm; from += kCoarse_mm) {
    for (double to = from + kLeastRoof_mm * scale; to < std::min(kReach_mm, from + kLongestRoof_mm * scale);
         to += kCoarse_mm) {
      const auto roof = three_pieces(profile, from, to, usual_rad);
      if (roof && (!best || roof->cost < best->cost)) best = roof;
    }
  }
  return best;
}

template <typename Visit>
void each_about(const Roof& about, const Visit& visit) {
  for (double from = about.from - kRound_mm; from <= about.from + kRound_mm; from += kFine_mm) {
    for (double to = about.to - kRound_mm; to <= about.to + kRound_mm; to += kFine_mm) visit(from, to);
  }
}

// Of all places of the ends about `about`, the best; what is usual does not enter any more.
std::optional<Roof> settle(const std::vector<ProfilePoint>& profile, const Roof& about) {
  std::optional<Roof> best;
  each_about(about, [&](double from, double to) {
    const auto roof = three_pieces(profile, from, to, std::nullopt);
    if (roof && (!best || roof->cost < best->cost)) best = roof;
  });
  return best;
}

// An end may be round: the mean of all places about the best that are about as good.
Roof mean_about(const std::vector<ProfilePoint>& profile, const Roof& best) {
  Roof mean = best;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double weights = 0;
  each_about(best, [&](double from, double to) {
    const auto roof = three_pieces(profile, from, to, std::nullopt);
    if (!roof) return;
    const double weight = std::exp((1 - roof->cost / best.cost) / kAboutAsGood);
    sum += weight * Eigen::Vector4d(from, to, roof->line.offset, roof->line.slope);
    weights += weight;
  });
  if (weights > 0) sum /= weights, mean = {sum[0], sum[1], {sum[2], sum[3]}, best.cost};
  return mean;
}

}  // namespace

std::optional<Notch> find_notch(const geometry::Surface& femur, const Condyles& condyles) {
  const Eigen::Matrix3d& axes = condyles.bone_from_frame;
  const double usual = geometry::rad_from_deg(kUsualSlope_deg);
  double slope = usual;
  View view{femur, condyles.center_mm, axes.col(0), {}, {}, condyles.depth_mm / 65};
  std::vector<ProfilePoint> profile;
  std::optional<Roof> best;
  Roof roof;
  std::optional<Walls> walls;
  constexpr int kRounds = 8, kGlobal = 3;
  for (int round = 0; round < kRounds; ++round) {
    view.forward = std::sin(slope) * axes.col(1) - std::cos(slope) * axes.col(2);
    view.into_bone = std::cos(slope) * axes.col(1) + std::sin(slope) * axes.col(2);
    walls = find_walls(view);
    if (!walls) return std::nullopt;
    profile = outline(view, *walls);
    if (profile.size() < 20) return std::nullopt;
    profile = carried_on(smoothed(profile));
    if (round < kGlobal) best = find_roof(profile, view.scale, usual - slope);
    if (best) best = settle(profile, *best);
    if (!best) return std::nullopt;
    roof = mean_about(profile, *best);
    roof.line = without_hill(profile, roof.from, roof.to, roof.line);
    const double turn = std::atan(roof.line.slope);
    if (round == kRounds - 1 || (round >= kGlobal && std::abs(turn) < 1e-3)) break;
    slope += turn;
  }
  Notch notch;
  double deepest_hill = 0, hill_at = 0;
  for (const auto& p : profile) {
    if (p.s < roof.from + 2 || p.s > roof.to - 2) continue;
    if (roof.line.at(p.s) - p.t > deepest_hill) deepest_hill = roof.line.at(p.s) - p.t, hill_at = p.s;
  }
  notch.hill_mm = deepest_hill;
  if (deepest_hill > kHill_mm) {
    // Yahagi 2018: the small hill stands in the posterior half of the line alone.
    notch.shape = hill_at < (roof.from + roof.to) / 2 ? RoofShape::SmallHill : RoofShape::LargeHill;
  }
  // Which ray is the deepest wanders over the vault; its middle does not.
  double ridge = 0, of = 0;
  for (const auto& p : profile) {
    if (p.s >= roof.from && p.s <= roof.to) ridge += (p.at - view.center).dot(view.across), of += 1;
  }
  ridge /= of;
  const auto at = [&](double s, double t) -> Vector3d {
    return view.center + ridge * view.across + s * view.forward + t * view.into_bone;
  };
  const auto laid = [&](double t_anterior, double t_posterior) {
    BlumensaatLine line{at(roof.to, t_anterior), at(roof.from, t_posterior), {}, {}};
    line.forward = (line.anterior_mm - line.posterior_mm).normalized();
    line.into_bone = (view.into_bone - view.into_bone.dot(line.forward) * line.forward).normalized();
    return line;
  };
  notch.flat = laid(roof.line.at(roof.to), roof.line.at(roof.from));
  notch.ends = laid(outline_at(profile, roof.to), outline_at(profile, roof.from));
  const double middle = (roof.from + roof.to) / 2;
  notch.apex_mm = at(middle, outline_at(profile, middle));
  notch.cost = roof.cost;
  notch.roof = view.forward;
  return notch;
}

}  // namespace arthronaut::landmarks
