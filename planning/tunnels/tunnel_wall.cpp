#include "planning/tunnels/tunnel_wall.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastTurnCosine = 0.70710678118654752;  // 45 deg: of the mouth's own face
constexpr double kLeastFacing = 0.25881904510252074;      // sin 15 deg: of a face that a drill goes through
constexpr double kRoughness_mm = 1.0;
constexpr double kBin_mm = 0.25;
constexpr int kHalfPlanes = 120, kHalvings = 5, kMostHalfPlanes = 900;

// A face's cut with a half plane: stations and distances from the axis, from low station to high.
struct Cut {
  double from_mm = 0, to_mm = 0, from_radius_mm = 0, to_radius_mm = 0;
  bool enters = false;     // along the axis; else it leaves the bone there
  bool comes_out = false;  // straight away from the axis
  bool entry_lip = false, exit_lip = false;
  const AxisTriangle* of = nullptr;
  [[nodiscard]] double radius_at(double station) const {
    const double run = to_mm - from_mm;
    if (run <= 0) return std::min(from_radius_mm, to_radius_mm);
    return from_radius_mm + (to_radius_mm - from_radius_mm) * (station - from_mm) / run;
  }
};

struct Thinnest {
  double radius_mm = kInfinity, station_mm = 0;
  const AxisTriangle* of = nullptr;  // null on a rim between two lips
  void take(double radius, double station, const AxisTriangle* triangle) {
    if (radius < radius_mm) *this = {radius, station, triangle};
  }
};

class HalfPlane {
 public:
  HalfPlane(double length_mm, double radius_mm, double low_mm, double high_mm)
      : length_mm_(length_mm),
        radius_mm_(radius_mm),
        low_mm_(low_mm),
        bins_(static_cast<std::size_t>(std::ceil((high_mm - low_mm) / kBin_mm)) + 1) {}

  void clear() { cuts_.clear(); }
  void add(const Cut& cut) { cuts_.push_back(cut); }
  [[nodiscard]] Thinnest thinnest();

 private:
  // At one station, the surfaces next to the tunnel's side: outwards of it and towards the axis.
  struct Side {
    const Cut *outwards = nullptr, *inwards = nullptr;
    double outwards_mm = kInfinity, inwards_mm = -kInfinity;

    void add(const Cut& cut, double radius, double side_mm) {
      if (radius >= side_mm && radius < outwards_mm) {
        outwards_mm = radius;
        outwards = &cut;
      } else if (radius < side_mm && radius > inwards_mm) {
        inwards_mm = radius;
        inwards = &cut;
      }
    }
    [[nodiscard]] bool is_in_bone() const {
      if (outwards) return outwards->comes_out;
      return !inwards || !inwards->comes_out;
    }
    // What bone ends at: outwards of a side that lies in it, towards the axis of one that does not.
    [[nodiscard]] const Cut* end() const { return is_in_bone() ? outwards : inwards; }
  };
  [[nodiscard]] double station_of(std::size_t bin) const {
    return low_mm_ + (static_cast<double>(bin) + 0.5) * kBin_mm;
  }
  [[nodiscard]] std::size_t bin_of(double station) const {
    const double at = std::floor((station - low_mm_) / kBin_mm);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins_.size() - 1)));
  }
  [[nodiscard]] Side side_at(double station) const;
  void fill_bins();
  [[nodiscard]] double station_of_side(const Cut& cut) const;
  [[nodiscard]] double side_begins_mm() const;
  [[nodiscard]] double side_ends_mm() const;
  template <typename IsLip>
  [[nodiscard]] std::size_t beyond_lip(std::size_t from, std::size_t to, IsLip is_lip) const;
  void take_between(double from, double to, bool with_lips, Thinnest& thinnest) const;

  double length_mm_, radius_mm_, low_mm_;
  std::vector<Cut> cuts_;
  std::vector<Side> bins_;  // at the middle of each
};

HalfPlane::Side HalfPlane::side_at(double station) const {
  Side side;
  for (const Cut& cut : cuts_)
    if (cut.from_mm <= station && station <= cut.to_mm) side.add(cut, cut.radius_at(station), radius_mm_);
  return side;
}

void HalfPlane::fill_bins() {
  std::fill(bins_.begin(), bins_.end(), Side{});
  for (const Cut& cut : cuts_) {
    const double first = std::ceil((cut.from_mm - low_mm_) / kBin_mm - 0.5),
                 last = std::floor((cut.to_mm - low_mm_) / kBin_mm - 0.5);
    for (double b = std::max(first, 0.0); b <= std::min(last, static_cast<double>(bins_.size() - 1)); ++b) {
      const auto bin = static_cast<std::size_t>(b);
      bins_[bin].add(cut, cut.radius_at(station_of(bin)), radius_mm_);
    }
  }
}

