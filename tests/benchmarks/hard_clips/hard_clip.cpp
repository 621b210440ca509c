#include "tests/benchmarks/hard_clips/hard_clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <random>

#include "navigation/simulator/solids.h"
#include "tests/benchmarks/hard_clips/obstructions.h"
#include "tests/benchmarks/hard_clips/video_code.h"

namespace arthronaut::hard_clips {
namespace {

using geometry::RigidTransform;

constexpr int kMoments = 256;  // poses of a frame, from its first moment to its last
constexpr float kWhite = 0.72F, kBlack = 0.035F;
constexpr double kMargin = 1.0 / 6;  // of the side: one cell
constexpr double kBehindMm = 4;      // tissue behind the world marker

// Where a marker stands at one moment, seen from it.
struct Moment {
  Eigen::Matrix3f marker_from_camera;
  Eigen::Vector3f eye;
};

// Over the time that a frame takes.
struct Shown {
  std::array<Moment, kMoments> moments;
  Eigen::Vector2d center_px;
  double reach_px = 0;
};

}  // namespace

struct HardClip::State {
  State(const ClipRecipe& made, std::filesystem::path to)
      : recipe(made),
        camera(camera_of(made)),
        motion(made, camera),
        obstructions(made),
        cache(std::move(to)) {
    for (int k = 0; k < ClipMotion::kMarkers; ++k) cells[k] = simulator::marker_cells(ClipMotion::kIds[k]);
    Draw draw(recipe.seed + 99);
    exposure = draw.between(0.75, 1.15);
    slope = {draw.between(-0.25, 0.25), draw.between(-0.25, 0.25)};
    step_every = 6 + draw.below(8);
    for (double& gain : gains) gain = std::exp(draw.between(-0.8, 0.55));
    if (recipe.bit_rate > 0)
      code =
          std::make_unique<VideoCode>(recipe.width, recipe.height, recipe.frames_per_second, recipe.bit_rate);
  }

  [[nodiscard]] double interval_s() const { return 1 / recipe.frames_per_second; }
  [[nodiscard]] double time_s() const { return next_frame * interval_s(); }
  // From the middle of the frame to the middle of this row's exposure.
  [[nodiscard]] double delay_s(double y) const {
    return (y / recipe.height - 0.5) * recipe.readout_share * interval_s();
  }

  void trace_rays();
  void place_markers();
  void draw_light(double field_delay_s);
  [[nodiscard]] cv::Vec3f look(const Eigen::Vector3f& ray, double time_share,
                               const std::array<bool, 3>& near) const;
  [[nodiscard]] cv::Vec3f tissue(const Eigen::Vector3f& ray) const;
  void pass_optics();
  void expose();
  void find_truth();
  void draw_frame();

  ClipRecipe recipe;
  camera::CameraModel camera;
  ClipMotion motion;
  Obstructions obstructions;
  std::filesystem::path cache;
  std::unique_ptr<VideoCode> code;
  std::array<simulator::MarkerCells, ClipMotion::kMarkers> cells;
  double exposure = 1;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  // of the light over the picture
  int step_every = 10;
  std::array<double, 16> gains{};

