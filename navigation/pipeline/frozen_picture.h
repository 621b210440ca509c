// Whether a source shows the same content again and again: a camera, a tower or a capture card that hangs on
// its last picture. That picture need not be the same byte for byte: coded anew it differs in every few
// frames.
//
// What a live picture has and a frozen one has not is noise. Every sensor gives each pixel another value in
// every frame; a codec that sees the same picture again repeats the one before, but for key frames and a
// little refinement. So the luma is compared on every so many rows, tile by tile (16 x 8 tiles): a frame
// repeats the one before when no tile differs by more than a share of the source's own noise, and the picture
// is frozen when for frozen_after_s four frames in five did so and no tile has left where it stood. One tile
// that moves, such as that of a probe's tip, is a live picture.
//
// What it cannot tell apart: a scope held still to a fraction of a pixel without any noise (an exact
// renderer, a codec so coarse that it removed the noise) looks just like a frozen picture and is called one.
// That is the safe side, and a hand never holds so still.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/pipeline/picture_seam.h"
#include "navigation/pipeline/repeated_pictures.h"
#include "navigation/pipeline/standing_parts.h"
#include "navigation/pipeline/torn_picture.h"

namespace arthronaut::pipeline {

// Stateful over the frames of one source; one thread at a time; deterministic. Allocates nothing after the
// first frame of a size.
class FrozenPicture {
 public:
  explicit FrozenPicture(double frozen_after_s) : frozen_after_s_(frozen_after_s) {}

  // Frames in order of time; one that runs backwards begins anew. True while the picture is frozen. A frame
  // in which a tile left its place ends it at once; one that is only noisy again, after a fifth of
  // frozen_after_s.
  bool observe(const camera::GrayView& picture, std::int64_t timestamp_ns);

  // Of the newest frame; false for the first.
  struct Signs {
    bool is_blank = false;          // one grey all over: no light, or no signal
    bool is_torn = false;           // see torn_picture.h
    bool is_repeating = false;      // perhaps about to freeze: see repeated_pictures.h
    double repeat_share = 0;        // of the frames of the last 0.4 s
    std::int64_t shown_for_ns = 0;  // see RepeatedPictures::shown_for_ns
  };
  [[nodiscard]] const Signs& signs() const { return signs_; }
  // Whether what lies within these corners stands still while the picture as a whole goes on: it is not of
  // the newest frame's moment (see standing_parts.h).
  [[nodiscard]] bool stands_still(std::span<const Eigen::Vector2d> corners_px) const;
  // The noise of the source in grey values, mean difference of two frames; -1 before it is known.
  [[nodiscard]] double noise() const { return noise_; }

 private:
  static constexpr int kColumns = TornPicture::kColumns, kRows = TornPicture::kRows;
  using Tiles = std::array<float, static_cast<std::size_t>(kColumns) * kRows>;

  void sample(const camera::GrayView& picture);
  [[nodiscard]] Tiles difference(const std::vector<std::uint8_t>& other) const;
  void learn_noise(Tiles step);
  [[nodiscard]] bool is_blank() const;

  double frozen_after_s_;
  int width_ = 0, height_ = 0, row_count_ = 0;
  std::vector<std::uint8_t> now_, before_, anchor_;  // the sampled rows
  std::int64_t anchor_ns_ = 0, last_ns_ = 0;         // since when no tile has left its place
  double noise_ = -1;
  bool is_frozen_ = false;
  PictureSeam seam_;
  StandingParts standing_;
  TornPicture torn_;
  RepeatedPictures repeated_;
  Signs signs_;
};

}  // namespace arthronaut::pipeline