// Where the tunnel's side, a line beside the axis, goes through a cut that it meets.
double HalfPlane::station_of_side(const Cut& cut) const {
  const double rise = cut.to_radius_mm - cut.from_radius_mm;
  if (rise == 0) return cut.from_mm;
  return cut.from_mm + (radius_mm_ - cut.from_radius_mm) / rise * (cut.to_mm - cut.from_mm);
}

// The side enters the bone before the axis does on one side of a slanting mouth. 0 where it is still outside
// when the axis enters: from there on it is looked at.
double HalfPlane::side_begins_mm() const {
  if (!bins_[bin_of(0.5 * kBin_mm)].is_in_bone()) return 0;
  double begins = low_mm_;
  for (const Cut& cut : cuts_) {
    if (!cut.enters || (cut.from_radius_mm - radius_mm_) * (cut.to_radius_mm - radius_mm_) > 0) continue;
    if (const double station = station_of_side(cut); station <= kBin_mm) begins = std::max(begins, station);
  }
  return begins;
}

double HalfPlane::side_ends_mm() const {
  if (!bins_[bin_of(length_mm_ - 0.5 * kBin_mm)].is_in_bone()) return length_mm_;
  double ends = low_mm_ + static_cast<double>(bins_.size()) * kBin_mm;
  for (const Cut& cut : cuts_) {
    if (cut.enters || (cut.from_radius_mm - radius_mm_) * (cut.to_radius_mm - radius_mm_) > 0) continue;
    if (const double station = station_of_side(cut); station >= length_mm_ - kBin_mm)
      ends = std::min(ends, station);
  }
  return ends;
}

// The first bin from `from` towards `to` at which the lip is over; `to` where it never is. What is no lip for
// less than kRoughness_mm does not end it.
template <typename IsLip>
std::size_t HalfPlane::beyond_lip(std::size_t from, std::size_t to, IsLip is_lip) const {
  const auto long_enough = static_cast<int>(std::lround(kRoughness_mm / kBin_mm));
  int run = 0;
  std::size_t began = from;
  const int step = from <= to ? 1 : -1;
  for (std::size_t bin = from;; bin = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(bin) + step)) {
    if (const Cut* end = bins_[bin].end(); end && is_lip(*end)) {
      run = 0;
    } else {
      if (run++ == 0) began = bin;
      if (run >= long_enough) return began;
    }
    if (bin == to) return to;
  }
}

// The distance is linear along a cut: the least is at an end of what is asked for.
void HalfPlane::take_between(double from, double to, bool with_lips, Thinnest& thinnest) const {
  for (const Cut& cut : cuts_) {
    if (!cut.comes_out || (!with_lips && (cut.entry_lip || cut.exit_lip))) continue;
    const double begin = std::max(from, cut.from_mm), end = std::min(to, cut.to_mm);
    if (begin > end) continue;
    for (const double station : {begin, end}) {
      const double radius = cut.radius_at(station);
      if (radius >= thinnest.radius_mm) continue;
      // It counts where bone ends at it, seen from the tunnel's side; a hair inwards, off what it shares with
      // the next one.
      if (side_at(station + 1e-3 * (0.5 * (begin + end) - station)).end() == &cut)
        thinnest.take(radius, station, cut.of);
    }
  }
}

Thinnest HalfPlane::thinnest() {
  fill_bins();
  const double begins = side_begins_mm(), ends = side_ends_mm();
  const std::size_t first = bin_of(begins), last = bin_of(ends);
  const std::size_t a = beyond_lip(first, last, [](const Cut& cut) { return cut.entry_lip; });
  const std::size_t b = beyond_lip(last, first, [](const Cut& cut) { return cut.exit_lip; });
  Thinnest found;
  if (a >= b) {
    // One lip runs into the other, as on a lens: between them stands the rim.
    const std::size_t middle = (a + b) / 2;
    double rim_mm = 0, at_mm = 0;
    for (std::size_t bin = middle > 0 ? middle - 1 : 0; bin <= std::min(middle + 1, bins_.size() - 1);
         ++bin) {
      if (!bins_[bin].end()) continue;
      const double end_mm = bins_[bin].is_in_bone() ? bins_[bin].outwards_mm : bins_[bin].inwards_mm;
      if (end_mm <= rim_mm) continue;
      rim_mm = end_mm;
      at_mm = station_of(bin);
    }
    if (rim_mm > 0) found.take(rim_mm, at_mm, nullptr);
    return found;
  }
  // Lips are known at the middles of bins: between such a middle and where the lip ends, or where the side
  // begins, only what is no lip.
  const double from = station_of(a) < begins ? station_of(a + 1) : station_of(a),
               to = station_of(b) > ends ? station_of(b - 1) : station_of(b);
  take_between(from, to, true, found);
  take_between(std::max(begins, from - kBin_mm), std::min(from, ends), false, found);
  take_between(std::max(to, begins), std::min(ends, to + kBin_mm), false, found);
  return found;
}

