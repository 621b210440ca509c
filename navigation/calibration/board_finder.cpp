#include <algorithm>
#include <cmath>
#include <map>

#include "navigation/calibration/calibration.h"
#include "navigation/calibration/conformal_map.h"
#include "navigation/calibration/lattice.h"
#include "navigation/calibration/saddles.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {
namespace {

constexpr int kFewestCorners = 16;

using PixelAt = std::map<LatticeNode, Eigen::Vector2d>;

std::optional<ConformalMap> map_of(const PixelAt& corners) {
  std::vector<Eigen::Vector2d> pixels, plane;
  for (const auto& [node, pixel] : corners) {
    pixels.push_back(pixel);
    plane.emplace_back(node.first, node.second);
  }
  return fit_conformal_map(pixels, plane);
}

// Distance of each corner from where the map of all of them puts it, px.
std::map<LatticeNode, double> misfits(const PixelAt& corners, const ConformalMap& map) {
  std::map<LatticeNode, double> result;
  for (const auto& [node, pixel] : corners) {
    const auto expected = map.pixel_from_plane({node.first, node.second}, pixel);
    result[node] = expected ? (*expected - pixel).norm() : 1e9;
  }
  return result;
}

// Takes out what the rest does not support: mis-indexed or chance saddles. False when nothing consistent
// remains.
bool prune(PixelAt& corners, double least_limit_px, int passes = 6) {
  for (int pass = 0; pass < passes; ++pass) {
    const auto map = map_of(corners);
    if (!map) return false;
    const auto misfit = misfits(corners, *map);
    std::vector<double> values;
    for (const auto& [node, px] : misfit) values.push_back(px);
    const double limit = std::max(least_limit_px, 5 * geometry::median(values, 0));
    const std::size_t before = corners.size();
    std::erase_if(corners, [&](const auto& item) { return misfit.at(item.first) > limit; });
    if (corners.size() < kFewestCorners) return false;
    if (corners.size() == before) return true;
  }
  return true;
}

// The largest consistent lattice of all seeds tried; strong saddles first, as they are seldom chance.
PixelAt largest_lattice(const std::vector<Saddle>& saddles, std::size_t& most_grown) {
  Lattice lattice(saddles);
  PixelAt best;
  std::vector<bool> tried(saddles.size(), false);
  int fruitless = 0;
  for (int seed = 0; seed < static_cast<int>(saddles.size()) && fruitless < 150; ++seed) {
    if (tried[static_cast<std::size_t>(seed)]) continue;
    if (!lattice.grow_from(seed) || lattice.nodes().size() <= best.size()) {
      ++fruitless;
      continue;
    }
    PixelAt grown;
    for (const auto& [node, saddle] : lattice.nodes()) {
      grown[node] = saddles[static_cast<std::size_t>(saddle)].pixel;
      tried[static_cast<std::size_t>(saddle)] = true;
    }
    most_grown = std::max(most_grown, grown.size());
    if (!prune(grown, 3.0) || grown.size() <= best.size()) continue;
    best = std::move(grown);
    if (best.size() > saddles.size() / 2) break;
  }
  return best;
}

// Shortest distance to a neighbour on the lattice, from the map.
double spacing_px(const ConformalMap& map, const LatticeNode& node, const Eigen::Vector2d& pixel) {
  double least = 1e9;
  for (const auto& [dc, dr] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const auto beside = map.pixel_from_plane({node.first + dc, node.second + dr}, pixel);
    if (beside) least = std::min(least, (*beside - pixel).norm());
  }
  return least;
}

// Looks for the neighbours that growing missed (dim, blurred, at the edge of the view) where the map expects
// them.
bool add_expected(PixelAt& corners, const SmoothPicture& picture) {
  const auto map = map_of(corners);
  if (!map) return false;
  PixelAt added;
  for (const auto& [node, pixel] : corners)
    for (const auto& [dc, dr] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const LatticeNode next{node.first + dc, node.second + dr};
      if (corners.count(next) || added.count(next)) continue;
      const auto expected = map->pixel_from_plane({next.first, next.second}, pixel);
      if (!expected || !picture.has(expected->x(), expected->y(), 8)) continue;
      const double step = (*expected - pixel).norm();
      if (step < 6 || !looks_like_corner(picture, *expected, std::clamp(0.3 * step, 2.5, 6.0), 6)) continue;
      const auto found = refine_corner(picture, *expected, std::clamp(0.3 * step, 2.0, 5.0));
      if (found && (found->pixel - *expected).norm() < std::min(2.0, 0.15 * step)) added[next] = found->pixel;
    }
  corners.insert(added.begin(), added.end());
  return !added.empty();
}

// Rows and columns that hold at least three corners side by side: a plane's worth of lattice, not a strip.
bool spans_a_plane(const PixelAt& corners) {
  int low_c = 1 << 20, high_c = -low_c, low_r = low_c, high_r = -low_c;
  for (const auto& [node, pixel] : corners) {
    low_c = std::min(low_c, node.first);
    high_c = std::max(high_c, node.first);
    low_r = std::min(low_r, node.second);
    high_r = std::max(high_r, node.second);
  }
  return high_c - low_c >= 2 && high_r - low_r >= 2;
}

// Squares are of one brightness up to their corners; the gaps between dots, which form a lattice too, are
// not.
bool has_flat_squares(const PixelAt& corners, const SmoothPicture& picture) {
  std::vector<double> unlike;
  for (const auto& [node, pixel] : corners) {
    const auto right = corners.find({node.first + 1, node.second});
    const auto below = corners.find({node.first, node.second + 1});
    const auto across = corners.find({node.first + 1, node.second + 1});
    const auto left = corners.find({node.first - 1, node.second});
    const auto left_below = corners.find({node.first - 1, node.second + 1});
    const auto end = corners.end();
    if (right == end || below == end || across == end || left == end || left_below == end) continue;
    const Eigen::Vector2d middle = 0.25 * (pixel + right->second + below->second + across->second);
    const Eigen::Vector2d other = 0.25 * (pixel + left->second + below->second + left_below->second);
    const Eigen::Vector2d near_corner = pixel + 0.4 * (middle - pixel);
    if ((near_corner - pixel).norm() < 4) continue;  // too small for blur to leave anything flat
    const double contrast = picture.bilinear(middle.x(), middle.y()) - picture.bilinear(other.x(), other.y());
    const double rise =
        picture.bilinear(near_corner.x(), near_corner.y()) - picture.bilinear(other.x(), other.y());
    if (std::abs(contrast) > 5) unlike.push_back(std::abs(rise / contrast - 1));
  }
  return unlike.size() < 6 || geometry::median(unlike) < 0.3;
}

}  // namespace

