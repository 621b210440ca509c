#include "app/scene/scene_view.h"

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkPlane.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkTextureObject.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "app/scene/vtk_from_mesh.h"
#include "app/scene/vtk_volume.h"

namespace arthronaut::scene {

namespace {

struct BoneActor {
  BoneItem item;
  vtkSmartPointer<vtkActor> actor;
};

vtkSmartPointer<vtkActor> actor_of(vtkPolyData* polydata) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(polydata);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

void dress(vtkActor& actor, const BoneItem& item) {
  vtkProperty* property = actor.GetProperty();
  property->SetColor(item.color.red, item.color.green, item.color.blue);
  property->SetAmbient(0.10);
  property->SetDiffuse(0.85);
  property->SetSpecular(0.12);
  property->SetSpecularPower(18);
  property->SetOpacity(item.opacity);
  // A seen-through bone shows its near surface alone: one blended layer, in any order of drawing.
  if (item.opacity < 1) {
    actor.ForceOpaqueOn();
    property->BackfaceCullingOn();
  } else {
    actor.ForceOpaqueOff();
    property->BackfaceCullingOff();
  }
  actor.GetMapper()->RemoveAllClippingPlanes();
  actor.SetBackfaceProperty(nullptr);
  if (!item.cut) return;
  vtkNew<vtkPlane> plane;  // VTK keeps what lies on its normal's side
  const Eigen::Vector3d kept = -item.cut->normal;
  plane->SetOrigin(item.cut->point_mm.x(), item.cut->point_mm.y(), item.cut->point_mm.z());
  plane->SetNormal(kept.x(), kept.y(), kept.z());
  actor.GetMapper()->AddClippingPlane(plane);
  // The inside of the far wall, seen through the cut: in one flat colour it reads as the section.
  vtkNew<vtkProperty> section;
  section->SetColor(kSectionColor.red, kSectionColor.green, kSectionColor.blue);
  section->SetAmbient(1);
  section->SetDiffuse(0);
  section->SetSpecular(0);
  section->SetOpacity(item.opacity);
  actor.SetBackfaceProperty(section);
}

void add_lights(vtkRenderer& renderer) {
  const auto add = [&](double x, double y, double z, double intensity) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(intensity);
    renderer.AddLight(light);
  };
  renderer.AutomaticLightCreationOff();
  add(-0.45, 0.75, 1.0, 0.85);
  add(0.8, -0.4, 0.6, 0.28);
}

// How coarsely a volume is to be drawn, learnt from what it took before.
class VolumeCost {
 public:
  // One ray for a square of this many pixels.
  [[nodiscard]] double pixels_per_ray(double pixels, bool is_still) const {
    // 30 moving pictures a second, what is drawn over them included.
    const double allowed_s = is_still ? 0.25 : 0.027;
    return std::clamp(std::sqrt(pixels * ray_s_ / allowed_s), 1.0, 12.0);
  }
  // The first picture of a volume makes its gradients, too: it is not counted.
  void begin() { is_first_ = true; }
  void took(double seconds, double pixels, double pixels_per_ray) {
    if (!std::exchange(is_first_, false))
      ray_s_ += 0.5 * (seconds * pixels_per_ray * pixels_per_ray / pixels - ray_s_);
  }

 private:
  double ray_s_ = 2e-6;
  bool is_first_ = true;
};

}  // namespace

struct SceneView::State {
  std::function<void()> make_current;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  // What is there; and, in a layer of its own above it, a faint copy of what shines through the bone.
  vtkNew<vtkRenderer> scene, ghost;
  vtkNew<vtkCamera> camera;
  std::vector<BoneActor> bones;
  // Kept with their mappers, whose data alone are replaced: a new mapper puts its shaders together anew,
  // which takes longer than drawing.
  vtkNew<vtkPolyData> solid_data, ghost_data;
  vtkSmartPointer<vtkActor> solids = actor_of(solid_data), ghost_solids = actor_of(ghost_data);
  vtkSmartPointer<vtkVolume> volume;
  std::shared_ptr<const VolumeItem> volume_item;
  VolumeCost volume_cost;
  bool is_still = true;
  SceneCamera looked_from;
  int width = 0, height = 0;
  bool dirty = true, rendered = false;

  static void on_event(vtkObject*, unsigned long event, void* client, void* call) {
    if (event == vtkCommand::WindowMakeCurrentEvent) static_cast<State*>(client)->make_current();
    if (event == vtkCommand::WindowIsCurrentEvent) *static_cast<bool*>(call) = true;
  }
};

SceneView::SceneView(std::function<void()> make_current) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.make_current = std::move(make_current);
  s.window->SetOwnContext(0);
  s.window->SetFrameBlitModeToNoBlit();
  s.window->SetMultiSamples(0);
  s.window->SetSupportsOpenGL(1);
  s.window->SetIsDirect(1);
  s.window->SetMapped(1);
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&s);
  observer->SetCallback(&State::on_event);
  s.window->AddObserver(vtkCommand::WindowMakeCurrentEvent, observer);
  s.window->AddObserver(vtkCommand::WindowIsCurrentEvent, observer);
  s.window->InitializeFromCurrentContext();
  s.window->SetNumberOfLayers(2);
  s.scene->SetLayer(0);
  s.ghost->SetLayer(1);
  s.ghost->InteractiveOff();
  for (vtkRenderer* renderer : {s.scene.Get(), s.ghost.Get()}) {
    renderer->SetActiveCamera(s.camera);
    add_lights(*renderer);
    s.window->AddRenderer(renderer);
  }
  s.solids->GetProperty()->SetAmbient(0.42);
  s.solids->GetProperty()->SetDiffuse(0.65);
  s.solids->GetProperty()->SetSpecular(0.15);
  s.scene->AddActor(s.solids);
  s.ghost_solids->GetProperty()->SetAmbient(0.45);
  s.ghost_solids->GetProperty()->SetOpacity(0.45);
  s.ghost_solids->GetProperty()->BackfaceCullingOn();
  s.ghost_solids->ForceOpaqueOn();
  s.ghost->AddActor(s.ghost_solids);
  s.scene->GradientBackgroundOn();
  set_background({0.045F, 0.055F, 0.070F}, {0.085F, 0.105F, 0.130F});
}

