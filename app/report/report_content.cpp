#include "app/report/report_content.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/report/other_sessions.h"
#include "app/report/report_words.h"
#include "app/report/session_rows.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/recording/drilled_by_word.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_overview.h"
#include "navigation/registration/provenance.h"
#include "planning/bones/mesh_hash.h"
#include "planning/files/format.h"
#include "planning/files/within_folder.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/plan_review/tunnel_verdict.h"
#include "planning/postop/achieved_file.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::report {

namespace {

struct ReadSession {
  std::unique_ptr<recording::RecordedSession> session;
  std::vector<operation::AchievedTunnel> achieved;
};

ReadSession read_session(const std::filesystem::path& folder) {
  ReadSession read{
      std::make_unique<recording::RecordedSession>(recording::RecordedSession::as_far_as_whole(folder)), {}};
  for (const auto& file : operation::achieved_files(folder))
    read.achieved.push_back(operation::read_achieved_file(file));
  return read;
}

void put(ReadSession read, Content& content) {
  content.session = std::move(read.session);
  content.achieved = std::move(read.achieved);
  content.registration.reset();
  content.registration_problem.clear();
  if (!content.session->events_are_whole()) {
    content.registration_problem = "what was done is not known to its end, nor which registration counts";
    return;
  }
  try {
    content.registration = registration_that_counts(*content.session);
  } catch (const InvalidInput& error) {
    content.registration_problem = files::within_folder(content.folder, error.what());
  } catch (const IoError& error) {
    content.registration_problem = files::within_folder(content.folder, error.what());
  }
}

enum class Registration { Found, Tried };

bool was_drilled_by_word(const std::filesystem::path& folder) {
  const recording::SessionOverview then = recording::read_overview(folder);
  return !recording::drilled_by_word(then.events, then.header.bone).empty();
}

// Where it has a drilled tunnel, by its poses or by word alone: true. Where it has such a registration alone,
// only while no other one is taken.
bool take_session(const std::filesystem::path& folder, Registration least, Content& content) {
  bool has_tunnel = false;
  unless_unreadable(folder, content, [&] {
    const bool is_whole = std::filesystem::exists(folder / "session.json");
    has_tunnel = !operation::achieved_files(folder).empty() || (is_whole && was_drilled_by_word(folder));
    if (!has_tunnel && (content.session || !is_whole)) return;
    ReadSession read = read_session(folder);
    // Which registration counts nobody knows then: one that is whole is told of in its place.
    if (!has_tunnel && !read.session->events_are_whole())
      throw InvalidInput(read.session->problems().front());
    const auto registration =
        read.session->events_are_whole() ? registration_that_counts(*read.session) : std::nullopt;
    const bool is_enough = registration && (registration->has_pose || least == Registration::Tried);
    if (has_tunnel || is_enough) put(std::move(read), content);
  });
  return has_tunnel && content.session != nullptr && content.session->folder() == folder;
}

// Better than none: the newest of those that cannot be read whole, as far as it is.
void take_damaged(const std::vector<std::filesystem::path>& sessions, Content& content) {
  for (auto it = sessions.rbegin(); it != sessions.rend() && !content.session; ++it) {
    const auto told = std::ranges::find(content.unreadable, it->filename().string(),
                                        &std::pair<std::string, std::string>::first);
    if (told == content.unreadable.end()) continue;
    try {
      put(read_session(*it), content);
      content.unreadable.erase(told);
    } catch (const InvalidInput&) {  // nothing of it: it is named as such
    } catch (const IoError&) {
    }
  }
}

// By the name of its folder, or by the number that stands before its date in Review; which must be there.
// What came after it is not told.
void take_named(const std::string& name, std::vector<std::filesystem::path>& sessions, Content& content) {
  const auto named = std::find_if(sessions.begin(), sessions.end(), [&](const auto& folder) {
    const std::int64_t number = cases::session_number(folder);
    return folder.filename() == name || (number > 0 && std::to_string(number) == name);
  });
  if (named == sessions.end()) {
    std::string words = "holds no operation's session \"" + name + "\"";
    for (const auto& folder : sessions)
      words += (folder == sessions.front() ? "; it holds " : ", ") + folder.filename().string();
    throw InvalidInput(content.folder, "", words);
  }
  sessions.erase(named + 1, sessions.end());
  put(read_session(sessions.back()), content);
}

bool is_of_another_surface(const Content& content) {
  if (content.session == nullptr) return false;
  const recording::SessionHeader& header = content.session->header();
  const auto bone = content.knee.bones.find(header.bone);
  return bone != content.knee.bones.end() &&
         recording::is_of_another_surface(header, bones::mesh_sha256(bone->second.mesh));
}

// A broken file of marks takes nothing else away.
void add_looked_at(Content& content, const ReportOptions& options) {
  const std::filesystem::path folder = content.session->folder();
  content.session_name = content.session->header().id;
  content.started_utc = content.session->header().started_utc;
  content.safety = safety_of(*content.session, recording::is_being_recorded(folder));
  for (const std::string& problem : content.session->problems())
    content.damaged.emplace_back(folder.filename().string(), files::within_folder(content.folder, problem));
  content.last_hash = recording::chain_head(folder);
  constexpr double kRead = 0.1;
  content.check = recording::check_session(folder, [&](std::int64_t done, std::int64_t all) {
    options.tell("Checking the record by its hashes",
                 kRead + (kGatheredShare - kRead) * static_cast<double>(done) / static_cast<double>(all));
  });
  try {
    content.marks = recording::read_marks(folder);
  } catch (const InvalidInput& error) {
    content.marks_problem = files::within_folder(content.folder, error.what());
  } catch (const IoError& error) {
    content.marks_problem = files::within_folder(content.folder, error.what());
  }
}

bool is_of_the_plan(const Content& content, const tunnels::TunnelKey& key,
                    const postop::AchievedTunnel& found) {
  return postop::is_against(found, key, content.knee.plan.tunnels) &&
         cases::plan_fit(content.knee, key).is_valid();
}

void add_places(Content& content) {
  for (const auto& [key, comparison] : content.postoperative) {
    const bool is_known = comparison.tunnel.is_found && content.review->has_bone(key.bone);
    if (is_known && is_of_the_plan(content, key, comparison.tunnel))
      content.places.emplace(key, postop::place_of(comparison.tunnel, content.knee.plan.tunnels.at(key),
                                                   content.review->bone(key.bone).surroundings,
                                                   plan_review::state_of_grid(content.knee, key.bone)));
  }
}

// A broken comparison takes nothing else away.
void add_postoperative(Content& content) {
  const std::filesystem::path file = content.folder / "achieved.json";
  if (!std::filesystem::exists(file)) return;
  try {
    content.postoperative = postop::read_achieved_file(file);
  } catch (const InvalidInput& error) {
    content.postoperative_problem = files::within_folder(content.folder, error.what());
  } catch (const IoError& error) {
    content.postoperative_problem = files::within_folder(content.folder, error.what());
  }
}

// Calibrating anew changes nothing of what was navigated before: of a session its own camera counts. A record
// of before holds the numbers alone; where the case still has the same ones, what it says of them is known.
void add_camera(Content& content) {
  std::optional<camera::CalibrationRecord> of_case;
  std::string problem;
  try {
    const std::filesystem::path file = cases::camera_file(content.folder);
    if (std::filesystem::exists(file)) of_case = camera::read_camera_file(file);
  } catch (const InvalidInput& error) {
    problem = files::within_folder(content.folder, error.what());
  } catch (const IoError& error) {
    problem = files::within_folder(content.folder, error.what());
  }
  if (content.session == nullptr) {
    content.camera = std::move(of_case);
    content.camera_problem = std::move(problem);
    return;
  }
  const pipeline::PipelineOptions options = content.session->pipeline_options();
  const camera::Calibration& calibration = options.calibration;
  const bool is_same = of_case && registration::camera_identity(of_case->calibration) ==
                                      registration::camera_identity(calibration);
  content.case_has_another_camera = of_case && !is_same;
  if (const auto& own = options.calibrated; own && (!own->date_utc.empty() || !own->scope_name.empty()))
    content.camera = *own;
  else if (is_same)
    content.camera = std::move(of_case);
  else
    content.camera.emplace().calibration = calibration;
}

void blank(Safety& safety) {
  if (!safety.cut_short.empty()) safety.cut_short = std::string("why is ") + kNotTold;
}

// The one place that says what strangers are not told: whoever the patient is, the session and the day, and
// what may name them: what somebody wrote, and the files and folders that a reason names.
void blank_for_strangers(Content& content) {
  content.knee.name = kDeidentifiedCase;
  content.knee.created_utc.clear();
  content.session_name.clear();
  content.started_utc.clear();
  blank(content.safety);
  for (Content::Earlier& earlier : content.earlier) earlier.session.clear();
  for (Content::Other& other : content.others) {
    other.session.clear();
    blank(other.safety);
  }
  for (Content::ByWord& said : content.by_word) said.session.clear();
  if (content.camera && !content.camera->date_utc.empty()) content.camera->date_utc = kNotTold;
  for (auto* const sessions : {&content.unreadable, &content.damaged}) {
    for (auto& [session, reason] : *sessions) {
      session.clear();
      reason.clear();
    }
  }
  for (recording::SessionMark& mark : content.marks)
    if (!mark.note.empty()) mark.note = kNotTold;
  for (std::string* const problem : {&content.registration_problem, &content.marks_problem,
                                     &content.postoperative_problem, &content.camera_problem})
    if (!problem->empty()) *problem = std::string("why is ") + kNotTold;
  for (recording::CheckFinding& finding : content.check.findings) {
    finding.what = finding.what.substr(0, finding.what.find(':'));  // after it: an error's own words
    if (finding.of.find('/') != std::string::npos)
      finding.of = "pictures";  // a source's files keep their names
  }
}

}  // namespace

