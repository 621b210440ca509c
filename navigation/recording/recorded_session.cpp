#include <algorithm>
#include <stdexcept>
#include <utility>

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
  bool was_finished = false, events_are_whole = false, holds_frames = true;
  std::optional<std::int64_t> first_frame_ns;
  std::vector<RecordedFrame> frames;
  std::vector<SessionEvent> events;
  std::vector<KeptPicture> pictures;  // empty when the video is the source's own
  strokes::Curves curves;
  std::vector<std::string> problems;

  template <typename ReadPart>
  void read(const ReadPart& part);
  template <typename ReadPart>
  void read_record(const ReadPart& part);
};

// `part` runs what reads one of them: it lets pass what is thrown, or keeps it as a problem.
template <typename ReadPart>
void RecordedSession::State::read(const ReadPart& part) {
  if (!std::filesystem::is_directory(folder)) throw IoError(folder, "no such session");
  header = read_session_header(folder, options);
  part([&] {
    options.calibrated =
        std::make_shared<const camera::CalibrationRecord>(camera::read_camera_file(folder / "camera.json"));
    options.calibration = options.calibrated->calibration;
  });
  part([&] { options.tools = tools::read_tools_file(folder / "tools.json"); });
  part([&] { read_record(part); });
  part([&] {
    if (const auto file = folder / "curves.csv"; std::filesystem::exists(file))
      curves = strokes::read_curves_file(file);
  });
}

template <typename ReadPart>
void RecordedSession::State::read_record(const ReadPart& part) {
  SessionDatabase database = SessionDatabase::open(database_file(folder));
  part([&] {
    Statement first = database.prepare("SELECT timestamp_ns FROM frames ORDER BY frame LIMIT 1");
    if (first.step()) first_frame_ns = first.integer(0);
    if (!holds_frames) return;
    (void)recording::for_each_frame(database, [this](RecordedFrame& frame) {
      frames.push_back(std::move(frame));
      return true;
    });
  });
  part([&] {
    Statement row = database.prepare("SELECT timestamp_ns, kind, text, after_frame FROM events ORDER BY id");
    while (row.step()) events.push_back({row.integer(0), row.text(1), row.text(2), row.integer(3)});
    events_are_whole = true;
  });
  part([&] { pictures = read_kept_pictures(database); });
  part([&] { was_finished = database.prepare("SELECT finished FROM ending").step(); });
}

RecordedSession::RecordedSession(const std::filesystem::path& folder) : state_(std::make_unique<State>()) {
  state_->folder = folder;
  state_->read([](const auto& read) { read(); });
}

RecordedSession::RecordedSession(std::unique_ptr<State> state) : state_(std::move(state)) {}

RecordedSession RecordedSession::as_far_as_whole(const std::filesystem::path& folder) {
  auto state = std::make_unique<State>();
  state->folder = folder;
  // One damaged page may be met by every table.
  const auto tell = [&problems = state->problems](const std::string& problem) {
    if (std::ranges::find(problems, problem) == problems.end()) problems.push_back(problem);
  };
  try {  // what a newer version wrote is not understood, however whole it is
    (void)SessionDatabase::open(database_file(folder));
  } catch (const IoError&) {
    // Damaged, or not there: told below.
  }
  state->read([&](const auto& read) {
    try {
      read();
    } catch (const InvalidInput& error) {
      tell(error.what());
    } catch (const IoError& error) {
      tell(error.what());
    }
  });
  return RecordedSession(std::move(state));
}

RecordedSession RecordedSession::without_frames(const std::filesystem::path& folder) {
  auto state = std::make_unique<State>();
  state->folder = folder;
  state->holds_frames = false;
  state->read([](const auto& read) { read(); });
  return RecordedSession(std::move(state));
}

RecordedSession::~RecordedSession() = default;
RecordedSession::RecordedSession(RecordedSession&&) noexcept = default;
RecordedSession& RecordedSession::operator=(RecordedSession&&) noexcept = default;

const std::vector<std::string>& RecordedSession::problems() const { return state_->problems; }
bool RecordedSession::events_are_whole() const { return state_->events_are_whole; }
const SessionHeader& RecordedSession::header() const { return state_->header; }
bool RecordedSession::was_finished() const { return state_->was_finished; }
const std::vector<RecordedFrame>& RecordedSession::frames() const {
  if (!state_->holds_frames) throw std::logic_error("frames() of a session that was opened without them");
  return state_->frames;
}
std::optional<std::int64_t> RecordedSession::first_frame_ns() const { return state_->first_frame_ns; }
bool RecordedSession::for_each_frame(const std::function<bool(const RecordedFrame&)>& use) const {
  if (state_->holds_frames) return std::ranges::all_of(state_->frames, use);
  SessionDatabase database = SessionDatabase::open(database_file(state_->folder));
  return recording::for_each_frame(database, use);
}
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
