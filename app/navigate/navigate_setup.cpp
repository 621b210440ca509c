#include "app/navigate/navigate_setup.h"

#include "app/case/case_calibration.h"
#include "navigation/camera/medium.h"
#include "navigation/openigtlink/igtl_tracker.h"
#include "navigation/simulator/simulated_operation.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::navigate {

namespace {

constexpr int kPlacesToTouch = 4;  // three verify, one is the control point

const landmarks::Landmarks& landmarks_of(const cases::Case& knee, bones::BoneKind bone) {
  static const landmarks::Landmarks kNone;
  const auto found = knee.landmarks.find(bone);
  return found == knee.landmarks.end() ? kNone : found->second;
}

theatre::TheatreSource source_of(const open_case::PlanModel& model, bones::BoneKind bone,
                                 sources::SourceKind kind) {
  theatre::TheatreSource source;
  source.setup.kind = kind;
  source.setup.pipeline.bone = bone;
  source.setup.pipeline.side = model.knee().side;
  source.setup.pipeline.guide_name = tools::standard_guide_name(bone);
  source.setup.pipeline.axes = landmarks::anatomical_axes(
      bone, model.knee().side, landmarks_of(model.knee(), bone), model.knee().bones.at(bone).mesh);
  return source;
}

void name_calibration(operation::SourceSetup& setup, bool is_simulated,
                      const std::filesystem::path& case_folder) {
  const std::string now_utc = files::utc_now();
  setup.calibration = open_case::calibration_in_words(is_simulated, case_folder, now_utc);
  setup.calibration_in_short =
      open_case::calibration_in_words(is_simulated, case_folder, now_utc, open_case::Dates::AsAge);
}

}  // namespace

std::string missing_for_simulation(const open_case::PlanModel& model, const tunnels::TunnelKey& key) {
  const bones::BoneKind bone = key.bone;
  if (!model.has_bone(bone)) return "the case has no " + std::string(bones::to_text(bone));
  if (!model.has_bone(bones::BoneKind::Femur) || !model.has_bone(bones::BoneKind::Tibia))
    return "the case has only one bone";
  if (!model.tunnel(key)) return "there is no planned tunnel to aim at";
  const landmarks::Landmarks& known = landmarks_of(model.knee(), bone);
  return known.contains("native_footprint") ? "" : "the landmarks of the bone are not known";
}

theatre::TheatreSource simulated_setup(const open_case::PlanModel& model, const tunnels::TunnelKey& key,
                                       const std::filesystem::path& case_folder, SimulatedPart part) {
  const bones::BoneKind bone = key.bone;
  theatre::TheatreSource source = source_of(model, bone, sources::SourceKind::Simulation);
  operation::SourceSetup& setup = source.setup;
  setup.title = part == SimulatedPart::Drill ? "Simulated operation: drill" : "Simulated operation: probe";
  setup.pipeline.calibrated =
      std::make_shared<const camera::CalibrationRecord>(open_case::camera_record_of(true, case_folder));
  setup.pipeline.calibration = setup.pipeline.calibrated->calibration;
  setup.pipeline.tools = open_case::tools_of(true, case_folder);
  name_calibration(setup, true, case_folder);
  setup.pipeline.refractive_index = camera::kSalineIndex;
  setup.draws = part == SimulatedPart::Scratch;
  simulator::SimulationOptions simulation;
  simulation.knee = phantom::knee_of(model.knee());
  simulation.camera = simulator::standard_camera();
  simulation.tools = tools::standard_tools();
  simulation.rest_count = kPlacesToTouch;
  simulation.draws = part != SimulatedPart::Touch;
  simulation.bone = bone;
  simulation.plan = *model.tunnel(key);
  simulation.refractive_index = setup.pipeline.refractive_index;
  // Written where the source is opened, read when a tunnel was drilled, which is later.
  const auto truth = std::make_shared<std::optional<tunnels::Tunnel>>();
  source.truth = [truth] { return *truth; };
  source.open = [simulation, part, truth]() -> std::unique_ptr<sources::FrameSource> {
    if (part != SimulatedPart::Drill)
      return std::make_unique<simulator::SimulatedOperation>(simulation, simulator::Phase::Scratch);
    auto drilling = std::make_unique<simulator::SimulatedOperation>(simulation, simulator::Phase::Drill);
    *truth = drilling->drilled_tunnel();
    return drilling;
  };
  return source;
}

