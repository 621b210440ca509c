// The sum of row * row^T over the rows of a least squares: eight rows at a time, and only the half below the
// diagonal, which takes a sixth of the time that one product after the other takes.
#pragma once

#include <Eigen/Core>

#include "navigation/markers/exposed_kernel.h"

namespace arthronaut::markers {

class ProductSum {
 public:
  using Square = Eigen::Matrix<float, kProductSize, kProductSize>;

  // Of a row's first `count` numbers, a multiple of eight; the others are zero.
  void add(const float (&rows)[kPixelsTogether][kProductSize], int count = kProductSize) {
    processor_has_avx2() ? add_products_avx2(rows, count, sum_) : add_products(rows, count, sum_);
  }
  // Of the rows so far; starts anew.
  [[nodiscard]] Square take() {
    // What is a row to the kernel is a column to Eigen.
    Square total = Eigen::Map<const Square>(&sum_[0][0]).selfadjointView<Eigen::Lower>();
    Eigen::Map<Square>(&sum_[0][0]).setZero();
    return total;
  }

 private:
  alignas(32) float sum_[kProductSize][kProductSize] = {};
};

}  // namespace arthronaut::markers