  int next_frame = 0;
  std::array<Shown, ClipMotion::kMarkers> shown;
  double first_s = 0, last_s = 0;  // of the moments, from the frame's middle
  MarkerPlaces places{};
  std::vector<Eigen::Vector2f> rays;  // by pixel; not a number where there is none
  std::vector<float> passed;          // share of the light
  cv::Mat light, cover, bgr, gray;
  std::vector<MarkerTruth> truths;
};

void HardClip::State::trace_rays() {
  if (!rays.empty()) return;
  const auto& circle = camera.boundary();
  rays.resize(static_cast<std::size_t>(recipe.width) * recipe.height);
  passed.resize(rays.size());
  for (int y = 0; y < recipe.height; ++y) {
    for (int x = 0; x < recipe.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * recipe.width + x;
      const double away = (Eigen::Vector2d(x, y) - circle.center_px).norm();
      const auto ray = away < circle.radius_px + 2 ? camera.ray(Eigen::Vector2d(x, y)) : std::nullopt;
      rays[at] = ray ? Eigen::Vector2f(ray->hnormalized().cast<float>()) : Eigen::Vector2f(NAN, NAN);
      const double share = away / circle.radius_px;
      const double tilt =
          1 + (slope.x() * (x - circle.center_px.x()) + slope.y() * (y - circle.center_px.y())) /
                  circle.radius_px;
      passed[at] = ray ? static_cast<float>(std::clamp(circle.radius_px - away + 0.5, 0.0, 1.0) * tilt *
                                            (1 - 0.3 * share * share))
                       : 0.0F;
    }
  }
}

void HardClip::State::place_markers() {
  const double half_exposure = 0.5 * recipe.exposure_share * interval_s();
  const double half_delay = (0.5 * recipe.readout_share + (recipe.is_interlaced ? 0.25 : 0)) * interval_s();
  first_s = -half_exposure - half_delay;
  last_s = half_exposure + half_delay;
  for (int k = 0; k < ClipMotion::kMarkers; ++k) {
    Shown& marker = shown[k];
    for (int m = 0; m < kMoments; ++m) {
      const double time = time_s() + first_s + (last_s - first_s) * (m + 0.5) / kMoments;
      const RigidTransform marker_from_camera = motion.camera_from_marker(k, time).inverse();
      marker.moments[m] = {marker_from_camera.matrix().cast<float>(),
                           marker_from_camera.translation_mm.cast<float>()};
    }
    const RigidTransform middle = motion.camera_from_marker(k, time_s());
    const double px_per_mm = camera.central_focal_px() / middle.translation_mm.z();
    marker.center_px = camera.project(middle.translation_mm).value_or(Eigen::Vector2d(-1e6, -1e6));
    double wander = 0;
    for (const double end : {first_s, last_s}) {
      const RigidTransform there = motion.camera_from_marker(k, time_s() + end);
      wander = std::max(wander, px_per_mm * (there.translation_mm - middle.translation_mm).norm());
    }
    // The plate's corners, a little enlarged by the lens.
    marker.reach_px =
        1.25 * px_per_mm * recipe.marker_size_mm * (0.5 + kMargin) * std::sqrt(2.0) + wander + 4;
    places.center_px[k] = marker.center_px;
    places.side_px[k] = px_per_mm * recipe.marker_size_mm;
  }
}

cv::Vec3f HardClip::State::tissue(const Eigen::Vector3f& ray) const {
  const Moment& moment = shown[0].moments[kMoments / 2];
  const Eigen::Vector3f direction = moment.marker_from_camera * ray;
  const float along = (-static_cast<float>(kBehindMm) - moment.eye.z()) / direction.z();
  const float x = moment.eye.x() + along * direction.x(), y = moment.eye.y() + along * direction.y();
  const float rough = along > 0 ? noise_at(0.35F * x + 20, 0.35F * y + 20) : 0.5F;
  const float fine = along > 0 ? noise_at(2.2F * x, 2.2F * y) : 0.5F;
  const float tone = 0.05F + 0.28F * rough + 0.1F * fine;
  return {0.42F * tone, 0.5F * tone, 0.95F * tone};
}

cv::Vec3f HardClip::State::look(const Eigen::Vector3f& ray, double time_share,
                                const std::array<bool, 3>& near) const {
  const int index = std::clamp(static_cast<int>(time_share * kMoments), 0, kMoments - 1);
  const auto size = static_cast<float>(recipe.marker_size_mm);
  for (int k = 0; k < ClipMotion::kMarkers; ++k) {
    if (!near[k]) continue;
    const Moment& moment = shown[k].moments[index];
    const Eigen::Vector3f direction = moment.marker_from_camera * ray;
    if (direction.z() >= 0) continue;
    const float along = -moment.eye.z() / direction.z();
    const float u = (moment.eye.x() + along * direction.x()) / size + 0.5F;
    const float v = 0.5F - (moment.eye.y() + along * direction.y()) / size;
    const auto margin = static_cast<float>(kMargin);
    if (u < -margin || v < -margin || u > 1 + margin || v > 1 + margin) continue;
    const bool is_margin = u < 0 || v < 0 || u >= 1 || v >= 1;
    const int count = cells[k].count;
    const bool is_white =
        is_margin || cells[k].is_white[static_cast<int>(v * count) * count + static_cast<int>(u * count)];
    const float tone = is_white ? kWhite : kBlack;
    return {tone, tone, tone};
  }
  return tissue(ray);
}

void HardClip::State::draw_light(double field_delay_s) {
  light.create(recipe.height, recipe.width, CV_32FC3);
  const int samples = recipe.smear_px < 2 ? 16 : recipe.smear_px < 10 ? 32 : 64;
  const double span = last_s - first_s, open = recipe.exposure_share * interval_s();
  Draw draw(recipe.seed * 131 + next_frame);
  for (int y = 0; y < recipe.height; ++y) {
    auto* row = light.ptr<cv::Vec3f>(y);
    const double delay = field_delay_s + delay_s(y);
    for (int x = 0; x < recipe.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * recipe.width + x;
      row[x] = {0, 0, 0};
      if (passed[at] <= 0) continue;
      std::array<bool, 3> near{};
      for (int k = 0; k < ClipMotion::kMarkers; ++k)
        near[k] = (shown[k].center_px - Eigen::Vector2d(x, y)).squaredNorm() <
                  shown[k].reach_px * shown[k].reach_px;
      const Eigen::Vector2f& ray = rays[at];
      const bool is_inner = x + 1 < recipe.width && y + 1 < recipe.height && !std::isnan(rays[at + 1].x()) &&
                            !std::isnan(rays[at + recipe.width].x());
      if (!is_inner || !(near[0] || near[1] || near[2])) {
        row[x] = passed[at] * tissue({ray.x(), ray.y(), 1});
        continue;
      }
      const Eigen::Vector2f right = rays[at + 1] - ray, below = rays[at + recipe.width] - ray;
      // A lattice of rank one over pixel and time, shifted from pixel to pixel.
      const double a = draw.between(0, 1), b = draw.between(0, 1), c = draw.between(0, 1);
      cv::Vec3f sum(0, 0, 0);
      for (int s = 0; s < samples; ++s) {
        const auto part = [s](double shift, double step) {
          const double value = shift + s * step;
          return value - static_cast<int>(value);
        };
        const Eigen::Vector2f place = ray + static_cast<float>(part(a, 0.7548776662) - 0.5) * right +
                                      static_cast<float>(part(b, 0.5698402910) - 0.5) * below;
        const double time = delay + open * ((s + c) / samples - 0.5);
        sum += look({place.x(), place.y(), 1}, (time - first_s) / span, near);
      }
      row[x] = (passed[at] / static_cast<float>(samples)) * sum;
    }
  }
}

void HardClip::State::pass_optics() {
  cover.create(light.size(), CV_8UC1);
  cover.setTo(0);
  obstructions.paint(time_s(), places, light, cover);
  // The field stop is behind all that.
  for (int y = 0; y < light.rows; ++y) {
    auto* row = light.ptr<cv::Vec3f>(y);
    for (int x = 0; x < light.cols; ++x) {
      if (passed[static_cast<std::size_t>(y) * recipe.width + x] <= 0) row[x] = {0, 0, 0};
    }
  }
  cv::GaussianBlur(light, light, {0, 0}, recipe.optics_sigma_px, recipe.optics_sigma_px,
                   cv::BORDER_REPLICATE);
}

void HardClip::State::expose() {
  double gain = 1;
  if (recipe.has_exposure_steps) {
    // Two frames on the way from one level to the next.
    const int step = next_frame / step_every, within = next_frame % step_every;
    const double to = gains[step % 16], from = step > 0 ? gains[(step - 1) % 16] : to;
    gain = within < 2 ? from + (to - from) * (within + 1) / 3.0 : to;
  }
  constexpr int kTones = 8192;
  std::vector<float> tones(kTones + 1);
  for (int i = 0; i <= kTones; ++i)
    tones[i] =
        static_cast<float>(255 * std::pow(std::pow(static_cast<double>(i) / kTones, 2), 1 / recipe.gamma));
  constexpr int kDeviates = 1 << 16;
  static const std::vector<float> deviates = [] {
    std::mt19937 random(7);
    std::normal_distribution<float> normal(0, 1);
    std::vector<float> list(kDeviates);
    for (float& value : list) value = normal(random);
    return list;
  }();
  const auto scale = static_cast<float>(exposure * gain);
  const auto noise = static_cast<float>(recipe.noise_grey * std::sqrt(std::max(1.0, gain)));
  bgr.create(light.size(), CV_8UC3);
  std::mt19937 random(static_cast<unsigned>(recipe.seed * 7717 + next_frame));
  for (int y = 0; y < light.rows; ++y) {
    const auto* in = light.ptr<cv::Vec3f>(y);
    auto* out = bgr.ptr<cv::Vec3b>(y);
    for (int x = 0; x < light.cols; ++x) {
      const unsigned bits = random();
      for (int channel = 0; channel < 3; ++channel) {
        const float root = std::sqrt(std::clamp(scale * in[x][channel], 0.0F, 1.0F)) * kTones;
        const float deviate = deviates[(bits >> (5 * channel)) & (kDeviates - 1)];
        const float grey = tones[static_cast<int>(root)] + noise * deviate + 0.5F;
        out[x][channel] = static_cast<std::uint8_t>(std::clamp(grey, 0.0F, 255.0F));
      }
    }
  }
  if (code) {
    code->code(bgr);
  } else if (recipe.has_subsampled_chroma) {
    cv::Mat planes;
    cv::cvtColor(bgr, planes, cv::COLOR_BGR2YUV_I420);
    cv::cvtColor(planes, bgr, cv::COLOR_YUV2BGR_I420);
  }
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
}

void HardClip::State::find_truth() {
  truths.clear();
  constexpr int kGrid = 24;
  const double open = recipe.exposure_share * interval_s();
  for (int k = 0; k < ClipMotion::kMarkers; ++k) {
    MarkerTruth truth;
    truth.id = ClipMotion::kIds[k];
    const double middle_row = recipe.is_interlaced ? 0 : shown[k].center_px.y();
    const double time = time_s() + (recipe.is_interlaced ? 0 : delay_s(middle_row));
    truth.camera_from_marker = motion.camera_from_marker(k, time);
    const RigidTransform before = motion.camera_from_marker(k, time - 0.5 * open),
                         after = motion.camera_from_marker(k, time + 0.5 * open);
    int visible = 0, saturated = 0, outside = 0, moved = 0;
    for (int i = 0; i < kGrid * kGrid; ++i) {
      const Eigen::Vector3d place(((i % kGrid + 0.5) / kGrid - 0.5) * recipe.marker_size_mm,
                                  (0.5 - (i / kGrid + 0.5) / kGrid) * recipe.marker_size_mm, 0);
      const auto pixel = camera.project(truth.camera_from_marker * place);
      const auto first = camera.project(before * place), last = camera.project(after * place);
      if (first && last) {
        truth.motion_px += (*last - *first).norm();
        ++moved;
      }
      if (!pixel || !camera.is_inside_view(*pixel) || pixel->x() < 0 || pixel->y() < 0 ||
          pixel->x() > recipe.width - 1 || pixel->y() > recipe.height - 1) {
        ++outside;
        continue;
      }
      const int x = static_cast<int>(std::lround(pixel->x())), y = static_cast<int>(std::lround(pixel->y()));
      visible += cover.at<std::uint8_t>(y, x) < 128;
      saturated += gray.at<std::uint8_t>(y, x) >= 250;
    }
    truth.is_in_view = outside == 0;
    truth.visible_share = static_cast<double>(visible) / (kGrid * kGrid);
    truth.saturated_share = static_cast<double>(saturated) / (kGrid * kGrid);
    truth.motion_px /= std::max(1, moved);
    truth.side_px = 1e9;
    const double half = 0.5 * recipe.marker_size_mm;
    const Eigen::Vector3d corners[4] = {
        {-half, half, 0}, {half, half, 0}, {half, -half, 0}, {-half, -half, 0}};
    for (int i = 0; i < 4; ++i) {
      const auto a = camera.project(truth.camera_from_marker * corners[i]),
                 b = camera.project(truth.camera_from_marker * corners[(i + 1) % 4]);
      truth.side_px = a && b ? std::min(truth.side_px, (*a - *b).norm()) : 0;
    }
    truths.push_back(truth);
  }
}

void HardClip::State::draw_frame() {
  const std::string name = std::string(to_text(recipe.hardness)) + "-" + std::to_string(recipe.seed) + "-" +
                           std::to_string(next_frame) + ".raw";
  const std::filesystem::path file = cache.empty() ? cache : cache / name;
  place_markers();
  const std::size_t count = static_cast<std::size_t>(recipe.width) * recipe.height;
  if (!file.empty() && std::filesystem::exists(file)) {
    gray.create(recipe.height, recipe.width, CV_8UC1);
    cover.create(recipe.height, recipe.width, CV_8UC1);
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(gray.data), static_cast<std::streamsize>(count));
    in.read(reinterpret_cast<char*>(cover.data), static_cast<std::streamsize>(count));
    if (in) return;
  }
  trace_rays();
  // What the lens blurs is one moment's picture: the sensor takes every other row of each field's.
  const double half_apart_s = recipe.is_interlaced ? 0.25 * interval_s() : 0;
  draw_light(half_apart_s);
  pass_optics();
  if (recipe.is_interlaced) {
    const cv::Mat odd = light.clone();
    draw_light(-half_apart_s);
    pass_optics();
    for (int y = 1; y < light.rows; y += 2) odd.row(y).copyTo(light.row(y));
  }
  expose();
  if (file.empty()) return;
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(gray.data), static_cast<std::streamsize>(count));
  out.write(reinterpret_cast<const char*>(cover.data), static_cast<std::streamsize>(count));
}

HardClip::HardClip(const ClipRecipe& recipe, std::filesystem::path cache)
    : state_(std::make_unique<State>(recipe, std::move(cache))) {}
HardClip::~HardClip() = default;

camera::GrayView HardClip::next() {
  if (state_->next_frame >= state_->recipe.frame_count) return {};
  state_->draw_frame();
  state_->find_truth();
  ++state_->next_frame;
  return {state_->gray.data, state_->gray.cols, state_->gray.rows,
          static_cast<std::ptrdiff_t>(state_->gray.step)};
}

const std::vector<MarkerTruth>& HardClip::truth() const { return state_->truths; }

std::int64_t HardClip::timestamp_ns() const {
  return std::llround(1e9 * (state_->next_frame - 1) * state_->interval_s());
}

const camera::CameraModel& HardClip::camera() const { return state_->camera; }

}  // namespace arthronaut::hard_clips