class WallSearch {
 public:
  WallSearch(const AxisView& view, const WallQuery& query)
      : view_(view),
        query_(query),
        half_plane_(query.length_mm, 0.5 * query.diameter_mm, -rim_reach_mm(query.diameter_mm),
                    query.length_mm + rim_reach_mm(query.diameter_mm)) {
    sort_by_angle();
  }
  [[nodiscard]] TunnelWall run();

 private:
  struct Facet {
    const AxisTriangle* triangle;
    bool entry_lip, exit_lip;
  };
  struct Trial {
    double angle_rad;
    Thinnest thinnest;
  };
  void sort_by_angle();
  [[nodiscard]] Trial try_at(double angle_rad);
  void cut(const Facet& facet, const Vector2d& along, const Vector2d& across);

  const AxisView& view_;
  const WallQuery& query_;
  HalfPlane half_plane_;
  std::vector<Facet> facets_;
  std::vector<std::vector<std::int32_t>> by_angle_{static_cast<std::size_t>(kHalfPlanes)};
};

void WallSearch::sort_by_angle() {
  const auto in_view = [&](const Vector3d& v) {
    return Vector3d(v.dot(view_.direction_to_bone(Vector3d::UnitX())),
                    v.dot(view_.direction_to_bone(Vector3d::UnitY())), v.dot(query_.direction));
  };
  const Vector3d entry = in_view(query_.entry.normal), exit = in_view(query_.exit.normal);
  const auto add = [&](double angle, std::int32_t facet) {
    const int bucket = static_cast<int>(std::floor(angle / (2 * geometry::kPi) * kHalfPlanes));
    by_angle_[static_cast<std::size_t>((bucket % kHalfPlanes + kHalfPlanes) % kHalfPlanes)].push_back(facet);
  };
  constexpr double kBucket = 2 * geometry::kPi / kHalfPlanes;
  for (const AxisTriangle& triangle : view_.triangles()) {
    const Vector3d& n = triangle.normal;
    const auto index = static_cast<std::int32_t>(facets_.size());
    facets_.push_back({&triangle, -n.z() > kLeastFacing && n.dot(entry) > kLeastTurnCosine,
                       n.z() > kLeastFacing && n.dot(exit) > kLeastTurnCosine});
    if (triangle.nearest_mm <= 0) {
      for (auto& bucket : by_angle_) bucket.push_back(index);
      continue;
    }
    // A triangle beside the axis spans less than half a turn.
    const auto angle_of = [](const Vector3d& c) { return std::atan2(c.y(), c.x()); };
    const double start = angle_of(triangle.corners_mm[0]);
    double low = 0, high = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      double turn = angle_of(triangle.corners_mm[k]) - start;
      if (turn > geometry::kPi) turn -= 2 * geometry::kPi;
      if (turn < -geometry::kPi) turn += 2 * geometry::kPi;
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    const double first = std::floor((start + low) / kBucket) * kBucket;
    for (double angle = first + 0.5 * kBucket; angle < start + high + kBucket; angle += kBucket)
      add(angle, index);
  }
}

void WallSearch::cut(const Facet& facet, const Vector2d& along, const Vector2d& across) {
  const auto& corners = facet.triangle->corners_mm;
  std::array<double, 3> side{};
  for (std::size_t k = 0; k < 3; ++k) side[k] = across.dot(corners[k].head<2>());
  std::array<Vector2d, 2> ends;  // station, distance from the axis
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3 && count < 2; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((side[k] >= 0) == (side[next] >= 0)) continue;
    const double t = side[k] / (side[k] - side[next]);
    const Vector3d at = corners[k] + t * (corners[next] - corners[k]);
    ends[count++] = {at.z(), along.dot(at.head<2>())};
  }
  if (count < 2) return;
  if (ends[0].x() > ends[1].x()) std::swap(ends[0], ends[1]);
  if (ends[0].y() < 0 && ends[1].y() < 0) return;
  for (std::size_t k = 0; k < 2; ++k) {  // the half on this side of the axis
    if (ends[k].y() >= 0) continue;
    const Vector2d& other = ends[1 - k];
    ends[k] += (0 - ends[k].y()) / (other.y() - ends[k].y()) * (other - ends[k]);
    ends[k].y() = 0;
  }
  half_plane_.add({ends[0].x(), ends[1].x(), ends[0].y(), ends[1].y(), facet.triangle->normal.z() < 0,
                   along.dot(facet.triangle->normal.head<2>()) > 0, facet.entry_lip, facet.exit_lip,
                   facet.triangle});
}

