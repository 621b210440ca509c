#include "tests/benchmarks/contour_clips.h"

#include <cmath>
#include <fstream>

#include "navigation/camera/medium.h"
#include "navigation/experiments/registration_trial.h"
#include "navigation/registration/registration_file.h"
#include "navigation/simulator/instruments.h"
#include "navigation/simulator/renderer.h"
#include "navigation/simulator/script.h"
#include "navigation/sources/frame_source.h"
#include "planning/bones/mesh_file.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"

namespace arthronaut::contour_clips {

namespace {

camera::Calibration scaled(camera::Calibration camera, double scale) {
  // Pixel centres stand at whole numbers.
  const auto move = [&](Eigen::Vector2d& point) {
    point = ((point.array() + 0.5) * scale - 0.5).matrix().eval();
  };
  camera.image_size_px = (camera.image_size_px.cast<double>() * scale).cast<int>();
  camera.focal_px *= scale;
  move(camera.principal_point_px);
  move(camera.rotation_center_px);
  move(camera.boundary.center_px);
  camera.boundary.radius_px *= scale;
  return camera;
}

template <typename Value>
void put(std::ostream& out, const Value& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}
template <typename Value>
void get(std::istream& in, Value& value) {
  in.read(reinterpret_cast<char*>(&value), sizeof value);
}
template <typename Value>
void put_all(std::ostream& out, const std::vector<Value>& values) {
  put(out, values.size());
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(Value)));
}
template <typename Value>
void get_all(std::istream& in, std::vector<Value>& values) {
  std::size_t count = 0;
  get(in, count);
  values.resize(in ? count : 0);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(Value)));
}

// Of this build alone: the bytes of its own types.
void keep(const std::filesystem::path& file, const Clip& clip) {
  const std::filesystem::path part = file.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    put(out, clip.world_from_bone);
    put(out, clip.looks.size());
    for (const Look& look : clip.looks) {
      put(out, look.timestamp_ns);
      put(out, look.is_valid);
      put(out, look.camera);
      put(out, look.camera_from_world);
      put_all(out, look.tool_is_tracked);
      put_all(out, look.camera_from_tool);
      put_all(out, look.luma);
    }
  }
  std::filesystem::rename(part, file);
}

bool fetch(const std::filesystem::path& file, Clip& clip) {
  std::ifstream in(file, std::ios::binary);
  std::size_t count = 0;
  get(in, clip.world_from_bone);
  get(in, count);
  if (!in) return false;
  clip.looks.resize(count);
  for (Look& look : clip.looks) {
    get(in, look.timestamp_ns);
    get(in, look.is_valid);
    get(in, look.camera);
    get(in, look.camera_from_world);
    get_all(in, look.tool_is_tracked);
    get_all(in, look.camera_from_tool);
    get_all(in, look.luma);
  }
  return static_cast<bool>(in);
}

void track(sources::FrameSource& source, const pipeline::PipelineOptions& options, Clip& clip) {
  pipeline::NavigationPipeline pipeline(options);
  pipeline::FrameResult result;
  while (const camera::FramePtr frame = source.next()) {
    pipeline.process(*frame, result);
    Look look;
    look.timestamp_ns = frame->timestamp_ns;
    look.is_valid = result.camera_from_world.is_valid;
    look.camera = result.camera;
    look.camera_from_world = result.camera_from_world.target_from_source;
    for (std::size_t i = 0; i < options.tools.tools.size(); ++i) {
      const auto& body = result.bodies[options.tools.world_markers.size() + i];
      look.tool_is_tracked.push_back(body.is_tracked());
      look.camera_from_tool.push_back(body.camera_from_body);
    }
    camera::gray_from(*frame, look.luma);
    clip.looks.push_back(std::move(look));
  }
}

