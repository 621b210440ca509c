#include "navigation/recording/drilled_before.h"

#include <optional>

#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_database.h"
#include "navigation/recording/session_files.h"
#include "planning/cases/case.h"

namespace arthronaut::recording {

namespace {

using operation::DrilledTunnels;
using tunnels::TunnelKey;

// What one session says, event by event.
class SaidOfDrilled {
 public:
  SaidOfDrilled(DrilledTunnels& said, const std::filesystem::path& folder, bones::BoneKind bone)
      : said_(said), folder_(folder), bone_(bone) {}

  void follow(const SessionEvent& event) {
    static const std::string kPlacedAnew = operation::to_text(operation::MarkerPlacedAnew{});
    if (event.kind == kSourceStartedEvent) said_.begin(bone_);
    if (event.kind == kPlanEvent) take_plan(event);
    if (is_registration(event) || event.kind == kVoidEvent || event.kind == kVerificationLostEvent)
      is_verified_ = false;
    if (event.kind == kVerifiedEvent) set_verified(true);
    if (event.kind == kVerificationSkippedEvent) set_verified(false);
    if (event.kind == kDrilledEvent) take_drilled(operation::read_achieved_file(folder_ / event.text));
    if (event.kind == kDrilledByWordEvent) take_drilled(std::nullopt);
    if (event.kind == kDrilledTakenBackEvent || event.kind == kSaidTooEarlyEvent) take_back(event.text);
    if (event.kind == kMarkerOutEvent) said_.say_marker(bone_, event.text.empty());
    if (event.kind == kCommandEvent && event.text == kPlacedAnew) said_.say_marker(bone_, false);
  }

 private:
  void take_plan(const SessionEvent& event) {
    const RecordedSession::PlanChange change = plan_from_text(event.text, database_file(folder_));
    plan_.reset();
    if (change.plan) plan_ = {*change.plan, change.planned_length_mm};
    drilled_.reset();
  }
  void take_drilled(const std::optional<operation::AchievedTunnel>& measured) {
    if (!plan_) return;
    said_.say_drilled({*plan_, measured, is_verified_});
    drilled_ = plan_->tunnel.key();
  }
  // What is verified later holds for the tunnel that was drilled by it just now.
  void set_verified(bool is_verified) {
    is_verified_ = is_verified;
    if (drilled_) said_.set_verified(*drilled_, is_verified);
  }
  // By the file that held it, or by its name.
  void take_back(const std::string& text) {
    for (const norms::Bundle bundle :
         {norms::Bundle::Whole, norms::Bundle::Anteromedial, norms::Bundle::Posterolateral})
      if (const TunnelKey key(bone_, bundle);
          text == operation::achieved_file_name(key) || text == tunnels::name_of(key))
        said_.take_back(key);
    drilled_.reset();
  }

  DrilledTunnels& said_;
  const std::filesystem::path& folder_;
  bones::BoneKind bone_;
  std::optional<operation::PlannedTunnel> plan_;  // in force
  std::optional<TunnelKey> drilled_;              // that was drilled last, as long as its plan is in force
  bool is_verified_ = false;
};

// In the order of the events; of a session that cannot be read to its end, nothing.
DrilledTunnels after_session(DrilledTunnels said, const std::filesystem::path& folder, bones::BoneKind bone) {
  SessionDatabase database = SessionDatabase::open(database_file(folder));
  Statement events = database.prepare("SELECT timestamp_ns, kind, text FROM events ORDER BY id");
  SaidOfDrilled session(said, folder, bone);
  while (events.step()) session.follow({events.integer(0), events.text(1), events.text(2)});
  return said;
}

}  // namespace

DrilledBefore drilled_before(const std::filesystem::path& case_folder,
                             const std::map<bones::BoneKind, std::string>& mesh_sha256) {
  DrilledBefore before;
  for (const std::filesystem::path& folder : cases::session_folders(case_folder)) {
    try {  // one broken session must not hide the others; that it was passed over is told
      pipeline::PipelineOptions options;
      const SessionHeader header = read_session_header(folder, options);
      const auto mesh = mesh_sha256.find(header.bone);
      if (header.source_kind != sources::SourceKind::Live || header.registers_after_mm > 0 ||
          mesh == mesh_sha256.end() || is_of_another_surface(header, mesh->second))
        continue;
      before.tunnels = after_session(before.tunnels, folder, header.bone);
      if (!is_being_recorded(folder))
        before.newest[header.bone] = folder;
      else
        before.newest.erase(header.bone);
    } catch (const std::runtime_error& error) {
      before.passed_over.emplace_back(error.what());
    }
  }
  return before;
}

}  // namespace arthronaut::recording
