#include "navigation/calibration/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace arthronaut::calibration {
namespace {
constexpr std::array<std::pair<int, int>, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

// Corners side by side on one board: black and white change places, the contrast is alike (strength goes with
// its square), and the step from one to the other runs along an edge of both.
bool are_neighbours(const Saddle& a, const Saddle& b) {
  if (a.likeness(b) >= 0) return false;
  if (a.strength > 12 * b.strength || b.strength > 12 * a.strength) return false;
  const Eigen::Vector2d step = (b.pixel - a.pixel).normalized();
  for (const Saddle* s : {&a, &b}) {
    const double along = std::max(std::abs(step.dot(s->edge[0])), std::abs(step.dot(s->edge[1])));
    if (along < 0.93) return false;
  }
  return true;
}

}  // namespace

Lattice::Lattice(const std::vector<Saddle>& saddles) : saddles_(saddles), node_of_(saddles.size()) {}

void Lattice::place(const LatticeNode& node, int saddle) {
  saddle_at_[node] = saddle;
  node_of_[static_cast<std::size_t>(saddle)] = node;
}

int Lattice::neighbour_along(int from, const Eigen::Vector2d& direction) const {
  const Saddle& origin = saddles_[static_cast<std::size_t>(from)];
  int best = -1;
  double best_along = 1e9;
  for (int k = 0; k < static_cast<int>(saddles_.size()); ++k) {
    const Saddle& other = saddles_[static_cast<std::size_t>(k)];
    const Eigen::Vector2d d = other.pixel - origin.pixel;
    const double along = d.dot(direction);
    if (along < 5 || along > best_along) continue;
    if (std::abs(d.x() * direction.y() - d.y() * direction.x()) > 0.25 * along) continue;
    if (!are_neighbours(origin, other)) continue;
    best = k;
    best_along = along;
  }
  return best;
}

int Lattice::nearest(const Eigen::Vector2d& at, double within_px, int beside) const {
  const Saddle& from = saddles_[static_cast<std::size_t>(beside)];
  int best = -1;
  double best_square = within_px * within_px;
  for (int k = 0; k < static_cast<int>(saddles_.size()); ++k) {
    const double square = (saddles_[static_cast<std::size_t>(k)].pixel - at).squaredNorm();
    if (square >= best_square || !are_neighbours(from, saddles_[static_cast<std::size_t>(k)])) continue;
    best = k;
    best_square = square;
  }
  return best;
}

std::optional<Eigen::Vector2d> Lattice::predict(const LatticeNode& from, int dc, int dr) const {
  const auto pixel = [&](int c, int r) -> std::optional<Eigen::Vector2d> {
    const auto it = saddle_at_.find({from.first + c, from.second + r});
    if (it == saddle_at_.end()) return std::nullopt;
    return saddles_[static_cast<std::size_t>(it->second)].pixel;
  };
  const Eigen::Vector2d here = *pixel(0, 0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  if (const auto back = pixel(-dc, -dr)) {
    Eigen::Vector2d step = here - *back;
    // The spacing changes along a row: half of the last change is a cautious guess of the next.
    if (const auto further = pixel(-2 * dc, -2 * dr)) step += 0.5 * (step - (*back - *further));
    sum += here + step;
    ++count;
  }
  for (const int side : {-1, 1}) {
    const auto beside = pixel(side * dr, side * dc), ahead = pixel(dc + side * dr, dr + side * dc);
    if (!beside || !ahead) continue;
    sum += here + (*ahead - *beside);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

bool Lattice::grow_once(double tolerance) {
  std::vector<LatticeNode> border;
  for (const auto& [node, saddle] : saddle_at_) border.push_back(node);
  bool grew = false;
  for (const LatticeNode& node : border)
    for (const auto& [dc, dr] : kSteps) {
      const LatticeNode next{node.first + dc, node.second + dr};
      if (saddle_at_.count(next)) continue;
      const auto expected = predict(node, dc, dr);
      if (!expected) continue;
      const int from = saddle_at_.at(node);
      const double step_px = (*expected - saddles_[static_cast<std::size_t>(from)].pixel).norm();
      if (step_px < 5) continue;
      const int found = nearest(*expected, tolerance * step_px, from);
      if (found < 0 || is_used(found)) continue;
      place(next, found);
      grew = true;
    }
  return grew;
}

bool Lattice::grow_from(int seed) {
  saddle_at_.clear();
  std::fill(node_of_.begin(), node_of_.end(), std::nullopt);
  place({0, 0}, seed);
  const Saddle& origin = saddles_[static_cast<std::size_t>(seed)];
  std::array<double, 4> distance{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d direction = (k < 2 ? 1.0 : -1.0) * origin.edge[k % 2];
    const int found = neighbour_along(seed, direction);
    if (found < 0 || is_used(found)) return false;
    distance[k] = (saddles_[static_cast<std::size_t>(found)].pixel - origin.pixel).norm();
    place({kSteps[k].first, kSteps[k].second}, found);
  }
  for (std::size_t k = 0; k < 2; ++k)
    if (distance[k] > 1.8 * distance[k + 2] || distance[k + 2] > 1.8 * distance[k]) return false;
  for (const double tolerance : {0.15, 0.25})
    while (grow_once(tolerance)) {
    }
  return true;
}

}  // namespace arthronaut::calibration
