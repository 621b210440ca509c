#include "app/plan/slice_panes.h"

#include <utility>

#include "planning/cases/case_image.h"
#include "planning/cases/measurements.h"

namespace arthronaut::plan {

namespace {

struct Stopped {};

}  // namespace

// Seen as radiologists hang them: axial from the feet, coronal from the front, sagittal from the patient's
// left.
SlicePanes::SlicePanes(std::function<void()> wake)
    : wake_(std::move(wake)),
      panes_{SlicePane("Axial", Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()),
             SlicePane("Coronal", Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ()),
             SlicePane("Sagittal", Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ())} {}

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
  window_ = volume_->modality == "CT" ? scene::kBoneWindow : automatic_;
  constexpr double kAround = 1.15;
  for (SlicePane& pane : panes_) pane.show(joint_.center_mm(), kAround * joint_.size_mm().maxCoeff());
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
    const SliceEvent event = panes_[i].draw(ui, kNames[i], areas[i], content);
    if (event.cross_mm) cross_mm_ = *event.cross_mm;
    if (event.window) window_ = *event.window;
    // A drag that does not fit what was begun is a measurement of its own.
    if (points_mm_.size() + event.measured_mm.size() > points_asked()) points_mm_.clear();
    points_mm_.insert(points_mm_.end(), event.measured_mm.begin(), event.measured_mm.end());
    if (!event.reaching_mm.empty()) reaching_mm_ = event.reaching_mm;
    if (event.value) {
      const std::string text = widgets::fixed(*event.value, 0) + (volume_->modality == "CT" ? " HU" : "");
      ImFont* font = ui.theme.body;
      const float wide = font->CalcTextSizeA(font->FontSize, 1e9F, 0, text.c_str()).x;
      ImGui::GetWindowDrawList()->AddText(
          font, font->FontSize,
          {areas[i].x + areas[i].width - wide - ui.theme.px(10), areas[i].y + ui.theme.px(8)}, widgets::kText,
          text.c_str());
    }
  }
  const auto& w = window_;
  ui.log.note_state("window", widgets::fixed(w.level, 0) + " / " + widgets::fixed(w.width, 0));
  ui.log.note_state("cross", widgets::fixed(cross_mm_.x(), 1) + " " + widgets::fixed(cross_mm_.y(), 1) + " " +
                                 widgets::fixed(cross_mm_.z(), 1));
}

}  // namespace arthronaut::plan
