#include "navigation/camera/camera_file.h"
#include "navigation/recording/frame_record.h"
#include "navigation/recording/kept_pictures.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

struct RecordedSession::State {
  std::filesystem::path folder;
  SessionHeader header;
  pipeline::PipelineOptions options;
  bool was_finished = false;
  std::vector<RecordedFrame> frames;
  std::vector<SessionEvent> events;
  std::vector<KeptPicture> pictures;  // empty when the video is the source's own
  strokes::Curves curves;
};

RecordedSession::RecordedSession(const std::filesystem::path& folder) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.folder = folder;
  if (!std::filesystem::is_directory(folder)) throw IoError(folder, "no such session");
  s.header = read_session_header(folder, s.options);
  s.options.calibrated =
      std::make_shared<const camera::CalibrationRecord>(camera::read_camera_file(folder / "camera.json"));
  s.options.calibration = s.options.calibrated->calibration;
  s.options.tools = tools::read_tools_file(folder / "tools.json");

  SessionDatabase database = SessionDatabase::open(database_file(folder));
  s.frames = read_frames(database);
  Statement events = database.prepare("SELECT timestamp_ns, kind, text, after_frame FROM events ORDER BY id");
  while (events.step()) {
    s.events.push_back({events.integer(0), events.text(1), events.text(2), events.integer(3)});
  }
  s.pictures = read_kept_pictures(database);
  s.was_finished = database.prepare("SELECT finished FROM ending").step();

  if (const auto file = folder / "curves.csv"; std::filesystem::exists(file)) {
    s.curves = strokes::read_curves_file(file);
  }
}

RecordedSession::~RecordedSession() = default;
RecordedSession::RecordedSession(RecordedSession&&) noexcept = default;
RecordedSession& RecordedSession::operator=(RecordedSession&&) noexcept = default;

const SessionHeader& RecordedSession::header() const { return state_->header; }
bool RecordedSession::was_finished() const { return state_->was_finished; }
const std::vector<RecordedFrame>& RecordedSession::frames() const { return state_->frames; }
const std::vector<SessionEvent>& RecordedSession::events() const { return state_->events; }
const std::vector<KeptPicture>& RecordedSession::pictures() const { return state_->pictures; }
const strokes::Curves& RecordedSession::curves() const { return state_->curves; }
std::optional<registration::RegistrationSummary> RecordedSession::registration() const {
  const std::filesystem::path file = state_->folder / "registration.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  return registration::read_registration_file(file);
}
pipeline::PipelineOptions RecordedSession::pipeline_options() const { return state_->options; }
std::filesystem::path RecordedSession::folder() const { return state_->folder; }

std::filesystem::path RecordedSession::video() const {
  const std::filesystem::path video = state_->header.video;
  return video.empty() || video.is_absolute() ? video : state_->folder / video;
}

RecordedSession::PlanChange RecordedSession::plan_of(const SessionEvent& event) const {
  return plan_from_text(event.text, database_file(state_->folder));
}

registration::RegistrationSummary RecordedSession::registration_of(const SessionEvent& event) const {
  return registration::read_registration_file(state_->folder / event.text);
}

}  // namespace arthronaut::recording
