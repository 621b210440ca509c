// Planned against achieved, from the images after the operation: both tunnels in one scene and on slices
// along the tunnel, the differences with how sure they are, and what is not known. A page of Review.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/case/plan_model.h"
#include "app/folders/folder_browser.h"
#include "app/review/postop_run.h"
#include "app/scene/reslice.h"
#include "app/widgets/controls.h"
#include "app/widgets/grey_texture.h"
#include "app/widgets/scene_pane.h"
#include "navigation/worker/letting_go.h"
#include "planning/postop/achieved_place.h"

namespace arthronaut::review {

using Places = std::map<tunnels::TunnelKey, postop::AchievedPlace>;

// One row of the table: what was planned, what was found, how far off and how sure.
struct AchievedRow {
  std::string tunnel;                                     // "femur", "femur AM"
  std::string offset, angle, diameter, length;            // "1.2 mm ± 0.2", "–" where nothing was found
  std::string grid, wall;                                 // empty where they are not known
  widgets::Severity severity = widgets::Severity::Quiet;  // Good: reliable; Caution: not; Bad: not found
  // "reliable", "not reliable", "reliable in part: entry and direction; not the diameter", "not found"; each
  // number that is not relied on in a part that is says so, too.
  std::string verdict;
  std::vector<std::string> reasons;  // why not
};
// planned_length_mm: inside the bone, along the plan; by the same keys, as the places are.
[[nodiscard]] std::vector<AchievedRow> achieved_rows(
    const Comparisons& comparisons, const std::map<tunnels::TunnelKey, tunnels::Tunnel>& planned,
    const std::map<tunnels::TunnelKey, double>& planned_length_mm, const Places& places);
// What the differences may be off by, and what nobody knows: sentences for the panel. `place`: null where
// there is none.
[[nodiscard]] std::vector<std::string> error_budget(const postop::Comparison& comparison,
                                                    const postop::AchievedPlace* place,
                                                    const Eigen::Vector3d& voxel_mm);
// The plane through the tunnel's axis with the tunnel running down, `quarter_turns` times 90 degrees about
// the axis, its middle in the middle; in the frame of the tunnel.
[[nodiscard]] scene::SlicePlane plane_along(const tunnels::Tunnel& tunnel, double length_mm,
                                            int quarter_turns, double mm_per_px);

class PostopPage {
 public:
  PostopPage(std::function<void()> make_current, std::function<void()> wake);

  // Another case: what runs is ended, what the case keeps is read.
  void open(const open_case::PlanModel* model, const std::filesystem::path& case_folder,
            const std::string& read_only);
  // series: of a folder with several CTs, its UID; empty: the one that there is, or asked for.
  void compare_with(const std::filesystem::path& source, const std::string& series = {});
  void stop();
  [[nodiscard]] bool is_running() const { return run_ != nullptr && !run_->has_ended(); }
  // Of the case as it keeps them, or as they were compared since; empty: none.
  [[nodiscard]] const Comparisons& comparisons() const { return shown_.comparisons; }
  [[nodiscard]] bool has_any() const { return !shown_.comparisons.empty(); }
  // Nothing of a CT is known yet, not even why what the case keeps cannot be read.
  [[nodiscard]] bool is_blank() const {
    return shown_.comparisons.empty() && shown_.other_patient.empty() && problem_.empty() && !is_running();
  }
  void choose_next();  // of the tunnels
  // What was compared takes the place of what stayed kept before.
  [[nodiscard]] bool may_replace_kept() const {
    return !better_kept_.empty() && shown_.answer != nullptr && read_only_.empty() && !is_running();
  }
  void replace_kept();
  void ask_for_path();
  // The images are looked for in the folders of this machine, in the place of what is compared.
  void browse();
  void leave_browser() { search_.is_open = false; }
  // Null: nothing is looked for.
  [[nodiscard]] folders::FolderBrowser* browser() { return search_.is_open ? &search_.folders : nullptr; }
  [[nodiscard]] bool awaits_text() const { return field_.takes_focus; }
  void draw(const widgets::Ui& ui, widgets::Rect area);

 private:
  struct PathField {
    bool is_open = false, takes_focus = false;
    std::string text;
  };
  struct Search {
    bool is_open = false;
    folders::FolderBrowser folders{"review.folder"};
  };
  struct Slice {
    widgets::GreyTexture texture;
    std::vector<std::uint8_t> grey;
    scene::SlicePlane plane;  // in the images' frame; what the texture shows
  };
  void take_ended();
  [[nodiscard]] const Places& places();
  void show_scene();
  void look_at_chosen();
  void follow_plan(const widgets::Ui& ui);
  void draw_head(const widgets::Ui& ui, widgets::Rect area);
  void draw_browser(const widgets::Ui& ui, widgets::Rect area);
  void draw_question(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_table(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_slice(const widgets::Ui& ui, const widgets::Rect& area, int quarter_turns);
  [[nodiscard]] const postop::Comparison* chosen() const;
  // By the plan of now; without what is of another surface of its bone.
  [[nodiscard]] std::map<tunnels::TunnelKey, tunnels::Tunnel> planned() const;

  const open_case::PlanModel* model_ = nullptr;
  std::filesystem::path case_folder_;
  std::string read_only_, problem_, better_kept_;
  std::function<void()> wake_;
  widgets::ScenePane pane_;
  std::unique_ptr<PostopRun> run_;
  worker::LettingGo letting_go_;            // of what another case cut off
  std::filesystem::path source_;            // that was compared with last
  std::vector<images::ImageSeries> which_;  // of it, to be chosen among; empty: no question
  PostopShown shown_;
  // By the landmarks of now. Measured when the plan, the landmarks or the comparisons have changed: every
  // frame asks.
  Places places_;
  std::uint64_t places_are_of_ = 0;  // PlanModel::revision(); 0: none yet
  tunnels::TunnelKey chosen_{bones::BoneKind::Femur};
  bool scene_is_stale_ = true;     // it shows another case, tunnel or answer, and not from where it lies
  std::uint64_t scene_is_of_ = 0;  // PlanModel::revision()
  std::string scene_words_;        // where its plan enters
  PathField field_;
  Search search_;
  std::array<Slice, 2> slices_;
};

}  // namespace arthronaut::review
