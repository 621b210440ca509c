// What the shapes of the imported bones say of the side, and of the axes that the file claims. Inner header
// of import.
#pragma once

#include "planning/import/bone_import.h"

namespace arthronaut::importing {

// Proposes landmarks for each bone that nothing speaks against yet (landmarks/propose.h; seconds a bone) and
// adds a doubt where
// the fronts of all bones look backwards: a file of another convention (RAS read as LPS turns a knee by half
// a turn, so that it stays a whole knee, of the same side). Which side a shape tells stays with the bone
// (side_by_shape). Without a side, one that both bones tell alike is taken, as a doubt: of a bone alone the
// shape misleads too often. `fibula_was_seen`: the side needs no judging.
void check_shapes(BoneImport& import, bool fibula_was_seen);

}  // namespace arthronaut::importing
