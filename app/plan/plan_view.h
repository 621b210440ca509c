// Plan mode: the bones in 3D, the tunnels with their handles, and the numbers. Reads the model; every change
// goes through the history, which saves it.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/case/plan_history.h"
#include "app/case/plan_model.h"
#include "app/mode/mode.h"
#include "app/plan/bone_pane.h"
#include "app/plan/default_work.h"
#include "app/plan/export_work.h"
#include "app/plan/isometry_work.h"
#include "app/plan/landmark_drawing.h"
#include "app/plan/landmark_panel.h"
#include "app/plan/lateral_view.h"
#include "app/plan/plan_steps.h"
#include "app/plan/slice_panes.h"
#include "app/plan/tour.h"
#include "app/plan/tunnel_survey.h"
#include "app/plan/version_field.h"
#include "app/plan/version_words.h"
#include "app/plan/volume_drawing.h"
#include "planning/cases/bone_doubts.h"

namespace arthronaut::plan {

// What the column beside the bones shows.
enum class PanelPage { Checks, Landmarks, Steps };

class PlanView : public mode::Mode {
 public:
  // wake: ends the window's wait, from any thread.
  // paint: shows the painting of the case's bones. say_side: the case is of that side, and is opened anew
  // where it was of the other one; what came of it, in sentences. It throws InvalidInput or IoError.
  PlanView(std::function<void()> make_current, const std::function<void()>& wake, std::function<void()> paint,
           std::function<std::vector<std::string>(bones::Side)> say_side);

  [[nodiscard]] mode::ModeTitle title() const override;
  [[nodiscard]] std::vector<std::string_view> action_prefixes() const override { return {"plan."}; }
  void add_actions(widgets::Actions& actions) override;
  void case_opened(const mode::OpenCase& opened) override;
  void leave() override {
    history_.settle_now();
    leave_defaults("Plan was left");  // elsewhere nobody sees the plan change
    tour_.plan_mode_left();
    state_.is_held = false;
    bones_.let_go_of_picture();
  }
  void tick(double now_s) override;
  void draw(const widgets::Ui& ui, const widgets::Rect& area) override;
  // The tunnels of 3D Slicer's markups, as one step; why not, where they are not of this case. Precondition:
  // a case is open.
  void take_markups(const std::filesystem::path& file);
  // An export, which the end of the program or another case would cut off; a plan that could not be saved,
  // which they would lose.
  [[nodiscard]] bool has_running_work() const override {
    return export_.is_running() || history_.status().save == open_case::PlanStatus::Save::Failed;
  }
  void begin_tour_when_opened() { tour_.begin_when_opened(); }
  [[nodiscard]] bool awaits_text() const override { return version_field_.awaits_text(); }
  [[nodiscard]] bool is_busy() const override {
    return history_.is_moving() || defaults_.is_running() || slices_.is_loading() || volume_.is_preparing() ||
           landmark_drawing_.is_preparing() || awaits_shape();
  }

 private:
  // What the shape says of the landmarks is a check that comes seconds after the case.
  [[nodiscard]] bool awaits_shape() const;
  // plan_actions.cpp
  void add_view_actions(widgets::Actions& actions);
  void add_history_actions(widgets::Actions& actions);
  // Says what was undone or done again, and turns to the bone of which it was.
  void step(bool back);
  void add_tunnel_actions(widgets::Actions& actions);
  void add_placing_actions(widgets::Actions& actions);
  void place_entry(const scene::SceneRay& ray);
  void put_entry_there(const Eigen::Vector3d& point_mm);  // ends the placing
  [[nodiscard]] bool can_stop_placing() const;
  void add_slice_actions(widgets::Actions& actions);
  void add_measuring_actions(widgets::Actions& actions);
  void add_volume_actions(widgets::Actions& actions);

  // pane_actions.cpp
  void add_pane_actions(widgets::Actions& actions);
  // Of the three the one in which keys act; nullopt: in the 3D view.
  [[nodiscard]] std::optional<std::size_t> keyed_slice() const;
  // Where the mouse was pressed last keys act: the 3D view, and the slices.
  void draw_keyed_pane(const widgets::Ui& ui, const std::array<widgets::Rect, 4>& panes);
  void draw_aiming_cross(const widgets::Ui& ui, const widgets::Rect& area) const;
  void click_here();

  // version_actions.cpp
  void add_version_actions(widgets::Actions& actions);
  void load_versions();
  void load_bone_doubts();
  void keep_version();
  void take_version(std::size_t place);              // in versions_
  [[nodiscard]] std::size_t chosen_version() const;  // as a place in versions_; 0 where there is none
  void name_version(std::size_t place);              // opens its field
  void say_of_version(int number, const cases::VersionWords& words);
  void export_plan();

  // side_actions.cpp
  void add_side_actions(widgets::Actions& actions);
  void say_side(bones::Side side);
  void take_side_news();
  void draw_side(const widgets::Ui& ui, const widgets::Rect& area) const;