std::vector<std::string> shortcomings_of(const Content& content) {
  std::vector<std::string> sentences;
  for (const auto& [session, reason] : content.unreadable)
    sentences.push_back(session.empty()
                            ? "a session of this case cannot be read and is not in it"
                            : "the session " + session + " cannot be read and is not in it: " + reason);
  for (const auto& [session, reason] : content.damaged)
    sentences.push_back((session.empty() ? "a session of this case" : "the session " + session) +
                        " is damaged and only in it as far as it is whole" +
                        (reason.empty() ? "" : ": " + reason));
  if (!content.registration_problem.empty())
    sentences.push_back("the registration cannot be read and is not in it: " + content.registration_problem);
  if (content.check.outcome == recording::SessionCheck::Outcome::Broken)
    sentences.push_back("the session " + content.session_name + (content.session_name.empty() ? "" : " ") +
                        "is no longer what was recorded: " + recording::check_words(content.check));
  if (const std::string side = plan_review::side_doubt(content.bone_doubts);
      !side.empty() && !content.knee.plan.tunnels.empty())
    sentences.push_back("the plan is wrong, and reported all the same: " + side);
  return sentences;
}

std::string grid_doubt(const Content& content, bones::BoneKind bone) {
  if (!content.review->has_bone(bone)) return "";
  return content.review->bone(bone).surroundings.has_grid() ? plan_review::grid_doubt(content.knee, bone)
                                                            : "";
}