BoardDetection find_checkerboard(const camera::GrayView& picture) {
  BoardDetection detection;
  if (picture.width < 64 || picture.height < 64) {
    detection.reason = "the picture is too small";
    return detection;
  }
  const std::vector<Saddle> saddles = find_saddles(picture);
  std::size_t most_grown = 0;
  PixelAt corners = largest_lattice(saddles, most_grown);
  if (corners.size() < kFewestCorners || !spans_a_plane(corners)) {
    detection.reason = "no checkerboard was found in it (" + std::to_string(saddles.size()) +
                       " places look like corners, no more than " + std::to_string(most_grown) +
                       " of them lie in rows and columns)";
    return detection;
  }
  const SmoothPicture fine = smoothed(picture, 0.7);
  // Indices first, with room for the error of unrefined saddles; then sub-pixel; then the corners still
  // missing.
  std::map<LatticeNode, double> sigma_px;
  bool consistent = true;
  for (int pass = 0; consistent && pass < 30 && add_expected(corners, fine); ++pass)
    consistent = prune(corners, 3.0, 1);
  if (consistent) {
    const auto map = map_of(corners);
    PixelAt refined;
    std::size_t lopsided = 0;
    sigma_px.clear();
    for (const auto& [node, pixel] : corners) {
      const double half_window = std::clamp(0.32 * spacing_px(*map, node, pixel), 2.0, 9.0);
      auto better = refine_corner(fine, pixel, half_window);
      // Halos and shading spoil a large neighbourhood first.
      if (!better && half_window > 3.5) better = refine_corner(fine, pixel, 0.55 * half_window, 0.5);
      // Still a corner, though lopsided: its saddle will do, and says that it is less exact.
      const double ring = std::clamp(half_window, 2.5, 6.0);
      if (!better && looks_like_corner(fine, pixel, ring, 10)) {
        better = RefinedCorner{pixel, 0.5};
        ++lopsided;
      }
      if (!better) continue;
      refined[node] = better->pixel;
      sigma_px[node] = better->sigma_px;
    }
    corners = std::move(refined);
    // Small squares beside the rim make a third of a board's corners lopsided; of a pattern that is no board,
    // most.
    consistent = corners.size() >= kFewestCorners && lopsided < corners.size() / 2 && prune(corners, 1.5);
  }
  if (!consistent) {
    detection.reason = "what looks like corners does not lie on one flat lattice";
    return detection;
  }
  if (!has_flat_squares(corners, fine)) {
    detection.reason = "the pattern is a lattice, but not of squares that touch at their corners";
    return detection;
  }
  for (const auto& [node, pixel] : corners)
    detection.corners.push_back({{node.first, node.second}, pixel, sigma_px.at(node)});
  return detection;
}

}  // namespace arthronaut::calibration
