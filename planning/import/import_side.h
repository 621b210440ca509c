// Which knee an import is of: as it is said, named, or told by its bones, and what the bones say against it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planning/cases/bone_doubts.h"
#include "planning/import/bone_import.h"

namespace arthronaut::importing {

// The side that all bones whose shapes were judged tell alike; nullopt where they do not, or none was (where
// a fibula tells the side none is).
[[nodiscard]] std::optional<bones::Side> side_by_shapes(const BoneImport& import);

// Whether side_by_shapes() may tell one once both bones' shapes are looked at: that of one bone alone is not
// believed, nor that of a bone which is in doubt.
[[nodiscard]] bool shapes_may_tell(const BoneImport& import);
// BoneImport::why_no_side of an import without a side. of_fibula: why the fibula does not tell it; empty
// where none was looked for.
[[nodiscard]] std::string why_no_side(const BoneImport& import, const std::string& of_fibula);

// "by the name of a segment"; empty where a person said it, or nothing did.
[[nodiscard]] std::string told_by(SideSource source);
// As the images are marked, where nobody said it. A name that says the other side is as good a witness:
// neither is believed then, and the bones may tell.
void take_side_of_images(BoneImport& import, std::optional<bones::Side> marked, bool was_said);
// Whether mark, fibula or shapes tell another side than the import has.
[[nodiscard]] bool side_is_contradicted(const BoneImport& import);

// The doubts of one of its bones in a knee of that side, those of the side last: as a person says it, as the
// case has it that the bone is added to, or as the import has it. Those of shapes are of each bone whose
// shape was judged. nullopt: of no side yet.
[[nodiscard]] std::vector<cases::BoneDoubt> doubts_with(const BoneImport& import, const ImportedBone& bone,
                                                        std::optional<bones::Side> side,
                                                        bool is_said_by_person = false);
// A person says the side. Where fibula or shapes say another one that is a doubt of the bones from then on;
// where the shapes alone told the same one, that is none any more.
void say_side(BoneImport& import, bones::Side side);

// Of a side that a person said and no mark, fibula or shape bears out: that is no doubt, and stands with the
// case all the same. nullopt otherwise.
[[nodiscard]] std::optional<cases::SideDoubt> side_note(const BoneImport& import, bones::Side side,
                                                        bool is_said_by_person = false);
// Whether mark, fibula or shapes tell that side.
[[nodiscard]] bool side_is_borne_out(const BoneImport& import, bones::Side side);

// Another bone of the same knee, from a file of its own. Who knows the side tells it to the other; false
// where both know it and they differ, and nothing is changed.
[[nodiscard]] bool add_bones(BoneImport& import, BoneImport more);

}  // namespace arthronaut::importing
