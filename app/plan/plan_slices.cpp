// The images with the plan drawn in them, beside the bones.
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

}  // namespace arthronaut::plan
