// The images with the plan drawn in them, beside the bones.
#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/plan/plan_view.h"
#include "app/scene/solid_mesh.h"

namespace arthronaut::plan {

std::string entry_label(const tunnels::TunnelKey& key) {
  return key.bundle == norms::Bundle::Whole          ? "Entry"
         : key.bundle == norms::Bundle::Anteromedial ? "Entry AM"
                                                     : "Entry PL";
}

void PlanView::draw_slices(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas) {
  slices_.want();
  ui.log.note_state("slices", slices_.volume() != nullptr ? "shown"
                              : slices_.is_loading()      ? "loading"
                                                          : "none");
  ui.log.note_state("measured",
                    model_->measurements().empty() ? "" : model_->measurements().back().in_words());
  if (slices_.volume() == nullptr) {
    const widgets::Rect all{areas[1].x, areas[1].y, areas[2].x + areas[2].width - areas[1].x,
                            areas[1].height};
    widgets::text_centered(ui, all, ui.theme.title, widgets::kQuietText, slices_.reason());
    return;
  }
  const auto tunnel = state_.along ? model_->tunnel(state_.key) : std::nullopt;
  slices_.follow(tunnel ? std::optional(TunnelAxis{adjective(state_.key), tunnel->entry_mm, tunnel->direction,
                                                   model_->axes(state_.key.bone).proximal})
                        : std::nullopt);
  SliceContent content;
  content.revision = model_->revision();
  for (const bones::BoneKind kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    if (!model_->has_bone(kind)) continue;
    content.meshes.push_back(
        {&model_->knee().bones.at(kind).mesh, widgets::color_of(scene::kBoneColor), 1.5F});
    for (const tunnels::TunnelKey& key : model_->knee().plan.of(kind)) {
      content.meshes.push_back({&tunnel_mesh(key), widgets::color_of(scene::kPlanColor), 2.5F});
      content.marks.push_back(
          {entry_label(key), model_->tunnel(key)->entry_mm, widgets::color_of(scene::kPlanColor)});
    }
  }
  if (auto wall = thinnest_wall()) {
    wall->word = "Wall " + wall->word;
    content.marks.push_back(*std::move(wall));
  }
  for (const cases::Measurement& measurement : model_->measurements())
    content.lines.push_back({measurement.points_mm, measurement.in_words()});
  slices_.draw(ui, areas, std::move(content));
  const auto points = slices_.take_measured();
  if (!points) return;
  std::vector<cases::Measurement> measurements = model_->measurements();
  measurements.push_back({*points});
  history_.apply_measurements(measurements, points->size() == 3 ? "Measure an angle" : "Measure a distance");
}

// The drill's cylinder, made anew when the plan has changed.
const geometry::TriangleMesh& PlanView::tunnel_mesh(const tunnels::TunnelKey& key) {
  TunnelMesh& kept = tunnel_meshes_[key];
  if (kept.revision == model_->revision()) return kept.mesh;
  const tunnels::Tunnel tunnel = *model_->tunnel(key);
  scene::SolidMesh solid;
  solid.add(scene::RodItem{tunnel.entry_mm - tunnel.direction,
                           tunnel.entry_mm + (model_->drawn_length_mm(key) + 1) * tunnel.direction,
                           tunnel.diameter_mm, tunnel.diameter_mm, scene::kPlanColor, false});
  kept.mesh = {};
  for (const Eigen::Vector3f& point : solid.points_mm) kept.mesh.vertices_mm.push_back(point.cast<double>());
  kept.mesh.triangles = solid.triangles;
  kept.revision = model_->revision();
  return kept.mesh;
}

void PlanView::add_slice_actions(widgets::Actions& actions) {
  const auto has_slices = [this] { return state_.shows_slices && slices_.volume() != nullptr; };
  actions.add(
      {"plan.slices", "Slices",
       "Three slices of the images beside the bones, linked by the cross-hair; needs a case with images",
       GLFW_KEY_S, 0, false, [this] { return model_ != nullptr && slices_.has_images(); },
       [this] { return state_.shows_slices; },
       [this] {
         state_.shows_slices = !state_.shows_slices;
         slices_.use(MeasuringTool::None);
       }});
  actions.add({"plan.paint",
               "Paint bones",
               "Corrects the bones in the images, or grows them from painted strokes",
               GLFW_KEY_I,
               0,
               false,
               [this] {
                 return model_ != nullptr &&
                        std::ranges::any_of(model_->knee().images,
                                            [](const auto& image) { return !image.is_label_map; });
               },
               {},
               [this] { paint_(); }});
  actions.add({"plan.window", "Window", kWindowTooltip, GLFW_KEY_W, 0, false, has_slices, {}, [this] {
                 slices_.go_to_next_window();
               }});
  actions.add(
      {"plan.fit", "Whole", "Shows the whole slices again", GLFW_KEY_F, 0, false, has_slices, {}, [this] {
         slices_.fit();
       }});
  actions.add({"plan.cross_to_entry",
               "To entry",
               "The cross-hair goes to the tunnel's entry",
               GLFW_KEY_E,
               0,
               false,
               [this, has_slices] { return has_slices() && model_->tunnel(state_.key).has_value(); },
               {},
               [this] { slices_.set_cross(model_->tunnel(state_.key)->entry_mm); }});
  actions.add({"plan.cross_to_thinnest",
               "To thin wall",
               "The cross-hair goes where the tunnel's wall is thinnest; slices along the tunnel turn to "
               "show that place",
               GLFW_KEY_E,
               GLFW_MOD_SHIFT,
               false,
               [this, has_slices] { return has_slices() && thinnest_wall().has_value(); },
               {},
               [this] { slices_.show_point(thinnest_wall()->point_mm); }});
  const auto can_follow = [this, has_slices] {
    return has_slices() && model_->tunnel(state_.key).has_value();
  };
  actions.add(
      {"plan.along", "Along tunnel",
       "The slices follow the tunnel: one across it, two that hold its axis. The wheel goes along it, and "
       "turns the slices about it",
       GLFW_KEY_0, 0, false, can_follow, [this] { return state_.along; },
       [this] { state_.along = !state_.along; }});
  struct Turn {
    const char *id, *label;
    int key;
    double by_deg;
  };
  for (const Turn& turn : {Turn{"plan.turn_back", "Turn back", GLFW_KEY_LEFT, -5},
                           Turn{"plan.turn_on", "Turn on", GLFW_KEY_RIGHT, 5}})
    actions.add({turn.id,
                 turn.label,
                 "The slices along the tunnel turn about it by 5 degrees",
                 turn.key,
                 GLFW_MOD_CONTROL,
                 true,
                 [this, can_follow] { return can_follow() && state_.along; },
                 {},
                 [this, by = turn.by_deg] { slices_.turn(by); }});
}

}  // namespace arthronaut::plan
