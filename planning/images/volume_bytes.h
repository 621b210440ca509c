// What the readers of the single volume formats share. Inner header of images: others include volume_file.h.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planning/images/volume.h"
#include "planning/images/volume_file.h"

namespace arthronaut::images {

enum class Scalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };
[[nodiscard]] std::size_t bytes_per(Scalar type);
[[nodiscard]] double decoded(Scalar type, std::endian order, const char* bytes);

// Of 3D Slicer's segmentations, by the header alone, which ends in `text`. Throws InvalidInput.
[[nodiscard]] std::vector<std::string> nrrd_segment_names(const std::filesystem::path& file,
                                                          std::string_view text);

// `text` is the whole file. Throw InvalidInput.
[[nodiscard]] Volume parse_nifti(const std::filesystem::path& file, std::string_view text,
                                 std::size_t most_bytes);
[[nodiscard]] Volume parse_nrrd(const std::filesystem::path& file, std::string_view text,
                                std::size_t most_bytes);
[[nodiscard]] Volume parse_metaimage(const std::filesystem::path& file, std::string_view text,
                                     std::size_t most_bytes);
// `source` is a folder, a DICOMDIR or an enhanced DICOM file. Throws IoError too.
[[nodiscard]] Volume read_dicom(const std::filesystem::path& source, const VolumeFileOptions& options);

enum class Compression { GzipOrZlib, Raw };
// Throws InvalidInput when the data are broken, cut off, or longer than `most_bytes`.
[[nodiscard]] std::string inflated(const std::filesystem::path& file, std::string_view compressed,
                                   std::size_t most_bytes, Compression compression = Compression::GzipOrZlib);
// No more than the first `count` bytes; what follows them is not looked at.
[[nodiscard]] std::string inflated_start(const std::filesystem::path& file, std::string_view compressed,
                                         std::size_t count);

// The number of voxels that a header announces; asked for before anything of that size is allocated. Throws
// InvalidInput when an axis is below 1, or when the values and the stored bytes that they are made of need
// more than `most_bytes`.
[[nodiscard]] std::size_t checked_voxel_count(const std::filesystem::path& file, const Eigen::Vector3i& size,
                                              std::size_t stored_bytes_per_voxel, std::size_t most_bytes);

// The longest data file or unpacked text that may hold so many bytes of voxels: with a little behind them, as
// some programs write.
[[nodiscard]] inline std::size_t most_stored_bytes(std::size_t voxel_bytes) {
  return voxel_bytes + (std::size_t{1} << 20);
}

// Tells whoever waits; the fraction grows from 0 to 1.
void report(const VolumeFileOptions& options, double fraction);

struct Samples {
  Scalar type = Scalar::Int16;
  std::endian order = std::endian::little;
  double slope = 1, intercept = 0;
};
// Sets the volume's values from the bytes; needs a size that was checked. Throws InvalidInput when there are
// too few bytes.
void set_values(Volume& volume, const std::filesystem::path& file, std::string_view bytes,
                const Samples& samples);

// Refuses a singular or not finite geometry, puts the least finite value where there is none and notes it,
// and decides the modality.
void finish(Volume& volume, const std::filesystem::path& file);

// The header of NRRD and MetaImage: words of a value as numbers. Throws InvalidInput that names the key.
[[nodiscard]] std::vector<double> numbers_of(const std::filesystem::path& file, const std::string& key,
                                             std::string_view value);
// The data file that a header names, beside it; its whole contents. Only a plain name is taken: a header from
// elsewhere must not make this program read any file of the machine. Throws InvalidInput when it is longer
// than `most_bytes`.
[[nodiscard]] std::string read_data_file(const std::filesystem::path& header_file, std::string_view name,
                                         std::size_t most_bytes);
// The whole file; the same errors.
[[nodiscard]] std::string read_bounded(const std::filesystem::path& file, std::size_t most_bytes);

[[nodiscard]] std::string trimmed(std::string_view text);
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace arthronaut::images
