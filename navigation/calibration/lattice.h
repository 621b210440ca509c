// Orders saddles into the rows and columns of a checkerboard, from one seed outwards. Inside the module.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "navigation/calibration/saddles.h"

namespace arthronaut::calibration {

using LatticeNode = std::pair<int, int>;  // column, row

class Lattice {
 public:
  explicit Lattice(const std::vector<Saddle>& saddles);

  // Grows from a saddle that has a neighbour in all four directions; false when it has not.
  bool grow_from(int seed);
  [[nodiscard]] const std::map<LatticeNode, int>& nodes() const { return saddle_at_; }
  [[nodiscard]] bool is_used(int saddle) const {
    return node_of_[static_cast<std::size_t>(saddle)].has_value();
  }

 private:
  [[nodiscard]] int neighbour_along(int from, const Eigen::Vector2d& direction) const;
  [[nodiscard]] int nearest(const Eigen::Vector2d& at, double within_px, int beside) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> predict(const LatticeNode& from, int dc, int dr) const;
  void place(const LatticeNode& node, int saddle);
  bool grow_once(double tolerance);

  const std::vector<Saddle>& saddles_;
  std::map<LatticeNode, int> saddle_at_;
  std::vector<std::optional<LatticeNode>> node_of_;
};

}  // namespace arthronaut::calibration
