// What else a tunnel could be, computed beside the screen: where about its entry every check is passed, and
// from where it can be drilled. True of one tunnel alone: shown until the next change.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/case/plan_model.h"
#include "app/scene/scene_content.h"
#include "navigation/worker/worker.h"
#include "planning/tunnels/entry_map.h"
#include "planning/tunnels/portal.h"

namespace arthronaut::plan {

// What is to be surveyed, with all that it rests on: it is read by another thread.
struct SurveyRequest {
  std::uint64_t revision = 0;  // of the model
  tunnels::Tunnel tunnel;
  std::shared_ptr<const geometry::Surface> surface;
  tunnels::PlanSurroundings surroundings;
  tunnels::KneeSurroundings knee;
  plan_review::MeasuredPlan others;  // the plan's other tunnels
};

struct Survey {
  std::uint64_t revision = 0;
  tunnels::TunnelKey key = bones::BoneKind::Femur;
  std::shared_ptr<const geometry::Surface> surface;
  // Within 10 mm of the entry, 1.25 mm apart, of tunnels of the same direction and diameter.
  std::vector<tunnels::EntrySample> entries;
  // Femur: the ways to this entry. Empty where the flexion axis or the bone's axes are not known.
  std::vector<tunnels::PortalAim> portal;
  std::vector<Eigen::Vector3d> outside_in;
};

// Of the tunnel as it is; nullopt where there is none.
[[nodiscard]] std::optional<SurveyRequest> survey_request(const open_case::PlanModel& model,
                                                          const tunnels::TunnelKey& key);
// Some 5 ms an entry: run it beside the screen. Ends early, with what is there by then, when is_cancelled
// says so.
[[nodiscard]] Survey survey(const SurveyRequest& request, const std::function<bool()>& is_cancelled = {});

// The lines along which the drill can come: clear ones of the portal, and those from outside in.
void add_aims(scene::SceneContent& content, const Survey& survey, const tunnels::Tunnel& tunnel,
              double length_mm);

class TunnelSurvey {
 public:
  // wake: called from the surveying thread when there is something new.
  explicit TunnelSurvey(const std::function<void()>& wake);

  // Of that very plan, asked for when it is not yet; null until it is there.
  [[nodiscard]] std::shared_ptr<const Survey> of(const open_case::PlanModel& model,
                                                 const tunnels::TunnelKey& key);

 private:
  std::uint64_t asked_revision_ = 0;
  tunnels::TunnelKey asked_key_ = bones::BoneKind::Femur;
  std::shared_ptr<const geometry::Surface> asked_surface_;
  worker::Worker<SurveyRequest, Survey> worker_;
};

}  // namespace arthronaut::plan
