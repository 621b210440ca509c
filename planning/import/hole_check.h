// Whether something was drilled through a bone before. Inner header of import.
#pragma once

#include "planning/import/bone_import.h"

namespace arthronaut::importing {

// Adds a doubt to each bone that a hole as wide as a tunnel goes right through: what is planned there would
// count the hole as bone. A socket, which ends within the bone, is none, nor is what a closed hole left
// behind. Vessels and gaps in thin or coarsely imaged bone are narrower: those of two CTs measure 14 mm
// around at most.
void check_holes(BoneImport& import);

}  // namespace arthronaut::importing
