#include <chrono>
#include <memory>
#include <optional>

#include "app/command_line/adopted_file.h"
#include "app/command_line/cartilage_option.h"
#include "app/command_line/command.h"
#include "app/command_line/interruption.h"
#include "app/command_line/known_registration.h"
#include "app/command_line/medium_option.h"
#include "app/command_line/navigation_report.h"
#include "app/command_line/option_checks.h"
#include "app/command_line/picture_size.h"
#include "app/command_line/tracker_option.h"
#include "app/command_line/tracking_report.h"
#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/openigtlink/igtl_server.h"
#include "navigation/sources/camera_device.h"
#include "navigation/theatre/navigate_source.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;

struct NavigateArguments {
  std::string case_folder, video, camera, tools, registration, probe = "probe", guide;
  std::string bone = "femur", tunnel, tracker, pictures = "as-they-came";
  std::optional<double> medium_index;
  double duration_s = 0;  // 0: to the end
  int igtl_port = -1;     // -1: nothing is served
  bool igtl_network = false;
  bool fixed_lens = false, no_copy = false;
  CLI::Option* probe_option = nullptr;
  CLI::Option* pictures_option = nullptr;
  CartilageArguments cartilage;
};

// A session that did not come to its end is removed: a command that fails leaves nothing behind.
class NewSession {
 public:
  explicit NewSession(const fs::path& case_folder) : folder_(cases::create_session_folder(case_folder)) {}
  ~NewSession() {
    std::error_code ignored;
    if (!kept_) fs::remove_all(folder_, ignored);
  }
  NewSession(const NewSession&) = delete;
  NewSession& operator=(const NewSession&) = delete;
  [[nodiscard]] const fs::path& folder() const { return folder_; }
  void keep() { kept_ = true; }

 private:
  fs::path folder_;
  bool kept_ = false;
};

// What is given on the command line, else what the case holds.
fs::path file_to_use(const std::string& given, const fs::path& of_case, const std::string& option) {
  if (!given.empty()) return given;
  if (fs::exists(of_case)) return of_case;
  throw InvalidInput(of_case, "", "is not in the case yet: give " + option);
}

fs::path camera_file_of(const NavigateArguments& arguments) {
  return file_to_use(arguments.camera, cases::camera_file(arguments.case_folder), "--camera");
}

pipeline::PipelineOptions pipeline_options(const NavigateArguments& arguments, const cases::Case& knee) {
  pipeline::PipelineOptions options;
  const fs::path folder = arguments.case_folder;
  options.calibrated =
      std::make_shared<const camera::CalibrationRecord>(camera::read_camera_file(camera_file_of(arguments)));
  options.calibration = options.calibrated->calibration;
  const fs::path tools_file = file_to_use(arguments.tools, cases::tools_file(folder), "--tools");
  options.tools = tools::read_tools_file(tools_file);
  use_tracker(arguments.tracker, tools_file, arguments.video, options.tools);
  options.refractive_index = arguments.medium_index.value_or(
      options.calibration.refractive_index == camera::kAirIndex ? camera::kSalineIndex
                                                                : options.calibration.refractive_index);
  options.follow_lens = !arguments.fixed_lens;
  options.bone = bones::bone_kind_from_text(arguments.bone);
  options.side = knee.side;
  options.probe_name = arguments.probe;
  options.guide_name = arguments.guide;
  if (options.guide_name.empty()) {
    options.guide_name = tools::standard_guide_name(options.bone);
  } else if (!options.tools.find_tool(options.guide_name)) {
    throw InvalidInput(tools_file, "tools", "declare none named \"" + options.guide_name + "\" (--guide)");
  }
  if (arguments.probe_option->count() > 0 && !options.tools.find_tool(options.probe_name)) {
    throw InvalidInput(tools_file, "tools", "declare none named \"" + options.probe_name + "\" (--probe)");
  }
  return options;
}

