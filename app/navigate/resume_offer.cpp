#include "app/navigate/resume_offer.h"

#include <utility>

#include "app/case/case_calibration.h"
#include "navigation/recording/declined_resume.h"
#include "navigation/registration/provenance.h"
#include "navigation/worker/freed_memory.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/files/utc_clock.h"
#include "planning/log/log.h"

namespace arthronaut::navigate {

namespace {

bool has_sessions(const std::filesystem::path& case_folder) {
  try {  // one that nobody may look into is found out by whoever writes into it
    return !cases::session_folders(case_folder).empty();
  } catch (const std::filesystem::filesystem_error& error) {
    log::error(std::string("nothing can be resumed: ") + error.what());
    return false;
  }
}

}  // namespace

ResumeOffer::ResumeOffer(std::function<void()> wake)
    : worker_(
          worker::Backlog::NewestWins,
          [](Worker::Inbox& inbox) {
            while (const auto asked = inbox.next()) inbox.publish(search(*asked));
          },
          std::move(wake)) {}

void ResumeOffer::open(const open_case::PlanModel& model, const std::filesystem::path& case_folder,
                       bool is_read_only, const std::string& crashed_since) {
  ++number_;
  crashed_since_ = crashed_since;
  left_.clear();
  answered_.clear();
  is_looking_ = !is_read_only && !case_folder.empty() && has_sessions(case_folder);
  if (!is_looking_) return;
  Search wanted{number_, case_folder, {}, model.knee().plan};
  for (const auto& [kind, bone] : model.knee().bones) wanted.meshes.emplace(kind, bone.mesh);
  worker_.post(std::move(wanted));
}

ResumeOffer::Found ResumeOffer::search(const Search& search) {
  Found all{search.number, {}};
  for (const auto& [kind, mesh] : search.meshes) {
    try {  // without it the operation begins afresh: no reason to end anything
      recording::ResumeSearch found =
          recording::find_resumable(search.case_folder, kind, bones::mesh_sha256(mesh), search.plan.of(kind));
      if (!found.left) {
        for (const std::string& broken : found.passed_over) log::error("nothing can be resumed: " + broken);
        continue;
      }
      LeftBehind left{std::move(*found.left), std::move(found.passed_over)};
      const registration::Provenance& of = left.found.operation.of;
      const bool is_simulated = of.source == sources::SourceKind::Simulation;
      const auto camera = open_case::camera_of(is_simulated, search.case_folder);
      const auto tools = open_case::tools_of(is_simulated, search.case_folder);
      left.has_same_camera = registration::camera_identity(camera) == of.camera;
      left.has_same_tools =
          registration::tools_identity(tools, kind, left.found.header.probe_name) == of.tools;
      all.left.emplace(kind, std::move(left));
    } catch (const std::runtime_error& error) {
      log::error(std::string("nothing can be resumed: ") + error.what());
    }
  }
  worker::give_freed_memory_back();  // whole sessions were read
  return all;
}

void ResumeOffer::follow() {
  if (!is_looking_) return;
  const auto newest = worker_.latest();
  if (worker_.has_ended()) is_looking_ = false;
  if (newest == nullptr || newest->number != number_) return;
  is_looking_ = false;
  left_ = newest->left;
  for (const auto& [bone, left] : left_)
    if (left.found.was_declined) answered_.insert(bone);
}

void ResumeOffer::decline(bones::BoneKind bone) {
  answer(bone);
  const auto left = left_.find(bone);
  if (left == left_.end()) return;
  // What cannot be kept holds for as long as the case is open: look_again() asks the file of what was.
  recording::decline_resume(left->second.found.folder);
  left->second.found.was_declined = true;
}

void ResumeOffer::look_again() {
  follow();
  for (auto& [bone, left] : left_) {
    if (!left.found.was_declined || recording::is_resume_declined(left.found.folder)) continue;
    left.found.was_declined = false;
    answered_.erase(bone);
  }
}

const LeftBehind* ResumeOffer::of(bones::BoneKind bone) {
  follow();
  const auto found = left_.find(bone);
  return found == left_.end() || answered_.contains(bone) ? nullptr : &found->second;
}

std::optional<bones::BoneKind> ResumeOffer::cut_off(std::chrono::system_clock::time_point now) {
  constexpr int kStillThere_h = 12;
  follow();
  std::optional<bones::BoneKind> newest;
  for (const auto& [bone, left] : left_) {
    // Between two sources a crash cuts off no record. What was closed before that program began is older.
    const bool is_of_crash =
        !crashed_since_.empty() && crashed_since_ <= files::utc_of(left.found.last_written);
    const bool is_crash = (is_of_crash || !left.found.was_finished) && !left.found.is_being_recorded;
    if (!is_crash || answered_.contains(bone) ||
        now - left.found.last_written > std::chrono::hours(kStillThere_h))
      continue;
    if (!newest || left.found.last_written > left_.at(*newest).found.last_written) newest = bone;
  }
  return newest;
}

bool ResumeOffer::is_looking() {
  follow();
  return is_looking_;
}

}  // namespace arthronaut::navigate
