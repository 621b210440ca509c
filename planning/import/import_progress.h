// How far an import is: which stage, how far that is, and which share of all it is.
#pragma once

#include <cstdint>
#include <string_view>

namespace arthronaut::importing {

// In the order of their coming; an import passes over some, and those of the bones come once for each.
enum class ImportStage : std::uint32_t {
  Starting,
  LookingThrough,  // a folder, for what there is to import
  Reading,
  ReadingImages,  // that labels were painted in
  FindingBones,   // in a CT
  MakingSurface,  // of a label
  MendingMesh,
  LookingAtBones,
};
[[nodiscard]] std::string_view in_words(ImportStage stage);  // "Reading", for a person

struct ImportProgress {
  ImportStage stage = ImportStage::Starting;
  double fraction = -1;  // of this stage, 0 to 1; below 0: not known
};

// Of the whole, 0 to 1: each stage has the share that it takes of a CT's import, or of a label map's. Where
// stages come once for each bone it goes back; what is shown is the greatest so far (ImportProcess).
[[nodiscard]] double share_of_all(const ImportProgress& progress);

}  // namespace arthronaut::importing
