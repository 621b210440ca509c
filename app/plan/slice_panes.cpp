#include "app/plan/slice_panes.h"

#include <utility>

#include "planning/cases/case_image.h"
#include "planning/cases/measurements.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::plan {

namespace {

struct Stopped {};

constexpr double kTurn_deg = 5;  // by a step of the wheel

struct NamedPlane {
  const char* title;
  Eigen::Vector3d right, down;
};
// Seen as radiologists hang them: axial from the feet, coronal from the front, sagittal from the patient's
// left.
NamedPlane scanner_plane(std::size_t pane) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  return pane == 0   ? NamedPlane{"Axial", x, y}
         : pane == 1 ? NamedPlane{"Coronal", x, -z}
                     : NamedPlane{"Sagittal", y, -z};
}

SlicePane scanner_pane(std::size_t pane) {
  const NamedPlane plane = scanner_plane(pane);
  return {plane.title, plane.right, plane.down};
}

}  // namespace

SlicePanes::SlicePanes(std::function<void()> wake)
    : wake_(std::move(wake)), panes_{scanner_pane(0), scanner_pane(1), scanner_pane(2)} {}

SlicePanes::~SlicePanes() { stop_loading(); }

void SlicePanes::stop_loading() {
  stops_ = true;
  loading_.drop();
  stops_ = false;
}

void SlicePanes::open(const cases::Case& knee, const std::filesystem::path& folder,
                      const geometry::Bounds& joint) {
  stop_loading();
  images_ = knee.images;
  folder_ = folder;
  joint_ = joint;
  cross_mm_ = joint.center_mm();
  volume_.reset();
  failure_.clear();
  tool_ = MeasuringTool::None;
  points_mm_.clear();
  follow(std::nullopt);
  turned_deg_ = 0;
}

void SlicePanes::want() {
  if (images_.empty() || volume_ != nullptr || loading_.is_busy() || !failure_.empty()) return;
  loaded_ = 0;
  // A grey image rather than a label map; the last of them, which is the newest.
  cases::CaseImage image = images_.back();
  for (const cases::CaseImage& other : images_)
    if (!other.is_label_map) image = other;
  loading_.start(
      [this, image, folder = folder_] {
        Loaded loaded;
        try {  // the top of the loading thread
          loaded.volume = std::make_shared<const images::Volume>(
              cases::load_image(folder, image, [this](double fraction) {
                if (stops_) throw Stopped();
                loaded_ = fraction;
              }));
          loaded.automatic = scene::automatic_window(*loaded.volume);
        } catch (const Stopped&) {
        } catch (const std::exception& error) {
          loaded.volume.reset();
          loaded.failure = error.what();
        }
        return loaded;
      },
      wake_);
}

void SlicePanes::tick() {
  if (!loading_.is_ready()) return;
  Loaded loaded = loading_.take();
  volume_ = std::move(loaded.volume);
  failure_ = loaded.failure;
  if (volume_ == nullptr) return;
  automatic_ = loaded.automatic;
  window_ = volume_->modality == images::Modality::Ct ? scene::kBoneWindow : automatic_;
  show_joint();
}

void SlicePanes::show_joint() {
  constexpr double kAround = 1.15, kAlong_mm = 80, kMiddle_mm = 20;
  for (SlicePane& pane : panes_) {
    if (tunnel_)
      pane.show(tunnel_->entry_mm + kMiddle_mm * tunnel_->direction, kAlong_mm);
    else
      pane.show(joint_.center_mm(), kAround * joint_.size_mm().maxCoeff());
  }
}

void SlicePanes::follow(const std::optional<TunnelAxis>& tunnel) {
  const bool is_another =
      tunnel.has_value() != tunnel_.has_value() || (tunnel && tunnel->name != tunnel_->name);
  tunnel_ = tunnel;
  if (!is_another) return;
  use(MeasuringTool::None);
  if (tunnel_)
    cross_mm_ = tunnel_->entry_mm;
  else
    for (std::size_t i = 0; i < panes_.size(); ++i) {
      const NamedPlane plane = scanner_plane(i);
      panes_[i].turn_to(plane.title, plane.right, plane.down);
    }
  show_joint();
}

void SlicePanes::lay_along(const TunnelAxis& tunnel) {
  cross_mm_ = on_axis(tunnel, cross_mm_);
  const TunnelPlanes planes = tunnel_planes(tunnel, geometry::rad_from_deg(turned_deg_));
  panes_[0].turn_to("Across the " + tunnel.name + " tunnel", planes.across.right, planes.across.down);
  panes_[1].turn_to("Along the " + tunnel.name + " tunnel", planes.along.right, planes.along.down);
  panes_[2].turn_to("Along it, turned by 90\u00B0", planes.square.right, planes.square.down);
}

void SlicePanes::set_cross_in(std::size_t pane, const Eigen::Vector3d& point_mm) {
  if (!tunnel_) {
    cross_mm_ = point_mm;
    return;
  }
  if (pane > 0)
    turn(kTurn_deg *
         std::round(panes_[pane].normal().dot(point_mm - cross_mm_) / panes_[pane].step_mm(*volume_)));
  cross_mm_ = on_axis(*tunnel_, point_mm);
}