  // landmark_actions.cpp
  void add_landmark_actions(widgets::Actions& actions);
  void select_landmark(std::size_t row);
  void look_at_landmarks();
  void confirm_landmarks(bool all);
  void follow_landmark(const PaneEvent& event);
  void place_landmark(const scene::SceneRay& ray);
  void put_landmark_there(const Eigen::Vector3d& point_mm);  // ends the placing
  // how: "Drag"; the step names the landmark.
  void put_landmark(const Eigen::Vector3d& point_mm, const std::string& how, bool continues);
  [[nodiscard]] std::string landmark() const;  // that is selected; empty without a bone
  [[nodiscard]] std::string landmark_title() const;
  void add_landmark_marks(std::vector<PaneMark>& marks) const;

  // default_actions.cpp
  void add_default_actions(widgets::Actions& actions);
  [[nodiscard]] bool can_make_defaults() const;
  // then: with what was made, unless it is left before. Precondition: can_make_defaults().
  void make_defaults(const std::vector<tunnels::TunnelKey>& keys,
                     std::function<void(std::vector<MadeTunnel>)> then);
  void leave_defaults(const std::string& why);  // no effect where none are being made
  void follow_defaults();
  // Those that there are become the plan, as one step; of all of them it is said how they are.
  void take_defaults(std::vector<MadeTunnel> made, const std::string& what);
  // Of the last default plan: still as it was made, and better elsewhere within the norm's spread.
  [[nodiscard]] bool can_be_moved(const MadeTunnel& made) const;
  [[nodiscard]] bool can_move_defaults() const;
  [[nodiscard]] std::vector<MadeTunnel> moved_defaults() const;  // entered there

  // Where else the tunnel could begin, and from where it can be drilled: survey_view.cpp.
  void add_survey_actions(widgets::Actions& actions);
  [[nodiscard]] std::shared_ptr<const Survey> wanted_survey();
  [[nodiscard]] bool is_entry_hidden() const;  // by bone, from where one looks
  void add_map_marks(std::vector<PaneMark>& marks) const;
  // How the graft's length changes, by where it begins: isometry_view.cpp.
  void add_isometry_action(widgets::Actions& actions);
  [[nodiscard]] bool is_isometry_wanted() const;
  void follow_isometry();
  void add_isometry_marks(std::vector<PaneMark>& marks) const;
  void say_isometry_at(const widgets::Ui& ui, const std::optional<scene::SceneRay>& mouse) const;
  [[nodiscard]] std::vector<std::string> isometry_lines() const;
  void draw_isometry_scale(const widgets::Ui& ui, const widgets::Rect& area) const;
  // At the picture's lower edge; returns what it leaves of it.
  widgets::Rect draw_survey_legend(const widgets::Ui& ui, const widgets::Rect& area) const;

  // The first case: tour_view.cpp.
  void add_tour_actions(widgets::Actions& actions);
  void make_tour_defaults();
  void follow_tour();
  void draw_tour(const widgets::Ui& ui, const widgets::Rect& area, const TourCard& card) const;

  // One tunnel a bone or two of bundles, and which of them is worked on: bundle_actions.cpp.
  void add_bundle_actions(widgets::Actions& actions);
  void plan_bundles();
  void plan_single();
  // The bone's tunnel to go on with: of the bundle that was worked on where it has one.
  [[nodiscard]] tunnels::TunnelKey key_in(bones::BoneKind bone) const;
  // Leaves the placing.
  void work_on(const tunnels::TunnelKey& key);
  // An entry goes on being placed, of the other bone now; a landmark does not, it is another one there.
  void work_on_bone(bones::BoneKind bone);
  void show_page(PanelPage page);
  // Undo, a version or another program may have made two tunnels of one, or one of two.
  void follow_plan();

  // The tunnel that is worked on becomes this one; nothing where there is none.
  void widen(double by_mm);
  void change(const std::string& what, bool continues, const std::optional<tunnels::Tunnel>& tunnel);
  void look_from(scene::ViewDirection view);
  void draw_bones(const widgets::Ui& ui, const widgets::Rect& area);
  void draw_slices(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas);
  // plan_notes.cpp
  void draw_conflict(const widgets::Ui& ui, const widgets::Rect& area) const;
  // handles: that it is not to cover, where there is room for both.
  void draw_hint(const widgets::Ui& ui, const widgets::Rect& area, const std::vector<ImVec2>& handles) const;

  void show_content();
  [[nodiscard]] std::vector<PaneMark> marks() const;
  // Where the wall of the tunnel that is worked on is thinnest, and how thin: "3.1 mm".
  [[nodiscard]] std::optional<SliceMark> thinnest_wall() const;
  void add_norm_marks(std::vector<PaneMark>& marks) const;
  [[nodiscard]] std::vector<norms::Bundle> bundles_shown(bones::BoneKind kind) const;
  void follow(const PaneEvent& event);
  [[nodiscard]] std::optional<Eigen::Vector3d> aim_handle() const;
  [[nodiscard]] const geometry::TriangleMesh& tunnel_mesh(const tunnels::TunnelKey& key);

