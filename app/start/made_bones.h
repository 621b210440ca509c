// What an import has made, to be looked at before it becomes a case: the bones from in front of the patient,
// slices of the images that they are of, or that have none, and what a right and a left knee look like from
// there.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/start/side_slices.h"
#include "app/widgets/scene_pane.h"
#include "navigation/worker/awaited.h"
#include "planning/bones/bone.h"
#include "planning/import/bone_import.h"

namespace arthronaut::start {

class MadeBones {
 public:
  // wake: ends the window's wait, from any thread.
  MadeBones(std::function<void()> make_current, std::function<void()> wake);

  void show(const importing::BoneImport& import);  // copies what it draws; may be empty
  // Of a page's width, what it needs: slices are to be read.
  [[nodiscard]] float wanted_share() const { return has_slices_ ? 0.56F : 0.4F; }
  // side: that is chosen. Returns the one that was clicked on.
  std::optional<bones::Side> draw(const widgets::Ui& ui, const widgets::Rect& area,
                                  std::optional<bones::Side> side);

 private:
  using Meshes = std::vector<std::shared_ptr<const geometry::TriangleMesh>>;

  std::function<void()> wake_;
  widgets::ScenePane pane_;
  SideSlices slices_;
  bool has_slices_ = false, has_bones_ = false;
  worker::Awaited<Meshes> thinning_;
  bool is_there_ = false;
};

}  // namespace arthronaut::start
