// The pixels of a direct fit, eight to a block as its kernel takes them. Keeps its memory from fit to fit.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

#include "navigation/markers/exposed_kernel.h"

namespace arthronaut::markers {

class PixelBlocks {
 public:
  struct Pixel {
    Eigen::Vector3f ray;
    float grey = 0;
    float sigma_x = 1, sigma_y = 1;  // of the optics' smear along the marker's axes, in cells
    Eigen::Vector2f place;           // on the marker, -1 to 1
    int edge = 0;                    // the edge of one cell that it belongs to
  };
  struct Block {
    LookedAt at;
    SeenPixels seen;
    int edge[kPixelsTogether];
  };

  explicit PixelBlocks(int likely_pixels) {
    blocks_.reserve(static_cast<std::size_t>(likely_pixels / kPixelsTogether + 1));
  }
  void clear() {
    blocks_.clear();
    count_ = 0;
  }
  // With weight 1. The lanes behind it are its doubles until they are taken.
  void add(const Pixel& pixel) {
    const int first = count_++ % kPixelsTogether;
    if (first == 0) blocks_.emplace_back();
    Block& block = blocks_.back();
    for (int lane = first; lane < kPixelsTogether; ++lane) {
      block.at.ray_x[lane] = pixel.ray.x();
      block.at.ray_y[lane] = pixel.ray.y();
      block.at.ray_z[lane] = pixel.ray.z();
      block.at.sigma_x[lane] = pixel.sigma_x;
      block.at.sigma_y[lane] = pixel.sigma_y;
      block.seen.grey[lane] = pixel.grey;
      block.seen.place_x[lane] = pixel.place.x();
      block.seen.place_y[lane] = pixel.place.y();
      block.seen.weight[lane] = 1;
      block.edge[lane] = pixel.edge;
    }
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
  [[nodiscard]] const SeenPixels& seen(int pixel) const { return blocks_[pixel / kPixelsTogether].seen; }
  [[nodiscard]] float& weight(int pixel) {
    return blocks_[pixel / kPixelsTogether].seen.weight[pixel % kPixelsTogether];
  }

 private:
  std::vector<Block> blocks_;
  int count_ = 0;
};

}  // namespace arthronaut::markers