// Of the triangle's point that is nearest to the axis; the fallback where the axis goes through it.
double nearest_angle(const AxisTriangle& triangle, double fallback_rad) {
  if (triangle.nearest_mm <= 0) return fallback_rad;
  Vector2d best = triangle.corners_mm[0].head<2>();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector2d from = triangle.corners_mm[k].head<2>(),
                   along = triangle.corners_mm[(k + 1) % 3].head<2>() - from;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp(-from.dot(along) / squared, 0.0, 1.0) : 0.0;
    const Vector2d at = from + t * along;
    if (at.squaredNorm() < best.squaredNorm()) best = at;
  }
  return std::atan2(best.y(), best.x());
}

WallSearch::Trial WallSearch::try_at(double angle_rad) {
  const Vector2d along(std::cos(angle_rad), std::sin(angle_rad)), across(-along.y(), along.x());
  const int bucket = static_cast<int>(std::floor(angle_rad / (2 * geometry::kPi) * kHalfPlanes));
  half_plane_.clear();
  for (const std::int32_t index :
       by_angle_[static_cast<std::size_t>((bucket % kHalfPlanes + kHalfPlanes) % kHalfPlanes)])
    cut(facets_[static_cast<std::size_t>(index)], along, across);
  return {angle_rad, half_plane_.thinnest()};
}

TunnelWall WallSearch::run() {
  double step = 2 * geometry::kPi / kHalfPlanes;
  std::vector<Trial> trials;
  for (int k = 0; k < kHalfPlanes; ++k) trials.push_back(try_at((k + 0.5) * step));
  const auto less = [](const Trial& a, const Trial& b) {
    return a.thinnest.radius_mm < b.thinnest.radius_mm;
  };
  // Around every trial that something thinner may stand beside: a surface at 45 deg to the half planes.
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double least = std::min_element(trials.begin(), trials.end(), less)->thinnest.radius_mm;
    if (!std::isfinite(least)) break;
    const double bound = least + step * least;
    step /= 2;
    std::vector<double> angles;
    for (const Trial& trial : trials) {
      if (trial.thinnest.radius_mm > bound) continue;
      angles.push_back(trial.angle_rad - step);
      angles.push_back(trial.angle_rad + step);
    }
    std::sort(angles.begin(), angles.end());
    angles.erase(
        std::unique(angles.begin(), angles.end(), [&](double a, double b) { return b - a < 0.01 * step; }),
        angles.end());
    if (trials.size() + angles.size() > static_cast<std::size_t>(kMostHalfPlanes)) break;
    for (const double angle : angles) trials.push_back(try_at(angle));
  }
  // A triangle may reach nearer to the axis between two half planes: where it does so is tried too.
  std::sort(trials.begin(), trials.end(), less);
  Trial best = trials.front();
  constexpr std::size_t kFollowed = 6;
  for (std::size_t k = 0; k < std::min(kFollowed, trials.size()); ++k) {
    Trial at = trials[k];
    for (int turn = 0; turn < 8 && at.thinnest.of; ++turn) {
      const Trial next = try_at(nearest_angle(*at.thinnest.of, at.angle_rad));
      if (!(next.thinnest.radius_mm < at.thinnest.radius_mm - 1e-6)) break;
      at = next;
    }
    if (less(at, best)) best = at;
  }
  TunnelWall wall;
  if (!std::isfinite(best.thinnest.radius_mm)) return wall;
  wall.is_known = true;
  wall.thickness_mm = best.thinnest.radius_mm - 0.5 * query_.diameter_mm;
  wall.station_mm = best.thinnest.station_mm;
  wall.at_mm = view_.to_bone({best.thinnest.radius_mm * std::cos(best.angle_rad),
                              best.thinnest.radius_mm * std::sin(best.angle_rad), best.thinnest.station_mm});
  return wall;
}

}  // namespace

double rim_reach_mm(double diameter_mm) {
  return 0.5 * diameter_mm * std::sqrt(1 - kLeastFacing * kLeastFacing) / kLeastFacing;
}

TunnelWall thinnest_wall(const AxisView& view, const WallQuery& query) {
  return WallSearch(view, query).run();
}

}  // namespace arthronaut::tunnels