std::optional<postop::AchievedPlace> place_of(const Content& content,
                                              const operation::AchievedTunnel& achieved) {
  const bones::BoneKind bone = achieved.planned.bone;
  if (!content.review->has_bone(bone) || content.is_of_another_surface) return std::nullopt;
  const double depth_mm = achieved.depth_mm.value_or(std::numeric_limits<double>::infinity());
  return postop::place_of(achieved.measured, depth_mm, achieved.planned,
                          content.review->bone(bone).surroundings,
                          plan_review::state_of_grid(content.knee, bone));
}

std::string difference_from_now(const Content& content, const tunnels::Tunnel& guided) {
  const auto now = content.knee.plan.tunnels.find(guided.key());
  if (now == content.knee.plan.tunnels.end()) return "planned no more";
  const operation::TunnelDifference by = operation::compare(guided, now->second);
  constexpr double kSame_mm = 0.05, kSame_deg = 0.05;  // as it is printed
  const double wider_mm = now->second.diameter_mm - guided.diameter_mm;
  if (by.entry_mm < kSame_mm && by.angle_deg < kSame_deg && std::abs(wider_mm) < kSame_mm) return "";
  return files::format(
      "changed since, by %.1f mm at the entry, %.1f\u00B0%s", by.entry_mm, by.angle_deg,
      std::abs(wider_mm) < kSame_mm ? "" : files::format(" and %+.1f mm in diameter", wider_mm).c_str());
}

