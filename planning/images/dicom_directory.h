// DICOMDIR: the table of contents of a disc or a folder (DICOM PS3.3, annex F). Inner header of images.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace arthronaut::images {

// The files of all images that the directory leads to, in its order; nullopt for a DICOM file that is no
// directory. Records that are no longer in use are left out; which series an image is of is read from the
// image.
//
// Throws InvalidInput: a broken directory, one that leads in circles, a name that leads out of its folder, or
// a file that is not there (a disc copied in part). The names' case does not matter, as discs are copied.
[[nodiscard]] std::optional<std::vector<std::filesystem::path>> images_of_dicom_directory(
    const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace arthronaut::images
