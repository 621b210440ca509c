// What a report is made from. Inner header of report.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/report.h"
#include "app/report/session_rows.h"
#include "navigation/camera/camera_file.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_check.h"
#include "navigation/recording/session_marks.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/cases/identity.h"
#include "planning/plan_review/plan_review.h"
#include "planning/postop/achieved_place.h"
#include "planning/postop/comparison.h"

namespace arthronaut::report {

// What the report tells of: the case and, where there is one, the session that matters.
struct Content {
  std::filesystem::path folder;
  cases::Case knee;  // with proposed landmarks where its own give no grid
  std::unique_ptr<const plan_review::CaseReview> review = nullptr;  // of `knee`; never null once gathered
  cases::BoneDoubts bone_doubts = {};
  std::unique_ptr<recording::RecordedSession> session;
  // Of `session`, as they are told: for strangers empty, as is every name of a session below.
  std::string session_name = {}, started_utc = {};
  // Of `session`, the one that counts; and why it cannot be read, empty when it can.
  std::optional<registration::RegistrationSummary> registration = {};
  std::string registration_problem = {};
  // The case has another surface of its bone by now: nothing of it is drawn there, or measured against it.
  bool is_of_another_surface = false;
  Safety safety = {};                               // of `session`
  std::vector<operation::AchievedTunnel> achieved;  // in `session`
  // Planned tunnels of other bundles and of the other bone, drilled in sessions before it: after each start
  // of a source there is another. Of the same kind of source alone: a rehearsal says nothing of the patient.
  struct Earlier {
    operation::AchievedTunnel achieved;
    std::string session;
  };
  std::vector<Earlier> earlier = {};
  // The sessions that `earlier` and `by_word` tell of beside `session`: by what their tunnels were drilled.
  struct Other {
    std::string session;
    bones::BoneKind bone = bones::BoneKind::Femur;
    std::optional<registration::RegistrationSummary> registration = {};
    bool has_broken_registration = false;
    Safety safety = {};
    std::string plans = {};  // plans_in_words()
    std::vector<std::string> plan_warnings = {};
  };
  std::vector<Other> others = {};
  // Those of which the last that was said, in `session` or before it, is that they are drilled, and no pose
  // shows where: no number is told of them. at_s: from the beginning of `session`; empty: said in another
  // one.
  struct ByWord {
    std::string tunnel, why, session;
    std::optional<double> at_s;
    bool has_figures_of_before = false;  // the same tunnel is in `achieved` or `earlier`, too
  };
  std::vector<ByWord> by_word = {};
  // Sessions that may have been the one that matters, and cannot be read: their folders' names, and why; for
  // strangers both empty.
  std::vector<std::pair<std::string, std::string>> unreadable = {};
  // Damaged ones, which are in it as far as they are whole: their folders' names and what is missing, as
  // above.
  std::vector<std::pair<std::string, std::string>> damaged = {};
  recording::SessionMarks marks = {};  // of `session`: what whoever looked at it marked
  std::string marks_problem = {};      // why they cannot be read; empty when they can
  std::string last_hash = {};          // of the chain of `session`; empty: it has none, or a broken one
  recording::SessionCheck check = {};  // whether `session` is what was recorded
  // What `session` was navigated with; the case's of now where there is no session, and nothing where it has
  // none. Who calibrated it when, and how well, is told where it is known of these numbers.
  std::optional<camera::CalibrationRecord> camera = {};
  bool case_has_another_camera = false;  // than `session` had
  std::string camera_problem = {};       // why the case's cannot be read; empty when it can, or is not asked
  // With images after the operation, as the case's achieved.json keeps it.
  std::map<tunnels::TunnelKey, postop::Comparison> postoperative = {};
  // Of those of them that are against today's plan.
  std::map<tunnels::TunnelKey, postop::AchievedPlace> places = {};
  std::string postoperative_problem = {};   // why it cannot be read; empty when it can
  std::optional<cases::Identity> identity;  // where it is to be named
};

// How much of a report is done once it is gathered: the record is read for its hashes, the rest is drawing.
inline constexpr double kGatheredShare = 0.3;

// For strangers it names no patient, no session and no day, whatever is drawn of it. Throws IoError or
// InvalidInput (file, place, reason).
[[nodiscard]] Content gather(const std::filesystem::path& folder, const ReportOptions& options);

// What the report tells less of than was recorded, tells of what was not, or of a plan of the other side: a
// sentence each.
[[nodiscard]] std::vector<std::string> shortcomings_of(const Content& content);
// What speaks against the landmarks that percentages and axes of this bone follow from, in words that follow
// "Grid: "; empty where somebody has looked at them all, and where they give none.
[[nodiscard]] std::string grid_doubt(const Content& content, bones::BoneKind bone);
// Where navigation says that it was drilled; nullopt where the case lacks the bone, or has another surface.
[[nodiscard]] std::optional<postop::AchievedPlace> place_of(const Content& content,
                                                            const operation::AchievedTunnel& achieved);
// How the case's plan differs from what guided: "changed since, by 1.2 mm at the entry, 3.0°", "planned no
// more"; empty: it does not.
[[nodiscard]] std::string difference_from_now(const Content& content, const tunnels::Tunnel& guided);
// Where the plan is not the one any more that guided there: how it differs; else empty.
[[nodiscard]] std::string changed_since(const Content& content, const tunnels::Tunnel& guided);
[[nodiscard]] postop::ComparisonVerdict verdict_of(const Content& content, const tunnels::TunnelKey& key);
// Why it must not be relied on, each reason once; empty: reliable.
[[nodiscard]] std::vector<std::string> doubts_of(const Content& content, const tunnels::TunnelKey& key);

}  // namespace arthronaut::report
