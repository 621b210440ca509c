#include "planning/postop/wall_outside.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "planning/postop/wall_voxels.h"

namespace arthronaut::postop {

namespace {

constexpr double kNode_mm = 0.25;
// Cells tell each other of their depths, the less the further apart.
constexpr double kAlong_mm = 2, kAroundOfTurn = 1.0 / 8;
// Where few voxels tell of a depth nearby, the mean of all of that depth counts as so many.
constexpr double kPriorVoxels = 20;
constexpr double kMostRest_hu = 300;
// Of what cells may be off by.
constexpr double kLeastLevelOff_hu = 3, kLeastDepthOff_mm = 0.15, kMostDepthOff_mm = 1;

struct NodesAt {
  std::size_t node;
  double up;
};
NodesAt nodes_at(double depth_mm) {
  const double at = std::clamp(depth_mm, 0.0, kDeep_mm) / kNode_mm;
  const auto node = static_cast<std::size_t>(at);
  return {node, at - static_cast<double>(node)};
}

double falling(double apart) { return std::exp(-0.5 * apart * apart); }

}  // namespace

void WallOutside::clear() {
  offs_.assign(offs_.size(), {});
  nodes_.assign(nodes_.size(), {});
  added_.clear();
}

void WallOutside::add(std::size_t cell, double depth_mm, double hu) {
  const auto [node, up] = nodes_at(depth_mm);
  nodes_[cell * kNodes + node].add({hu, 1}, 1 - up);
  nodes_[cell * kNodes + node + 1].add({hu, 1}, up);
  added_.push_back({cell, depth_mm, hu});
}

void WallOutside::settle(double noise_hu) {
  static_assert(kDeep_mm / kNode_mm + 1 < kNodes);
  const std::vector<double> mean = mean_by_depth();
  smooth();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    nodes_[i].sum = (nodes_[i].sum + kPriorVoxels * mean[i % kNodes]) / (nodes_[i].weight + kPriorVoxels);
  explain_rest(noise_hu);
}

// Of depths that nothing tells of: as of the next one.
std::vector<double> WallOutside::mean_by_depth() const {
  std::vector<Node> all(kNodes);
  for (std::size_t i = 0; i < nodes_.size(); ++i) all[i % kNodes].add(nodes_[i], 1);
  std::vector<double> mean(kNodes);
  const auto told =
      std::ranges::find_if(all.rbegin(), all.rend(), [](const Node& node) { return node.weight > 1; });
  double last = told == all.rend() ? 0 : told->sum / told->weight;
  for (std::size_t k = kNodes; k-- > 0;) {
    if (all[k].weight > 1) last = all[k].sum / all[k].weight;
    mean[k] = last;
  }
  return mean;
}

void WallOutside::smooth() {
  const auto steps = static_cast<std::ptrdiff_t>(offs_.size() / kSectors);
  constexpr auto kTurn = static_cast<std::ptrdiff_t>(kSectors);
  constexpr double kAround = kAroundOfTurn * kSectors, kAlong = kAlong_mm / kStep_mm;
  const auto each = [&](auto&& does) {
    for (std::ptrdiff_t step = 0; step < steps; ++step)
      for (std::ptrdiff_t sector = 0; sector < kTurn; ++sector) does(step, sector);
  };
  std::vector<Node> around(nodes_.size());
  const auto add = [](std::vector<Node>& to, std::ptrdiff_t to_cell, const std::vector<Node>& from,
                      std::ptrdiff_t from_cell, double share) {
    for (std::size_t k = 0; k < kNodes; ++k)
      to[static_cast<std::size_t>(to_cell) * kNodes + k].add(
          from[static_cast<std::size_t>(from_cell) * kNodes + k], share);
  };
  each([&](std::ptrdiff_t step, std::ptrdiff_t sector) {
    for (std::ptrdiff_t off = -kTurn / 2 + 1; off < kTurn / 2; ++off)
      add(around, step * kTurn + sector, nodes_, step * kTurn + (sector + off + kTurn) % kTurn,
          falling(static_cast<double>(off) / kAround));
  });
  nodes_.assign(nodes_.size(), {});
  constexpr auto kReach = static_cast<std::ptrdiff_t>(3.5 * kAlong);
  each([&](std::ptrdiff_t step, std::ptrdiff_t sector) {
    for (std::ptrdiff_t other = std::max<std::ptrdiff_t>(0, step - kReach);
         other < std::min(steps, step + kReach + 1); ++other)
      add(nodes_, step * kTurn + sector, around, other * kTurn + sector,
          falling(static_cast<double>(other - step) / kAlong));
  });
}

// The square of what is left is that of the noise, of levels that differ, and of depths that differ times how
// steep the grey is there.
void WallOutside::explain_rest(double noise_hu) {
  double n = 0, steep = 0, steep_steep = 0, rest = 0, steep_rest = 0;
  for (const auto& [cell, depth_mm, hu] : added_) {
    const Grey grey = at(cell, depth_mm);
    const double square = std::pow(std::min(kMostRest_hu, std::abs(hu - grey.hu)), 2) - noise_hu * noise_hu,
                 x = grey.steep * grey.steep;
    n += 1;
    steep += x;
    steep_steep += x * x;
    rest += square;
    steep_rest += x * square;
  }
  const double spread = n * steep_steep - steep * steep;
  double depth = spread > 1e-9 ? (n * steep_rest - steep * rest) / spread : 0;
  double level = n > 0 ? (rest - std::max(0.0, depth) * steep) / n : 0;
  if (level < 0) {
    level = 0;
    depth = steep_steep > 1e-9 ? steep_rest / steep_steep : 0;
  }
  level_variance_ = std::max(kLeastLevelOff_hu * kLeastLevelOff_hu, level);
  depth_variance_ =
      std::clamp(depth, kLeastDepthOff_mm * kLeastDepthOff_mm, kMostDepthOff_mm * kMostDepthOff_mm);
}

WallOutside::Grey WallOutside::at(std::size_t cell, double depth_mm) const {
  const Off& off = offs_[cell];
  const auto [node, up] = nodes_at(depth_mm + off.depth_mm);
  const double a = nodes_[cell * kNodes + node].sum, b = nodes_[cell * kNodes + node + 1].sum;
  const bool is_deep = depth_mm + off.depth_mm >= kDeep_mm;
  return {off.hu + a + up * (b - a), is_deep ? 0 : (b - a) / kNode_mm};
}

void WallOutside::move(std::size_t cell, const Off& by) {
  Off& off = offs_[cell];
  off.hu += by.hu;
  off.depth_mm = std::clamp(off.depth_mm + by.depth_mm, -kMostDepthOff_mm, kMostDepthOff_mm);
}

OwnOfCell::OwnOfCell(Eigen::Index numbers, const WallOutside& outside, std::size_t cell)
    : with_others(Eigen::MatrixX2d::Zero(numbers, 2)),
      normal(outside.certainty().asDiagonal()),
      right(-outside.certainty().cwiseProduct(
          Eigen::Vector2d(outside.off(cell).hu, outside.off(cell).depth_mm))) {}

void OwnOfCell::take_out_of(Eigen::MatrixXd& of_normal, Eigen::VectorXd& of_right) const {
  const Eigen::MatrixX2d share = with_others * normal.inverse();
  of_normal -= share * with_others.transpose();
  of_right -= share * right;
}

WallOutside::Off OwnOfCell::best() const {
  const Eigen::Vector2d by = normal.inverse() * right;
  return {by[0], by[1]};
}

}  // namespace arthronaut::postop