void SlicePanes::scroll(std::size_t pane, int images) {
  set_cross_in(pane, cross_mm_ + images * panes_[pane].step_mm(*volume_) * panes_[pane].normal());
}

void SlicePanes::move_cross(std::size_t pane, const Eigen::Vector2d& by_px) {
  set_cross_in(pane, cross_mm_ + panes_[pane].way_mm(by_px));
}

// A drag that does not fit what was begun is a measurement of its own.
void SlicePanes::add_measured(const std::vector<Eigen::Vector3d>& points_mm) {
  if (points_mm_.size() + points_mm.size() > points_asked()) points_mm_.clear();
  points_mm_.insert(points_mm_.end(), points_mm.begin(), points_mm.end());
}

void SlicePanes::show_point(const Eigen::Vector3d& point_mm) {
  cross_mm_ = tunnel_ ? on_axis(*tunnel_, point_mm) : point_mm;
  if (tunnel_) turned_deg_ = geometry::deg_from_rad(turned_to_hold_rad(*tunnel_, point_mm));
}

void SlicePanes::fit() {
  if (volume_ == nullptr) return;
  for (SlicePane& pane : panes_) pane.fit(*volume_);
}

void SlicePanes::go_to_next_window() {
  if (volume_ != nullptr) window_ = scene::next_window(window_, automatic_, *volume_);
}

std::string SlicePanes::reason() const {
  if (volume_ != nullptr) return "";
  if (!failure_.empty()) return "The images cannot be shown: " + failure_;
  if (images_.empty()) return "This case has no images: it was made of meshes, or by an older version.";
  return "Loading the images: " + widgets::fixed(100 * loaded_, 0) + " %";
}

void SlicePanes::use(MeasuringTool tool) {
  tool_ = tool;
  points_mm_.clear();
}

std::optional<std::vector<Eigen::Vector3d>> SlicePanes::take_measured() {
  if (tool_ == MeasuringTool::None || points_mm_.size() < points_asked()) return std::nullopt;
  return std::exchange(points_mm_, {});
}

void SlicePanes::draw(const widgets::Ui& ui, const std::array<widgets::Rect, 3>& areas,
                      SliceContent content) {
  if (volume_ == nullptr) return;
  if (tunnel_) lay_along(*tunnel_);
  content.volume = volume_.get();
  content.cross_mm = cross_mm_;
  content.window = window_;
  content.measures = tool_ != MeasuringTool::None;
  std::vector<Eigen::Vector3d> line = points_mm_;
  line.insert(line.end(), reaching_mm_.begin(), reaching_mm_.end());
  // What it would be if the mouse let go here. An angle has a number with its third point.
  const std::string reached =
      !line.empty() && line.size() == points_asked() ? cases::Measurement{line}.in_words() : "";
  if (!line.empty()) content.lines.push_back({line, reached, true});
  ui.log.note_state("measuring", reached);
  reaching_mm_.clear();
  constexpr std::array<const char*, 3> kNames{"plan.axial_slice", "plan.coronal_slice",
                                              "plan.sagittal_slice"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (tunnel_)
      content.place =
          i == 0 ? widgets::fixed((cross_mm_ - tunnel_->entry_mm).dot(tunnel_->direction), 1) +
                       " mm from the entry"
                 : "turned by " +
                       widgets::fixed(i == 1 ? turned_deg_ : std::remainder(turned_deg_ + 90, 360), 0) +
                       "\u00B0 from upright";
    const SliceEvent event = panes_[i].draw(ui, kNames[i], areas[i], content);
    if (event.cross_mm) set_cross_in(i, *event.cross_mm);
    if (event.window) window_ = *event.window;
    add_measured(event.measured_mm);
    if (!event.reaching_mm.empty()) reaching_mm_ = event.reaching_mm;
    if (event.value) {
      const std::string text =
          widgets::fixed(*event.value, 0) + (volume_->modality == images::Modality::Ct ? " HU" : "");
      ImFont* font = ui.theme.body;
      const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
      ImGui::GetWindowDrawList()->AddText(
          font, font->FontSize,
          {areas[i].x + areas[i].width - wide - ui.theme.px(10), areas[i].y + ui.theme.px(8)}, widgets::kText,
          text.c_str());
    }
  }
  const auto& w = window_;
  ui.log.note_state("along", tunnel_ ? tunnel_->name + " " + widgets::fixed(turned_deg_, 0) : "");
  ui.log.note_state("window", widgets::fixed(w.level, 0) + " / " + widgets::fixed(w.width, 0));
  ui.log.note_state("cross", widgets::fixed(cross_mm_.x(), 1) + " " + widgets::fixed(cross_mm_.y(), 1) + " " +
                                 widgets::fixed(cross_mm_.z(), 1));
}

}  // namespace arthronaut::plan