SceneView::~SceneView() {
  state_->make_current();
  state_->window->Finalize();
}

void SceneView::resize(int width_px, int height_px) {
  State& s = *state_;
  width_px = std::max(width_px, 1);
  height_px = std::max(height_px, 1);
  if (width_px == s.width && height_px == s.height) return;
  s.width = width_px;
  s.height = height_px;
  s.window->SetSize(width_px, height_px);
  s.dirty = true;
}

void SceneView::show(const SceneContent& content) {
  State& s = *state_;
  // Bones are kept as long as their mesh is: uploading them again is what would cost.
  std::vector<BoneActor> kept;
  for (const BoneItem& item : content.bones) {
    const auto known = std::find_if(s.bones.begin(), s.bones.end(), [&](const BoneActor& b) {
      return b.actor != nullptr && b.item.mesh == item.mesh;
    });
    BoneActor bone{item, nullptr};
    if (known != s.bones.end()) {
      std::swap(bone.actor, known->actor);
    } else {
      bone.actor = actor_of(vtk_from_mesh(*item.mesh));
      s.scene->AddActor(bone.actor);
    }
    dress(*bone.actor, item);
    kept.push_back(std::move(bone));
  }
  for (const BoneActor& old : s.bones)
    if (old.actor != nullptr) s.scene->RemoveActor(old.actor);
  s.bones = std::move(kept);

  const bool had_same = s.volume_item != nullptr && content.volume != nullptr &&
                        s.volume_item->volume == content.volume->volume;
  if (!had_same) {
    if (s.volume != nullptr) s.scene->RemoveVolume(s.volume);
    s.volume = content.volume != nullptr ? vtk_from_volume(*content.volume->volume) : nullptr;
    if (s.volume != nullptr) s.scene->AddVolume(s.volume);
    s.volume_cost.begin();
  }
  if (s.volume != nullptr && !(had_same && *s.volume_item == *content.volume))
    dress(*s.volume, *content.volume);
  s.volume_item = content.volume;

  SolidMesh solid, ghost;
  const auto add = [&](const auto& items) {
    for (const auto& item : items) {
      solid.add(item);
      if (item.seen_through_bone) ghost.add(item);
    }
  };
  add(content.rods);
  add(content.lines);
  add(content.balls);
  s.solid_data->ShallowCopy(vtk_from_solid(solid));
  s.ghost_data->ShallowCopy(vtk_from_solid(ghost));
  s.dirty = true;
}

void SceneView::look(const SceneCamera& camera) {
  State& s = *state_;
  if (s.rendered && camera == s.looked_from) return;
  s.looked_from = camera;
  s.dirty = true;
}

void SceneView::set_background(const Color& bottom, const Color& top) {
  state_->scene->SetBackground(bottom.red, bottom.green, bottom.blue);
  state_->scene->SetBackground2(top.red, top.green, top.blue);
  state_->dirty = true;
}

void SceneView::set_still(bool is_still) {
  if (state_->is_still == is_still) return;
  state_->is_still = is_still;
  if (state_->volume != nullptr) state_->dirty = true;
}

void SceneView::let_go_of_picture() {
  if (!state_->rendered) return;
  resize(1, 1);
  draw(1);
}

bool SceneView::render_if_dirty() {
  State& s = *state_;
  if (!s.dirty) return false;
  const double pixels = static_cast<double>(s.width) * s.height;
  draw(s.volume_cost.pixels_per_ray(pixels, s.is_still));
  return true;
}

void SceneView::draw(double pixels_per_ray) {
  State& s = *state_;
  const SceneCamera& c = s.looked_from;
  s.camera->SetPosition(c.position_mm.data());
  s.camera->SetFocalPoint(c.focus_mm.data());
  s.camera->SetViewUp(c.up.data());
  s.camera->SetViewAngle(c.view_angle_deg);
  s.scene->ResetCameraClippingRange();
  if (s.volume != nullptr) set_detail(*s.volume, pixels_per_ray);
  const auto begin = std::chrono::steady_clock::now();
  s.window->Render();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (s.volume != nullptr)
    s.volume_cost.took(took.count(), static_cast<double>(s.width) * s.height, pixels_per_ray);
  s.dirty = false;
  s.rendered = true;
}

std::uint32_t SceneView::texture() const {
  if (!state_->rendered) return 0;
  return state_->window->GetDisplayFramebuffer()->GetColorAttachmentAsTextureObject(0)->GetHandle();
}

Image SceneView::read_image() {
  State& s = *state_;
  draw(1);
  vtkNew<vtkUnsignedCharArray> pixels;
  s.window->GetPixelData(0, 0, s.width - 1, s.height - 1, 0, pixels.Get(), 0);
  Image image{s.width, s.height, {}};
  const std::size_t stride = 3 * static_cast<std::size_t>(s.width);
  image.rgb.resize(stride * static_cast<std::size_t>(s.height));
  for (int y = 0; y < s.height; ++y)
    std::copy_n(pixels->GetPointer(static_cast<vtkIdType>(stride) * (s.height - 1 - y)), stride,
                image.rgb.begin() + static_cast<std::ptrdiff_t>(stride * static_cast<std::size_t>(y)));
  return image;
}

}  // namespace arthronaut::scene