// A script drawn at any size and rate.
class ScriptedSource : public sources::FrameSource {
 public:
  ScriptedSource(const simulator::SimulationOptions& options, const simulator::Staging& staging,
                 const simulator::Script& script, const geometry::TriangleMesh& mesh,
                 const ClipRecipe& recipe)
      : options_(options),
        staging_(staging),
        script_(script),
        step_(30 / recipe.frames_per_second),
        bone_(mesh, options.seed),
        renderer_(&bone_, simulator::SensorOptions{}) {
    // As the simulated operation does: white at the nearest marker stays below saturation.
    double nearest_mm = 1e9;
    for (const simulator::Moment& moment : script_)
      nearest_mm =
          std::min(nearest_mm, (moment.bone_from_camera.inverse() * tool_of(moment).translation_mm).norm());
    exposure_ = static_cast<float>(0.85 * nearest_mm * nearest_mm);
  }
  [[nodiscard]] const sources::SourceInfo& info() const override { return info_; }
  [[nodiscard]] camera::FramePtr next() override {
    if (at_ >= script_.size()) return nullptr;
    const simulator::Moment& moment = script_[at_];
    // A scope is held by a hand that looks about.
    const geometry::RigidTransform camera_from_bone =
        (moment.bone_from_camera *
         simulator::tremor(options_.seed + 77, 0.25 * static_cast<double>(at_), 1.2, 2.5))
            .inverse();
    simulator::Scene scene;
    scene.exposure = exposure_;
    scene.has_bone = true;
    scene.camera_from_bone = camera_from_bone;
    simulator::add_world_marker(simulator::world_marker_of(options_),
                                camera_from_bone * staging_.bone_from_world_marker, scene.solids);
    simulator::add_tool(
        moment.bone_from_guide ? simulator::guide_of(options_) : simulator::probe_of(options_.tools),
        camera_from_bone * tool_of(moment), scene.solids);
    const double mark_deg = std::fmod(moment.mark_angle_deg + 720, 360.0);
    const camera::CameraModel model(options_.camera, options_.camera.lens_angle_rad(mark_deg),
                                    options_.refractive_index);
    auto frame = std::make_shared<camera::Frame>();
    renderer_.render(scene, model, mark_deg, options_.seed * 1'000'003 + at_, *frame);
    frame->index = static_cast<std::int64_t>(at_ / step_);
    frame->timestamp_ns = static_cast<std::int64_t>(at_) * 1'000'000'000 / 30;
    at_ += step_;
    return frame;
  }

 private:
  static const geometry::RigidTransform& tool_of(const simulator::Moment& moment) {
    return moment.bone_from_guide ? *moment.bone_from_guide : *moment.bone_from_probe;
  }
  simulator::SimulationOptions options_;
  const simulator::Staging& staging_;
  const simulator::Script& script_;
  std::size_t at_ = 0, step_;
  float exposure_ = 300;
  simulator::BoneView bone_;
  simulator::Renderer renderer_;
  sources::SourceInfo info_;
};

}  // namespace

Clip simulated_clip(const ClipRecipe& recipe, const std::filesystem::path& cache) {
  Clip clip;
  const bool is_phantom = recipe.bone == "phantom";
  clip.name = (is_phantom ? recipe.bone : std::filesystem::path(recipe.bone).stem().string()) + "-" +
              std::to_string(recipe.seed) + (recipe.drills ? "-drill" : "-scratch");
  clip.tools = tools::standard_tools();
  simulator::SimulationOptions options;
  options.knee = phantom::make_phantom_knee({.seed = recipe.seed});
  options.plan = options.knee.femoral_tunnel;
  if (!is_phantom) {
    options.knee.femur.mesh = bones::read_mesh(recipe.bone);
    const geometry::Surface surface(options.knee.femur.mesh);
    const auto wall =
        experiments::find_lateral_notch_wall(options.knee.femur.mesh, surface, bones::Side::Right);
    if (!wall) throw InvalidInput(recipe.bone + ": this bone shows no notch");
    options.plan.entry_mm = *wall;
  }
  clip.mesh = options.knee.femur.mesh;
  const auto file = cache / (clip.name + "-" + std::to_string(recipe.frames_per_second) + "-" +
                             std::to_string(static_cast<int>(100 * recipe.scale)) + ".looks");
  if (!cache.empty() && fetch(file, clip)) return clip;
  clip.looks.clear();
  options.tools = clip.tools;
  options.seed = recipe.seed;
  // Staged for the whole picture; drawn smaller, and as often as is asked for.
  options.camera = simulator::standard_camera();
  const geometry::Surface surface(clip.mesh);
  const simulator::Staging staging = simulator::stage_operation(options, surface);
  clip.world_from_bone = staging.bone_from_world_marker.inverse();
  options.camera = scaled(options.camera, recipe.scale);
  const simulator::Script script =
      recipe.drills ? simulator::drill_script(options, staging, options.plan,
                                              tunnels::measure(options.plan, surface).length_mm)
                    : simulator::scratch_script(options, staging);
  ScriptedSource source(options, staging, script, clip.mesh, recipe);
  pipeline::PipelineOptions pipeline;
  pipeline.calibration = options.camera;
  pipeline.refractive_index = options.refractive_index;
  pipeline.tools = clip.tools;
  track(source, pipeline, clip);
  if (!cache.empty()) keep(file, clip);
  return clip;
}

Clip traced_clip(const std::filesystem::path& folder) {
  Clip clip;
  clip.name = "traced " + folder.filename().string();
  clip.tools = tools::read_tools_file(folder / "tools.json");
  clip.mesh = bones::read_mesh(folder / "bone.stl");
  clip.world_from_bone =
      registration::read_registration_file(folder / "gt/registration_gt.json").marker_from_bone;
  pipeline::PipelineOptions options;
  options.calibration = camera::read_camera_file(folder / "camera.json").calibration;
  options.refractive_index = camera::kSalineIndex;
  options.tools = clip.tools;
  const auto video = sources::open_video(folder / "clip.mkv");
  track(*video, options, clip);
  return clip;
}

}  // namespace arthronaut::contour_clips