// Which of the bone's planned tunnels is guided to; nullopt where none is planned. Throws InvalidInput where
// two are planned and none is named, or one is named that is not planned: which one is drilled is never
// guessed.
std::optional<tunnels::TunnelKey> guided_tunnel(const NavigateArguments& arguments, const cases::Case& knee,
                                                bones::BoneKind bone) {
  const auto keys = knee.plan.of(bone);
  if (!arguments.tunnel.empty()) {
    const tunnels::TunnelKey key{bone, norms::bundle_from_text(arguments.tunnel)};
    if (!knee.plan.tunnels.contains(key))
      throw InvalidInput(arguments.case_folder, "plan.json", "holds no tunnel " + tunnels::name_of(key));
    return key;
  }
  if (keys.empty()) return std::nullopt;
  if (keys.size() > 1)
    throw InvalidInput(
        arguments.case_folder, "plan.json",
        "plans two tunnels in the " + arguments.bone + ": say by --tunnel which one is drilled, am or pl");
  return keys.front();
}

// Plan and registration of the case for this bone.
theatre::NavigateOptions navigate_options(const Context& context, const NavigateArguments& arguments,
                                          const cases::Case& knee) {
  // Before anything is opened: which tunnel is drilled has to be known first.
  const auto guided = guided_tunnel(arguments, knee, bones::bone_kind_from_text(arguments.bone));
  theatre::NavigateOptions options;
  options.source.kind = sources::kind_of_source(arguments.video);
  if (arguments.duration_s > 0) options.duration_s = arguments.duration_s;
  options.source.title = arguments.video;
  options.source.camera_is_simulated = warn_of_simulated_camera(camera_file_of(arguments));
  options.source.pipeline = pipeline_options(arguments, knee);
  const bones::BoneKind bone = options.source.pipeline.bone;
  const auto found = knee.bones.find(bone);
  if (found == knee.bones.end())
    throw InvalidInput(arguments.case_folder, "", "the case has no " + arguments.bone);
  const auto surface = std::make_shared<const geometry::Surface>(found->second.mesh);
  options.operation.bone = bone;
  options.operation.mesh_sha256 = bones::mesh_sha256(found->second.mesh);
  options.operation.surface = surface;
  if (guided) {
    const tunnels::Tunnel& tunnel = knee.plan.tunnels.at(*guided);
    const cases::PlanFit fit = cases::plan_fit(knee.plan, *guided, options.operation.mesh_sha256);
    if (fit.outcome == cases::PlanFit::Outcome::OtherMesh) context.say("plan: not used: " + fit.reason);
    if (fit.is_valid()) {
      options.operation.plan = {tunnel, tunnels::measure(tunnel, *surface).length_mm};
      if (guided->bundle != norms::Bundle::Whole)
        context.say("plan: the tunnel " + tunnels::name_of(*guided));
    }
  }
  const auto landmarks = knee.landmarks.find(bone);
  options.source.pipeline.axes = landmarks::anatomical_axes(
      bone, knee.side, landmarks != knee.landmarks.end() ? landmarks->second : landmarks::Landmarks(),
      found->second.mesh);
  options.registration =
      known_registration(context, arguments.registration, arguments.case_folder, knee, options);
  listen_to_tracker(context, options);
  // Case, bone, medium and source are all named by whoever typed the command.
  options.is_confirmed = true;
  return options;
}

// A camera gives the size that was calibrated, where it has it and no other one is asked for.
std::unique_ptr<sources::FrameSource> open_for(const std::string& video, const Eigen::Vector2i& size_px) {
  if (!sources::is_camera_address(video)) return sources::open_source(video);
  sources::CameraAddress address = sources::read_camera_address(video);
  address.wish.prefers_px = size_px;
  return sources::open_camera(address);
}

// A recording is shown as if it were now.
double captured_utc_s(const camera::Frame& picture) {
  using std::chrono::duration;
  const double now_s = files::utc_now_s();
  if (picture.captured_ns == 0) return now_s;
  const double steady_s = duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  return now_s - (steady_s - static_cast<double>(picture.captured_ns) * 1e-9);
}

// Ctrl+C ends a live source, and what was seen until then is kept, as at any other end of it. A recording can
// be run again: its half session is removed.
void stop_if_interrupted(const Interruption& interruption) {
  if (interruption.caught() != 0) throw theatre::StoppedByHand("stopped by hand");
}