  enum class Placing { Nothing, Entry, Landmark };  // by the next click on the bone

  // Over the bones, until the next one, a change of mind or Esc: why a click did nothing, or what came of it.
  struct Hint {
    std::string text = {};
    bool is_news = false;                  // nothing to mend
    std::optional<std::uint64_t> of = {};  // of the model that alone it is true of
  };

  struct ViewState {
    tunnels::TunnelKey key = bones::BoneKind::Femur;  // that is worked on; of a bone's two it alone moves
    Placing placing = Placing::Nothing;
    std::size_t landmark = 0;  // row of landmark_rows()
    bool asks_side = false;    // which knee it is
    bool has_dragged = false;
    bool is_held = false;  // the mouse drags something of the plan: its step goes on
    // Where the aim's handle is while it is held: under the mouse, wherever the tunnel ends.
    std::optional<Eigen::Vector3d> held_aim_mm = {};
    std::size_t keyed_pane = 0;   // the 3D view, or 1 + the slice
    std::size_t version_row = 0;  // that keys take, from the newest
    bool along = false;           // the slices, of the tunnel that is worked on
    bool shows_slices = false, shows_lateral = false, shows_grid = true;
    bool shows_map = false, shows_aims = false, shows_isometry = false;
    std::shared_ptr<const Survey> survey = nullptr;           // of what is planned now; null: none is there
    std::shared_ptr<const ShownIsometry> isometry = nullptr;  // likewise
    std::string no_isometry = {};                             // why there is none; empty: it is being made
    PanelPage page = PanelPage::Checks;
    Hint hint = {};
    std::uint64_t shown_revision = 0;
    // As the tour compares the plan with it, and the landmarks that it follows from.
    std::map<bones::BoneKind, tunnels::Tunnel> defaults = {};
    std::map<bones::BoneKind, landmarks::Landmarks> defaults_of = {};  // of the whole case
    std::vector<MadeTunnel> made = {};  // the last default plan, as it was taken
  };

  struct TunnelMesh {
    geometry::TriangleMesh mesh;
    std::uint64_t revision = 0;  // of the model that it was made for
  };

  std::function<void()> paint_;
  std::function<std::vector<std::string>(bones::Side)> say_side_;
  std::filesystem::path side_news_of_;
  std::string side_news_;  // what came of the side that was said, for when the case is open anew
  open_case::PlanModel* model_ = nullptr;  // null until a case is open
  open_case::PlanHistory history_;
  BonePane bones_;
  SlicePanes slices_;
  VolumeDrawing volume_;
  LateralView lateral_;
  TunnelSurvey survey_;
  IsometryWork isometry_;
  ExportWork export_;
  DefaultWork defaults_, tour_defaults_;  // the plan's to be, and what the tour compares the plan with
  std::function<void(std::vector<MadeTunnel>)> take_made_;  // by defaults_
  Tour tour_{tour_file()};
  std::filesystem::path case_folder_;
  std::vector<KeptVersion> versions_;  // the oldest first
  VersionField version_field_;
  LandmarkDrawing landmark_drawing_;
  cases::BoneDoubts bone_doubts_;
  std::map<tunnels::TunnelKey, TunnelMesh> tunnel_meshes_;
  ViewState state_;
};

// What the column beside the bones is drawn from.
struct PlanPanel {
  const open_case::PlanModel& model;
  const open_case::PlanHistory& history;
  tunnels::TunnelKey key;  // that is worked on
  PanelPage page;
  std::size_t landmark;  // the row that is selected
  const std::vector<KeptVersion>& versions;
  std::size_t version;  // that keys take
  VersionField& version_field;
  LandmarkDrawing& landmark_drawing;
  const cases::BoneDoubts& doubts;
  NextStep next;
};
struct PanelClick {
  std::optional<std::size_t> step;      // of the history, as a position for PlanHistory::go_to()
  std::optional<std::size_t> landmark;  // row
  std::optional<std::size_t> version;   // place in PlanPanel::versions
  std::optional<std::size_t> named;     // likewise: it is to get a name
  struct Words {
    int number = 0;
    cases::VersionWords words;
  };
  std::optional<Words> words;  // of a version, entered just now
};
[[nodiscard]] PanelClick draw_plan_panel(const widgets::Ui& ui, const widgets::Rect& area,
                                         const PlanPanel& panel);
// On an entry's handle: of two tunnels each names its bundle.
[[nodiscard]] std::string entry_label(const tunnels::TunnelKey& key);
// What stands beside the question which knee it is. doubt: what speaks against the case's side; may be empty.
[[nodiscard]] std::string side_question(bones::Side of_case, const std::string& doubt);
// A note, and what was not checked, are quiet.
[[nodiscard]] widgets::Severity severity_of(tunnels::PlanCheck::Verdict verdict);

}  // namespace arthronaut::plan