std::string changed_since(const Content& content, const tunnels::Tunnel& guided) {
  const std::string by = difference_from_now(content, guided);
  return by.empty() ? ""
                    : "This tunnel was " + by +
                          ": what follows is against the plan that guided, not the one on the first pages.";
}

postop::ComparisonVerdict verdict_of(const Content& content, const tunnels::TunnelKey& key) {
  const postop::Comparison& comparison = content.postoperative.at(key);
  return postop::verdict_of(comparison, is_of_the_plan(content, key, comparison.tunnel));
}

std::vector<std::string> doubts_of(const Content& content, const tunnels::TunnelKey& key) {
  const postop::Comparison& comparison = content.postoperative.at(key);
  std::vector<std::string> doubts;
  if (verdict_of(content, key) == postop::ComparisonVerdict::OfAnEarlierPlan)
    doubts.emplace_back("the plan was changed since: compare again");
  for (const auto* reasons : {&comparison.bone.reasons, &comparison.tunnel.reasons})
    for (const std::string& reason : *reasons)
      if (std::find(doubts.begin(), doubts.end(), reason) == doubts.end()) doubts.push_back(reason);
  return doubts;
}

Content gather(const std::filesystem::path& folder, const ReportOptions& options) {
  options.tell("Reading the case and its sessions", 0);
  Content content{.folder = folder,
                  .knee = cases::load_case(folder),
                  .review = nullptr,
                  .bone_doubts = cases::load_bone_doubts(folder),
                  .session = nullptr,
                  .session_name = {},
                  .started_utc = {},
                  .registration = {},
                  .registration_problem = {},
                  .is_of_another_surface = false,
                  .safety = {},
                  .achieved = {},
                  .earlier = {},
                  .others = {},
                  .by_word = {},
                  .unreadable = {},
                  .damaged = {},
                  .marks = {},
                  .marks_problem = {},
                  .last_hash = {},
                  .check = {},
                  .camera = {},
                  .case_has_another_camera = false,
                  .camera_problem = {},
                  .postoperative = {},
                  .places = {},
                  .postoperative_problem = {},
                  .identity = std::nullopt};
  if (options.with_identity && !options.is_deidentified) content.identity = cases::load_identity(folder);
  auto sessions = recording::operation_folders(folder);
  if (!options.session.empty()) take_named(options.session, sessions, content);
  // The newest session with a drilled tunnel; failing that, the newest with a registration, at last with one
  // that found no pose.
  if (options.session.empty()) {
    bool has_tunnel = false;
    for (auto it = sessions.rbegin(); it != sessions.rend() && !has_tunnel; ++it)
      has_tunnel = take_session(*it, Registration::Found, content);
    for (auto it = sessions.rbegin(); it != sessions.rend() && !content.session; ++it)
      (void)take_session(*it, Registration::Tried, content);
    take_damaged(sessions, content);
  }
  const auto by_shape = plan_review::propose_landmarks(content.knee, plan_review::Proposing::Planned);
  content.review =
      std::make_unique<const plan_review::CaseReview>(content.knee, by_shape, content.bone_doubts);
  content.is_of_another_surface = is_of_another_surface(content);
  add_other_sessions(sessions, content);
  add_postoperative(content);
  add_places(content);
  add_camera(content);
  if (content.session) add_looked_at(content, options);
  if (options.is_deidentified) blank_for_strangers(content);
  return content;
}

}  // namespace arthronaut::report