namespace {

// With the case's own camera.json and tools.json.
theatre::TheatreSource real_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                                  const std::filesystem::path& case_folder, double refractive_index,
                                  sources::SourceKind kind) {
  if (!model.has_bone(bone)) throw InvalidInput("the case has no " + std::string(bones::to_text(bone)));
  theatre::TheatreSource source = source_of(model, bone, kind);
  operation::SourceSetup& setup = source.setup;
  if (!std::filesystem::exists(cases::camera_file(case_folder)))
    throw InvalidInput("no camera is calibrated for this case: do it in Set up (F4)");
  if (!std::filesystem::exists(cases::tools_file(case_folder)))
    throw InvalidInput("no tools are known in this case: make them known in Set up (F4)");
  const camera::CalibrationRecord camera = camera::read_camera_file(cases::camera_file(case_folder));
  setup.pipeline.calibration = camera.calibration;
  setup.pipeline.calibrated = std::make_shared<const camera::CalibrationRecord>(camera);
  setup.camera_is_simulated = camera.provenance.origin == provenance::Origin::Simulated;
  setup.pipeline.tools = tools::read_tools_file(cases::tools_file(case_folder));
  name_calibration(setup, false, case_folder);
  setup.pipeline.refractive_index = refractive_index;
  if (setup.pipeline.tools.find_world_marker(bone) == nullptr)
    throw InvalidInput("tools.json declares no world marker for the " + std::string(bones::to_text(bone)));
  return source;
}

}  // namespace

theatre::TheatreSource video_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                                   const std::filesystem::path& case_folder,
                                   const std::filesystem::path& video, double refractive_index) {
  theatre::TheatreSource source =
      real_setup(model, bone, case_folder, refractive_index, sources::SourceKind::Recording);
  if (source.setup.pipeline.tools.tracker)
    throw InvalidInput("the tools of this case are seen by an outside tracker: no recording shows them");
  source.setup.title = video.filename().string();
  source.open = [video] { return sources::open_video(video); };
  return source;
}

theatre::TheatreSource camera_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                                    const std::filesystem::path& case_folder, const LivePictures& pictures,
                                    const sources::DeviceTurns& turns, double refractive_index,
                                    const std::string& tracker_address) {
  theatre::TheatreSource source =
      real_setup(model, bone, case_folder, refractive_index, sources::SourceKind::Live);
  openigtlink::see_by(source.setup.pipeline.tools, tracker_address);
  for (const std::string& why_not :
       {open_case::camera_is_not_for_live(case_folder), open_case::tools_are_not_for_live(case_folder)})
    if (!why_not.empty()) throw InvalidInput(why_not);
  // A device that was just looked at is let go, opened, and gives its first picture, or is broken; a stream
  // takes up to 10 s to its first picture.
  constexpr double kDevicePatience_s = 9, kStreamPatience_s = 15;
  source.setup.title = pictures.name;
  source.patience_s = pictures.device ? kDevicePatience_s : kStreamPatience_s;
  if (pictures.device)
    source.open = [turns,
                   address = camera_address_of(pictures, source.setup.pipeline.calibration.image_size_px)] {
      return turns.open(address);
    };
  else
    source.open = [turns, address = pictures.address] { return turns.open_stream(address); };
  if (const auto& tracker = source.setup.pipeline.tools.tracker) {
    if (tracker->address.empty())
      throw InvalidInput(
          "tools.json names an outside tracker, and not where it is (\"tracker\": \"address\")");
    (void)openigtlink::tracker_address(tracker->address);
    for (std::string* const words : {&source.setup.calibration, &source.setup.calibration_in_short})
      *words += "; tools seen by " + tracker->address;
    source.tracker = [setup = source.setup.pipeline] { return openigtlink::listen_to_tracker(setup); };
  }
  return source;
}

bool has_real_scope(const std::filesystem::path& case_folder) {
  return !case_folder.empty() && open_case::has_real_camera(case_folder);
}

}  // namespace arthronaut::navigate
