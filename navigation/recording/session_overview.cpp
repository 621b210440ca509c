#include "navigation/recording/session_overview.h"

#include <algorithm>

#include "navigation/camera/camera_file.h"
#include "navigation/recording/kept_pictures.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_database.h"
#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

// One damaged page may be met by every table.
void tell(SessionOverview& overview, const std::string& problem) {
  if (std::ranges::find(overview.problems, problem) == overview.problems.end())
    overview.problems.push_back(problem);
}

// What was read before it broke off stays.
template <typename Read>
void as_far_as_whole(SessionOverview& overview, const Read& read) {
  try {
    read();
  } catch (const InvalidInput& error) {
    tell(overview, error.what());
  } catch (const IoError& error) {
    tell(overview, error.what());
  }
}

void read_record(SessionOverview& overview) {
  SessionDatabase database = SessionDatabase::open(database_file(overview.folder));
  as_far_as_whole(overview, [&] {
    Statement row = database.prepare("SELECT timestamp_ns, kind, text, after_frame FROM events ORDER BY id");
    while (row.step()) overview.events.push_back({row.integer(0), row.text(1), row.text(2), row.integer(3)});
    overview.events_were_read = true;
  });
  as_far_as_whole(overview, [&] { overview.pictures = read_kept_pictures(database); });
  as_far_as_whole(overview, [&] {
    overview.was_finished = database.prepare("SELECT finished FROM ending").step();
    overview.end_was_read = true;
  });
}

void look_for_video(SessionOverview& overview) {
  const std::filesystem::path file = overview.video();
  const bool is_pattern = file.string().find('%') != std::string::npos;
  if (!file.empty() && !is_pattern && !std::filesystem::exists(file))
    overview.problems.push_back(file.string() + ": the video is not there any more");
  for (const VideoPart& part : overview.header.video_parts)
    if (part.file != overview.header.video && !std::filesystem::exists(overview.folder / part.file))
      overview.problems.push_back((overview.folder / part.file).string() +
                                  ": this part of the video is not there any more");
}

}  // namespace

std::filesystem::path SessionOverview::video() const {
  const std::filesystem::path video = header.video;
  return video.empty() || video.is_absolute() ? video : folder / video;
}

RecordedSession::PlanChange SessionOverview::plan_of(const SessionEvent& event) const {
  return plan_from_text(event.text, database_file(folder));
}

bool must_hold_registration(bool was_finished, const std::vector<SessionEvent>& events) {
  return was_finished && std::ranges::any_of(events, [](const SessionEvent& event) {
           return event.kind == kRegistrationEvent;
         });
}

SessionOverview read_overview(const std::filesystem::path& session_folder) {
  SessionOverview overview;
  overview.folder = session_folder;
  if (!std::filesystem::is_directory(session_folder)) throw IoError(session_folder, "no such session");
  overview.is_being_recorded = is_being_recorded(session_folder);
  overview.header = read_session_header(session_folder, overview.options);
  as_far_as_whole(overview, [&] {
    overview.options.calibrated = std::make_shared<const camera::CalibrationRecord>(
        camera::read_camera_file(session_folder / "camera.json"));
    overview.options.calibration = overview.options.calibrated->calibration;
  });
  as_far_as_whole(overview,
                  [&] { overview.options.tools = tools::read_tools_file(session_folder / "tools.json"); });
  as_far_as_whole(overview, [&] { read_record(overview); });
  look_for_video(overview);
  as_far_as_whole(overview, [&] {
    if (const auto file = session_folder / "curves.csv"; std::filesystem::exists(file))
      overview.curves = strokes::read_curves_file(file);
  });
  as_far_as_whole(overview, [&] {
    if (const auto file = session_folder / "registration.json"; std::filesystem::exists(file))
      overview.registration = registration::read_registration_file(file);
  });
  if (const auto file = session_folder / "registration.json";
      must_hold_registration(overview.was_finished, overview.events) && !std::filesystem::exists(file))
    tell(overview, file.string() + ": is not there any more");
  return overview;
}

}  // namespace arthronaut::recording
