// The rows of poses.csv, body by body: in the place of the rows of a body's several markers one row of its
// pose, named by the id of its first marker. For what reads poses.csv and knows tools.json.
#pragma once

#include <filesystem>
#include <vector>

#include "navigation/strokes/poses_file.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::strokes {

// Rows of markers that no body declares, and of bodies of one marker that is their frame, stay as they are.
// poses.csv says neither covariances nor the camera: each marker counts as a square does whose corners are
// all seen equally well, by a lens without distortion, which gives all but the same pose as the frame itself
// did. Where a body's markers disagree (markers/body_pose.h) by more than corners off by 0.15 px at a focal
// length of 600 px can, it has no row in that frame; it may have had a pose there while the frame was at
// hand, or none. One of them that did not lie where the others had it makes no row alone in a later frame,
// until it agrees with another again (markers/seen_bodies.h). Rows in order of frames.
[[nodiscard]] std::vector<PoseRow> body_rows(const std::vector<PoseRow>& rows, const tools::ToolSet& tools);

// Throws InvalidInput (file, line, reason) where a pose was found of a marker of another size than the tools
// say: pose and tools are then in different proportions, and nothing that is computed of both is right. Rows
// that say no size pass. The rows are as read, one a line of the file.
void require_sizes(const std::vector<PoseRow>& rows, const tools::ToolSet& tools,
                   const std::filesystem::path& file);

// The id that names the body which carries this marker; the marker's own where no body of several does.
[[nodiscard]] int body_id_of(int marker_id, const tools::ToolSet& tools);

}  // namespace arthronaut::strokes
