// The parts that the three steps' screens share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "app/setup/station.h"
#include "app/widgets/picture_placement.h"
#include "app/widgets/video_texture.h"
#include "navigation/camera/camera_model.h"
#include "navigation/tools/pivot_calibration.h"

namespace arthronaut::setup {

// The picture on black, cut to the round view where that is known (radius 0: the whole of it); dimmed while
// it is not live.
widgets::PicturePlacement draw_picture(const widgets::Ui& ui, const widgets::Rect& area,
                                       widgets::VideoTexture& texture, const camera::FramePtr& picture,
                                       const camera::Boundary& view, bool is_live);

// Severity, headline and detail under the picture.
void draw_band(const widgets::Ui& ui, const widgets::Rect& area, const Band& band);

// Each row a status_row; what doesn't fit scrolls.
void draw_rows(const widgets::Ui& ui, const char* name, const widgets::Rect& area, std::string_view title,
               std::span<const Row> rows);

// Which way the lens stood in each picture taken, and stands now: the shaded sectors are too near to a
// picture taken. Angles as the mark's, degrees in image axes; now_deg NaN: not known.
void draw_lens_dial(const widgets::Ui& ui, const widgets::Rect& area, std::span<const double> taken_deg,
                    double now_deg, double too_near_deg);

// The outline of a marker on the picture; a dot on its top-left corner as printed.
void draw_marker(const widgets::Ui& ui, const widgets::PicturePlacement& place,
                 const std::array<Eigen::Vector2d, 4>& corners_px);

// How the shaft was tilted in each pose, as seen along its mean direction, with rings at 10, 20 and 30
// degrees and that which must be reached drawn brighter. Poses left out are hollow; the newest has a ring.
void draw_cone(const widgets::Ui& ui, const widgets::Rect& area, const tools::PivotCalibrationSummary& tip,
               double wanted_deg);

// How far a tool was turned, and how far it must be.
void draw_turn(const widgets::Ui& ui, const widgets::Rect& area, double turned_deg, double wanted_deg);

}  // namespace arthronaut::setup
