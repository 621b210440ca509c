// From imported bones to the case that holds them: a new one, or one that is there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planning/cases/case.h"
#include "planning/import/bone_import.h"

namespace arthronaut::importing {

// Both before the import's work, not after it. Throws what add_to_case() will of a folder that is no case:
// InvalidInput where it holds something else, IoError where none can be made.
void refuse_folder(const std::filesystem::path& folder);
// Throws InvalidInput when add_to_case() will need a side that nothing can say; a mesh that does not say
// which bone it is either is asked for both. A volume may still show its side by its fibula, and a label map
// by the names of its segments.
void refuse_missing_side(const std::filesystem::path& folder, const std::filesystem::path& source,
                         const BoneImportOptions& options);

// What add_to_case() will take the place of in the case that is in `folder`, one sentence each; asked for
// before it: "replaced in the case: its femur and its tibia". And that femur and tibia are then of images of
// two frames of reference, also where nothing is replaced. Empty where there is neither. Throws as
// load_case() and load_studies().
[[nodiscard]] std::vector<std::string> replaced_in_words(const std::filesystem::path& folder,
                                                         const BoneImport& import);

// Writes the case with these bones into `folder`, and returns it. `name` becomes the case's name; empty:
// "Knee", date and time, or the one it has. `source` is for messages.
//
// The bones' doubts, in a knee of the case's side, stay with the case (cases/bone_doubts.h).
//
// A new case appears whole, by renaming, or not at all. In one that is there bones are replaced, and their
// landmarks and cartilage go. Images of another knee leave the case, where every bone is replaced by what was
// made in an image of another frame of reference; their files stay. Throws InvalidInput: a folder that holds
// something else; a knee of the other side, or of neither; another patient's; a bone that is planned on, as
// its tunnel would lie somewhere else in another surface; the folder is then as before. Throws IoError: of a
// case that was there, bones to be replaced may have lost landmarks and cartilage, or be replaced; none has
// those of another surface, and no image was added. After a crash neither, but the image may lie there
// unused.
cases::Case add_to_case(const std::filesystem::path& folder, const BoneImport& import,
                        const std::string& name, const std::filesystem::path& source);

}  // namespace arthronaut::importing