// `interruption` begins with the session: until then Ctrl+C ends the program at once.
void navigate(Context& context, const NavigateArguments& arguments,
              std::optional<Interruption>& interruption) {
  const cases::CaseLock lock = cases::lock_or_refuse(arguments.case_folder);
  if (!lock.notice().empty()) context.say(lock.notice() + ".");
  const cases::Case knee = cases::load_case(arguments.case_folder);
  const AdoptedFile camera(arguments.camera, cases::camera_file(arguments.case_folder));
  const AdoptedFile tools(arguments.tools, cases::tools_file(arguments.case_folder));
  theatre::NavigateOptions options = navigate_options(context, arguments, knee);
  std::vector<std::string> doubts = camera_doubts(camera_file_of(arguments));  // before it becomes the case's
  if (options.source.camera_is_simulated && options.source.kind == sources::SourceKind::Live)
    doubts.push_back("the camera was calibrated on the simulator, and live pictures are of another");
  const bones::BoneKind kind = options.operation.bone;
  options.bone = std::make_shared<const registration::SurfaceIndex>(
      knee.bones.at(kind).mesh, cases::surface_index_file(arguments.case_folder, kind));
  const auto cartilage = arguments.cartilage.mesh.empty() ? cases::load_cartilage(arguments.case_folder, kind)
                                                          : read_cartilage(arguments.cartilage);
  if (cartilage) {
    options.operation.cartilage.emplace().points_mm = cartilage->vertices_mm;
    context.say(std::string("cartilage: ") + (arguments.cartilage.mesh.empty() ? "of the case" : "given"));
  }
  const std::shared_ptr<sources::FrameSource> source =
      open_for(arguments.video, options.source.pipeline.calibration.image_size_px);
  if (arguments.pictures_option->count() > 0 && !source->info().is_live())
    throw CLI::ValidationError("--pictures", "is of live sources; of a recording the video itself is copied");
  refuse_other_size(arguments.video, *source, options.source.pipeline.calibration);
  context.say("working medium: " + camera::medium_to_text(options.source.pipeline.refractive_index));

  std::optional<openigtlink::IgtlServer> igtl;
  if (arguments.igtl_port >= 0) {
    using openigtlink::Reach;
    igtl.emplace(arguments.igtl_port, arguments.igtl_network ? Reach::Network : Reach::ThisMachine);
    context.say("OpenIGTLink: port " + std::to_string(igtl->port()) +
                (arguments.igtl_network ? ", for other machines too" : ", for this machine alone"));
  }
  interruption.emplace();
  NewSession session(arguments.case_folder);
  theatre::NavigationSummary summary;
  {
    Progress progress("navigating", static_cast<long>(source->info().frame_count));
    long done = 0;
    theatre::NavigationObserver observer;
    observer.on_frame = [&](const camera::FramePtr& picture, const operation::OperationStatePtr& state) {
      progress.advance_to(++done);
      if (igtl) igtl->publish(state, captured_utc_s(*picture), picture);
      stop_if_interrupted(*interruption);
    };
    observer.on_late = [&](const camera::FramePtr&, const std::string& why,
                           const operation::OperationStatePtr&) {
      progress.advance_to(++done);
      if (igtl) igtl->tell({false, why}, files::utc_now_s());
      stop_if_interrupted(*interruption);
    };
    observer.on_silence = [&](const theatre::SourceWatch& watch, const operation::OperationStatePtr&) {
      const bool is_told = watch.trouble() != theatre::SourceTrouble::None;
      if (igtl) igtl->tell({false, is_told ? watch.words() : "no new picture"}, files::utc_now_s());
      stop_if_interrupted(*interruption);
    };
    theatre::RecordOptions record;
    record.folder = session.folder();
    if (source->info().is_live()) {
      record.keep = arguments.no_copy ? recording::KeepVideo::No : recording::KeepVideo::Encode;
      record.pictures = recording::pictures_as_from_option(arguments.pictures);
    } else {
      record.keep = arguments.no_copy ? recording::KeepVideo::Refer : recording::KeepVideo::Copy;
      record.video = arguments.video;
    }
    summary = theatre::navigate_source(source, options, record, observer);
  }
  session.keep();  // whole, whatever cannot be written beside it
  say_navigation(context, summary);
  context.say("session: " + session.folder().string());
  adopt(context, {camera, options.source.camera_is_simulated},
        {tools, has_simulated(options.source.pipeline.tools)}, arguments.case_folder);
  if (!arguments.cartilage.mesh.empty()) cases::save_cartilage(arguments.case_folder, kind, *cartilage);
  std::vector<std::string> reasons = std::move(doubts);
  reasons.insert(reasons.end(), summary.reasons.begin(), summary.reasons.end());
  for (std::string& reason : record_reasons(summary)) reasons.push_back(std::move(reason));
  if (!reasons.empty()) context.say_unreliable("the navigation", reasons);
}

}  // namespace

