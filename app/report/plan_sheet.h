// The plan on one page: the true lateral view with its grid, the plateau, slices along each tunnel, and every
// check with its verdict in a word.
#pragma once

#include <vector>

#include "app/report/pdf_document.h"
#include "planning/cases/case.h"

namespace arthronaut::report {

struct Content;

struct SheetFrame {
  double left_mm = 20, top_mm = 28, width_mm = 170, bottom_mm = 285;
  double picture_px_per_mm = 12;  // of the bones' pictures
};

// Of which grafts a plan needs a sheet: of the single one, or of each bundle that a tunnel is planned for.
// Empty without a tunnel.
[[nodiscard]] std::vector<norms::Bundle> planned_grafts(const cases::Plan& plan);

// The tunnels of one graft: of each bone that of the bundle, else its single one; the others are thin lines.
// Draws on the last page, which is to be empty below frame.top_mm; where the checks would go below
// frame.bottom_mm they are set smaller. Slices show the case's images where it
// keeps some, else the outlines of the bones alone. Without a tunnel it says so. Throws IoError and
// InvalidInput when an image of the case can't be read, DeviceError when no picture of the plateau can be
// made.
void draw_plan_sheet(PdfDocument& pdf, const SheetFrame& frame, const Content& content, norms::Bundle graft);

}  // namespace arthronaut::report
