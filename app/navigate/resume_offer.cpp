#include "app/navigate/resume_offer.h"

#include <algorithm>
#include <utility>

#include "app/case/case_calibration.h"
#include "navigation/recording/declined_resume.h"
#include "navigation/recording/recording_lock.h"
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
    : worker_(worker::Backlog::NewestWins, work, std::move(wake)) {}

void ResumeOffer::work(Worker::Inbox& inbox) {
  constexpr std::chrono::milliseconds kLookEvery{500};
  while (const auto asked = inbox.next()) {
    auto found = std::make_shared<const Found>(search(*asked));
    inbox.publish(found);
    const auto is_recorded = [](const auto& left) { return left.second.found.is_being_recorded; };
    const auto has_ended = [&](const auto& left) {
      return is_recorded(left) && !recording::is_being_recorded(left.second.found.folder);
    };
    while (!inbox.stops() && !inbox.has_message() && std::ranges::any_of(found->left, is_recorded)) {
      inbox.wait_until(Worker::Clock::now() + kLookEvery);
      if (inbox.stops() || inbox.has_message() || std::ranges::none_of(found->left, has_ended)) continue;
      found = std::make_shared<const Found>(look_at_ended(*asked, *found));
      inbox.publish(found);
    }
  }
}

void ResumeOffer::open(const open_case::PlanModel& model, const std::filesystem::path& case_folder,
                       bool is_read_only, const std::string& crashed_since) {
  ++number_;
  crashed_since_ = crashed_since;
  left_.clear();
  answered_.clear();
  drilled_ = nullptr;
  is_looking_ = !case_folder.empty() && has_sessions(case_folder);
  if (!is_looking_) return;
  Search wanted{number_, case_folder, is_read_only, {}, model.knee().plan};
  for (const auto& [kind, bone] : model.knee().bones) wanted.meshes.emplace(kind, bone.mesh);
  worker_.post(std::move(wanted));
}

std::optional<LeftBehind> ResumeOffer::search_bone(const Search& search, bones::BoneKind kind,
                                                   const geometry::TriangleMesh& mesh) {
  if (search.is_read_only) return std::nullopt;
  try {  // without it the operation begins afresh: no reason to end anything
    recording::ResumeSearch found =
        recording::find_resumable(search.case_folder, kind, bones::mesh_sha256(mesh), search.plan.of(kind));
    if (!found.left) {
      for (const std::string& broken : found.passed_over) log::error("nothing can be resumed: " + broken);
      return std::nullopt;
    }
    LeftBehind left{std::move(*found.left), std::move(found.passed_over)};
    const registration::Provenance& of = left.found.operation.of;
    const bool is_simulated = of.source == sources::SourceKind::Simulation;
    const auto camera = open_case::camera_of(is_simulated, search.case_folder);
    const auto tools = open_case::tools_of(is_simulated, search.case_folder);
    left.has_same_camera = registration::camera_identity(camera) == of.camera;
    left.has_same_tools = registration::tools_identity(tools, kind, left.found.header.probe_name) == of.tools;
    return left;
  } catch (const std::runtime_error& error) {
    log::error(std::string("nothing can be resumed: ") + error.what());
    return std::nullopt;
  }
}

std::shared_ptr<const recording::DrilledBefore> ResumeOffer::search_drilled(const Search& search) {
  try {  // what nobody can read was drilled by no word: no reason to end anything
    std::map<bones::BoneKind, std::string> hashes;
    for (const auto& [kind, mesh] : search.meshes) hashes.emplace(kind, bones::mesh_sha256(mesh));
    auto before = std::make_shared<const recording::DrilledBefore>(
        recording::drilled_before(search.case_folder, hashes));
    for (const std::string& broken : before->passed_over) log::error("drilled tunnels: " + broken);
    return before;
  } catch (const std::runtime_error& error) {
    log::error(std::string("drilled tunnels: ") + error.what());
    return nullptr;
  }
}

ResumeOffer::Found ResumeOffer::search(const Search& search) {
  Found all{search.number, {}, search_drilled(search)};
  for (const auto& [kind, mesh] : search.meshes)
    if (auto left = search_bone(search, kind, mesh)) all.left.emplace(kind, std::move(*left));
  worker::give_freed_memory_back();  // whole sessions were read
  return all;
}

ResumeOffer::Found ResumeOffer::look_at_ended(const Search& search, Found found) {
  for (const auto& [kind, mesh] : search.meshes) {
    const auto before = found.left.find(kind);
    if (before == found.left.end() || !before->second.found.is_being_recorded ||
        recording::is_being_recorded(before->second.found.folder))
      continue;
    auto left = search_bone(search, kind, mesh);
    // Another one that was begun since, here or elsewhere, is not what was left.
    const bool is_same = left && left->found.folder == before->second.found.folder;
    found.left.erase(before);
    if (is_same) found.left.emplace(kind, std::move(*left));
  }
  found.drilled = search_drilled(search);
  worker::give_freed_memory_back();
  return found;
}

void ResumeOffer::follow() {
  const auto newest = worker_.latest();
  if (worker_.has_ended()) is_looking_ = false;
  if (newest == nullptr || newest == followed_ || newest->number != number_) return;
  followed_ = newest;
  is_looking_ = false;
  left_ = newest->left;
  drilled_ = newest->drilled;
  for (const auto& [bone, left] : left_)
    if (left.found.was_declined) answered_.insert(bone);
}

std::shared_ptr<const recording::DrilledBefore> ResumeOffer::take_drilled() {
  follow();
  return std::exchange(drilled_, nullptr);
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