void add_navigate_command(CLI::App& app, Context& context) {
  CLI::App* command = add_subcommand(
      app, context, "navigate",
      "Track, digitise, register and guide on a recorded video or a live source; writes a session into the "
      "case",
      "arthronaut navigate knee.arthro --video scratch.mkv --camera camera.json --tools tools.json");
  const auto arguments = std::make_shared<NavigateArguments>();
  command->add_option("CASE", arguments->case_folder, "Case folder")->required();
  command
      ->add_option(
          "--video", arguments->video,
          "Video file, a pattern of still images such as f_%04d.png, or live: /dev/videoN, or what is wished "
          "of "
          "it as \"/dev/video0?format=mjpeg&size=1920x1080&rate=60&standard=pal&input=0\" (see sources), "
          "rtsp://..., udp://HOST:PORT (MPEG-TS), gst:PIPELINE ! appsink")
      ->required();
  command->add_option("--camera", arguments->camera,
                      "camera.json; copied into the case. Default: the case's");
  command->add_option("--tools", arguments->tools, "tools.json; copied into the case. Default: the case's");
  add_medium_option(
      *command, arguments->medium_index,
      "What the scope looks through: air, water, saline or a refractive index. Default: saline when the "
      "camera was calibrated in air, else the medium of the calibration");
  command->add_option("--bone", arguments->bone, "femur or tibia")
      ->check(CLI::IsMember({"femur", "tibia"}))
      ->capture_default_str();
  command
      ->add_option(
          "--tunnel", arguments->tunnel,
          "Which of the bone's planned tunnels is drilled: single, am or pl; needed where two are planned")
      ->check(CLI::IsMember({"single", "am", "pl"}));
  command->add_option(
      "--registration", arguments->registration,
      "registration.json to guide by, as that of an older session; live, by your word that the world marker "
      "has not moved since. Default: of a live source none, else that of the newest session of this bone, if "
      "it is reliable and of this world marker, camera and medium; strokes give a new one");
  add_cartilage_option(*command, arguments->cartilage.mesh, "; copied into the case. Default: the case's");
  add_mesh_options(*command, arguments->cartilage.space, arguments->cartilage.unit, "the cartilage's mesh");
  for (const char* of_the_cartilage : {"--space", "--unit"})
    command->get_option(of_the_cartilage)->needs("--cartilage");
  arguments->probe_option =
      command->add_option("--probe", arguments->probe, "Name of the touch probe in the tools")
          ->capture_default_str();
  command->add_option(
      "--guide", arguments->guide,
      "Name of the drill guide in the tools. Default: femoral guide or tibial guide, by the bone");
  command->add_flag("--fixed-lens", arguments->fixed_lens,
                    "The lens stays at the calibration's reference angle; the lens mark is not needed");
  command->add_flag("--no-copy", arguments->no_copy,
                    "Keep only the video's path in the session, not a copy of it; of a live source, nothing");
  arguments->pictures_option =
      command
          ->add_option("--pictures", arguments->pictures,
                       "How a live source's pictures are kept: as-they-came (a network stream's own packets; "
                       "lossless where "
                       "it has none), lossless, or h264 (a sixth on the disk; replayed with a tolerance)")
          ->check(CLI::IsMember({"as-they-came", "lossless", "h264"}))
          ->capture_default_str()
          ->excludes("--no-copy");
  command
      ->add_option("--igtl", arguments->igtl_port,
                   "Serve poses and states by OpenIGTLink on this port, 0 for any free one, while it runs")
      ->check(whole_between(0, 65535));
  command
      ->add_flag("--igtl-network", arguments->igtl_network,
                 "Serve other machines too, and not this one alone: there is no password")
      ->needs("--igtl");
  add_tracker_option(*command, arguments->tracker);
  command
      ->add_option(
          "--duration-s", arguments->duration_s,
          "Stop after so many seconds of pictures; default: at the source's end, of a live one also at "
          "Ctrl+C. Of a recording Ctrl+C leaves no session: it can be run again")
      ->check(above_zero());
  command->callback([&context, arguments] {
    std::optional<Interruption> interruption;
    try {
      navigate(context, *arguments, interruption);
    } catch (const DeviceError&) {
      if (interruption && interruption->caught() != 0) interruption->end_program();
      throw;
    }
  });
}

}  // namespace arthronaut::command_line
