// What of a folder or a file can be imported: image series, volumes, meshes, each with what is wrong with it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/images/series_list.h"

namespace arthronaut::start {

struct ImportSource {
  std::filesystem::path source;               // what the import is given
  std::optional<images::ImageSeries> series;  // nullopt: a mesh
  std::optional<bones::BoneKind> bone;        // of a mesh, by its name
  std::string title;                          // "CT series 3: Knee 0.6 bone"
  std::string detail;                         // "256 images, 512 x 512 x 256 voxels of 0.4 x 0.4 x 0.6 mm"
  std::string refusal;                        // why it cannot be imported; empty when it can
  std::vector<std::string> warnings;          // it can, but a person should know
  [[nodiscard]] bool can_be_imported() const { return refusal.empty(); }
};

struct ImportSources {
  std::filesystem::path root;
  std::vector<ImportSource> sources;
  std::vector<std::string> left_out;  // "REPORT.dcm: is no image"
  std::string wanted_uid;             // of the series that somebody chose one slice of; else empty
  // The one to begin with: the series that was wanted, and where it can't be imported none; else the readable
  // CT or label map with the most images, else the first that can be imported.
  [[nodiscard]] std::optional<std::size_t> best() const;
};

// The series of which a file that was chosen is one slice and no more; empty where it is not such a file.
[[nodiscard]] std::string series_of_one_slice(const std::filesystem::path& root,
                                              const images::SeriesList& list);

// Whether the root is to be looked through for series, by importing::SeriesProcess: a mesh holds none.
[[nodiscard]] bool may_hold_series(const std::filesystem::path& root);

// The series of the list, in its order, and then the meshes of the root. Opens no file: of a mesh its name
// and size are known. Never throws for what it finds.
[[nodiscard]] ImportSources import_sources(const std::filesystem::path& root, const images::SeriesList& list);

// What the list says of a series.
[[nodiscard]] ImportSource source_of(const std::filesystem::path& root, const images::ImageSeries& series);

}  // namespace arthronaut::start
