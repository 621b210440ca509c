// What else a tunnel could be, computed beside the screen: where about its entry every check is passed, and
// from where it can be drilled. True of one tunnel alone: shown until the next change.
#pragma once

#include <atomic>
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
  bool has_aims = false;  // these are made after the map, and take longer
  // Femur: the ways to this entry. Empty where the flexion axis or the bone's axes are not known.
  std::vector<tunnels::PortalAim> portal;
  std::vector<Eigen::Vector3d> outside_in;
};

// Of the tunnel as it is; nullopt where there is none.
[[nodiscard]] std::optional<SurveyRequest> survey_request(const open_case::PlanModel& model,
                                                          const tunnels::TunnelKey& key);
// Some 5 ms an entry, on a bone of a few 10,000 triangles: run it beside the screen. Ends early, with what is
// there by then, when is_cancelled says so. tell: which share is done, 0 to 1; map_made: with what is there
// when the map is, before the aims.
[[nodiscard]] Survey survey(const SurveyRequest& request, const std::function<bool()>& is_cancelled = {},
                            const std::function<void(double done)>& tell = {},
                            const std::function<void(const Survey& map)>& map_made = {});

// What the map's marks mean, how many there are of each, and which checks of the tunnel nobody can make: what
// these would say no dot says. of_tunnel: its checks.
[[nodiscard]] std::string map_in_words(const Survey& survey,
                                       const std::vector<tunnels::PlanCheck>& of_tunnel);

// The lines along which the drill can come: clear ones of the portal, and those from outside in.
void add_aims(scene::SceneContent& content, const Survey& survey, const tunnels::Tunnel& tunnel,
              double length_mm);

class TunnelSurvey {
 public:
  // wake: called from the surveying thread when there is something new.
  explicit TunnelSurvey(const std::function<void()>& wake);

  // Of that very plan, asked for when it is not yet; null until its map is there.
  [[nodiscard]] std::shared_ptr<const Survey> of(const open_case::PlanModel& model,
                                                 const tunnels::TunnelKey& key);
  [[nodiscard]] double done_fraction() const { return done_; }  // of what was asked for last, aims and all

 private:
  std::atomic<double> done_ = 0;
  std::uint64_t asked_revision_ = 0;
  tunnels::TunnelKey asked_key_ = bones::BoneKind::Femur;
  std::shared_ptr<const geometry::Surface> asked_surface_;
  worker::Worker<SurveyRequest, Survey> worker_;
};

}  // namespace arthronaut::plan
