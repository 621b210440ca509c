// What stands beside the 3D view: which bone it is, read from across the room, and what its colours tell,
// where there is room for that too. Nothing of the bone lies under it. Pure.
#pragma once

#include <functional>
#include <string>

#include "app/widgets/layout.h"

namespace arthronaut::navigate {

struct SceneWords {
  std::string words;
  widgets::Rect place, view;  // of the words and of the bone, in the pane
};
// Beside the view where the pane is low, since a bone is shown as large as its view is high; else above it.
// The view keeps at least a square of the pane's height, or what a line leaves. colours: empty where they
// tell nothing. Letters of letters_px, as wide as width_of says.
[[nodiscard]] SceneWords scene_words(const widgets::Rect& pane, const std::string& bone,
                                     const std::string& colours, float letters_px, float gap_px,
                                     const std::function<float(const std::string&)>& width_of);

}  // namespace arthronaut::navigate
