// What is painted, kept in the case's folder, so that a crash loses at most what a hand has not finished:
// painting/strokes.nrrd and painting/bones.nrrd, label maps that other programs open as segmentations.
#pragma once

#include <filesystem>
#include <optional>

#include "planning/images/volume.h"
#include "planning/painting/label_change.h"

namespace arthronaut::painting {

struct SavedPainting {
  Labels strokes, bones;
};

[[nodiscard]] std::filesystem::path strokes_file(const std::filesystem::path& case_folder);
[[nodiscard]] std::filesystem::path bones_file(const std::filesystem::path& case_folder);

// Each file is replaced atomically. Throws IoError; what could not be written is as before.
void save_painting(const std::filesystem::path& case_folder, const images::Volume& grid,
                   const SavedPainting& painting);

// nullopt when nothing was painted. A file of the two that is missing is one in which nothing is painted.
// Throws IoError or InvalidInput (file, place, reason): a broken file, one of another grid.
[[nodiscard]] std::optional<SavedPainting> load_painting(const std::filesystem::path& case_folder,
                                                         const images::Volume& grid);

}  // namespace arthronaut::painting
