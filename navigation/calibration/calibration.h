// Calibration of an arthroscope from three or more pictures of a checkerboard, the lens turned in between.
// Source: conformal closed form of each picture, then one joint adjustment (one focal length, one distortion,
// one principal point that turns about one centre, the mark's angle of each picture). See
// docs/conventions.md.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "navigation/camera/camera_file.h"
#include "navigation/camera/frame.h"
#include "navigation/lens/lens_tracker.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::calibration {

struct BoardCorner {
  Eigen::Vector2i lattice;  // column, row; the origin is arbitrary in each picture
  Eigen::Vector2d pixel;    // sub-pixel
  double sigma_px = 0.12;   // how exact against the other corners: small, dim and blurred squares give less
};

struct BoardDetection {
  std::vector<BoardCorner> corners;  // empty when no board was found
  std::string reason;                // why not, in plain words; empty when found
  [[nodiscard]] bool found() const { return !corners.empty(); }
};

// The inner corners of a checkerboard that may run past the view, under strong barrel distortion, glare and
// blur; no count of squares is given.
[[nodiscard]] BoardDetection find_checkerboard(const camera::GrayView& picture);

struct CalibrationPicture {
  std::string name;
  Eigen::Vector2i size_px;
  BoardDetection board;
  lens::LensObservation lens;
};

struct CalibrationOptions {
  double square_mm = 0;           // required, > 0
  double refractive_index = 1.0;  // of the medium the pictures were taken in
  std::string scope_name, head_name;
  // How far the boards stood from the lens, about, when somebody measured it; 0: nobody did. Nothing else can
  // tell a square size that is wrong by less than the working distance varies.
  double distance_mm = 0;
  bool leave_one_out = true;
};

struct CalibrationSummary {
  enum class Outcome { NotRun, Ok, Unreliable, Failed } outcome = Outcome::NotRun;
  std::vector<std::string> reasons;  // why it is unreliable or failed, in plain words
  // What else is worth knowing though it does no harm: a picture without a mark, with the lens angle that the
  // others give it.
  std::vector<std::string> notes;
  camera::CalibrationRecord record;  // meaningful unless Failed
  double rms_px = -1;                // over all corners
  double leave_one_out_rms_px = -1;  // -1 when not computed, or in vain: then a reason says so
  double distance_mm = -1;           // of the boards from the lens along its axis, in the median
  struct Picture {
    std::string name;
    double rms_px = -1;
    double tilt_deg = 0;
    double lens_angle_deg = 0;
    lens::MarkState mark = lens::MarkState::NoCircle;
    bool mark_is_used = false;  // else lens_angle_deg follows from the other pictures
    geometry::RigidTransform camera_from_board;
    std::vector<Eigen::Vector2d> residuals_px;  // in the order of corners_used()
  };
  std::vector<Picture> pictures;
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Ok || outcome == Outcome::Unreliable; }
};

// Detects board, circle and mark in one picture.
[[nodiscard]] CalibrationPicture observe_picture(const std::string& name, const camera::GrayView& picture);

// The corners of a picture that calibrate() uses: those clear of the rim, which pulls at what lies beside it.
[[nodiscard]] std::vector<BoardCorner> corners_used(const CalibrationPicture& picture);

// Throws InvalidInput when the options or the pictures break the contract (fewer than three, different sizes,
// no board: the message names the picture). Poor geometry (fronto-parallel, no rotation, implausible
// distance) is an outcome with reasons, not an exception.
[[nodiscard]] CalibrationSummary calibrate(std::span<const CalibrationPicture> pictures,
                                           const CalibrationOptions& options);

}  // namespace arthronaut::calibration
