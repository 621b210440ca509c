#include "app/navigate/scene_words.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::navigate {

SceneWords scene_words(const widgets::Rect& pane, const std::string& bone, const std::string& colours,
                       float letters_px, float gap_px,
                       const std::function<float(const std::string&)>& width_of) {
  constexpr float kLow = 1.5F;  // so many times as wide as high
  const bool is_beside = pane.width > kLow * pane.height;
  const float room = is_beside ? pane.width - pane.height - gap_px : pane.width;
  SceneWords scene{colours.empty() ? bone : bone + (is_beside ? "\n" : ". ") + colours, {}, pane};
  const bool fits = width_of(scene.words) <= room && (!is_beside || 2 * letters_px <= pane.height);
  if (!fits) scene.words = bone;
  // A whole pixel more than they are wide: parts of a line add up to a little more than the whole of it.
  scene.place = is_beside ? scene.view.cut_left(std::min(std::ceil(width_of(scene.words)) + 1, room), gap_px)
                          : scene.view.cut_top(letters_px, gap_px);
  return scene;
}

}  // namespace arthronaut::navigate
