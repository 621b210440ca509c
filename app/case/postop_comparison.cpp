#include "app/case/postop_comparison.h"

#include "planning/cases/same_patient.h"
#include "planning/geometry/error.h"
#include "planning/plan_review/plan_review.h"
#include "planning/plan_review/proposed_landmarks.h"
#include "planning/postop/achieved_file.h"

namespace arthronaut::open_case {

namespace {

// The planned tunnels that are asked for.
std::vector<tunnels::Tunnel> planned(const cases::Case& knee, const PostopQuestion& question) {
  std::vector<tunnels::Tunnel> wanted;
  for (const auto& [key, tunnel] : knee.plan.tunnels) {
    if (!question.bone.empty() && bones::bone_kind_from_text(question.bone) != key.bone) continue;
    if (const cases::PlanFit fit = cases::plan_fit(knee, key); !fit.is_valid())
      throw InvalidInput(question.case_folder, "plan.json", fit.reason);
    wanted.push_back(tunnel);
  }
  if (wanted.empty())
    throw InvalidInput(question.case_folder, "plan.json",
                       "holds no tunnel" + (question.bone.empty() ? "" : " in the " + question.bone) +
                           ": there is nothing to compare with");
  return wanted;
}

// Names nobody: it is kept, and goes out with reports that name nobody.
constexpr const char* kOtherPatient = "the images say that they are of another patient than the case";

// As whoever took them marked them: a wrong mark of the right knee is possible, too.
std::string other_side_of(const images::Volume& volume, const cases::Case& knee) {
  if (!volume.side || *volume.side == knee.side) return "";
  return "the images are marked as those of a " + std::string(bones::to_text(*volume.side)) +
         " knee, the case is a " + std::string(bones::to_text(knee.side)) + " one";
}

// Empty: of the same patient, or nobody says so.
std::string other_patient_of(const images::Volume& volume, const std::filesystem::path& case_folder) {
  const cases::Identity images{volume.patient.name, volume.patient.id, volume.patient.birth_date};
  const auto of_case = cases::load_identity(case_folder);
  return of_case && cases::is_another_patient(*of_case, images) ? images.in_words() : "";
}

// Why it is not relied on, in the order in which it is told; empty: nobody says.
std::string first_doubt(const postop::Comparison& one) {
  if (!one.bone.reliable && !one.bone.reasons.empty()) return one.bone.reasons.front();
  return !one.tunnel.reliable && !one.tunnel.reasons.empty() ? one.tunnel.reasons.front() : "";
}

using Comparisons = std::map<tunnels::TunnelKey, postop::Comparison>;

std::map<tunnels::TunnelKey, postop::AchievedPlace> places_of(cases::Case knee,
                                                              const Comparisons& comparisons) {
  std::map<tunnels::TunnelKey, postop::AchievedPlace> places;
  plan_review::propose_landmarks(knee, plan_review::Proposing::WithoutGrid);
  const plan_review::CaseReview review(knee);
  for (const auto& [key, comparison] : comparisons)
    if (comparison.tunnel.is_found)
      places.emplace(key, postop::place_of(comparison.tunnel, knee.plan.tunnels.at(key),
                                           review.bone(key.bone).surroundings,
                                           plan_review::state_of_grid(knee, key.bone)));
  return places;
}

void compare_all(const cases::Case& knee, const std::vector<tunnels::Tunnel>& plan,
                 const PostopQuestion& question, PostopAnswer& answer) {
  // By hundredths: the search tells more often than anybody can see.
  double told = -1;
  const auto tell = [&](const std::string& what, double done) {
    const double share = done / static_cast<double>(plan.size());
    if (!question.on_progress || share < told + 0.01) return;
    told = share;
    question.on_progress(what, share);
  };
  const auto stops = [&] { return answer.was_stopped = question.stops && question.stops(); };
  tell("Finding the bones in the images", 0);
  const postop::PostopImages images(answer.images);
  for (const tunnels::Tunnel& tunnel : plan) {
    if (stops()) return;
    const std::string what = "Comparing the " + tunnels::name_of(tunnel.key());
    const auto done = static_cast<double>(answer.comparisons.size());
    tell(what, done);
    std::vector<tunnels::Tunnel> others;
    for (const tunnels::Tunnel& other : plan)
      if (other.bone == tunnel.bone && other.bundle != tunnel.bundle) others.push_back(other);
    const auto goes_on = [&](double share) {
      tell(what, done + share);
      return !stops();
    };
    auto comparison = images.compare(knee.bones.at(tunnel.bone).mesh, tunnel, others, goes_on);
    if (answer.was_stopped) return;
    answer.comparisons[tunnel.key()] = std::move(comparison);
  }
  answer.places = places_of(knee, answer.comparisons);
  tell("Compared", static_cast<double>(plan.size()));
}

}  // namespace

std::vector<std::string> PostopAnswer::doubts() const {
  std::vector<std::string> reasons;
  for (const auto& [key, comparison] : comparisons) {
    const std::string name = tunnels::name_of(key);
    for (const std::string& reason : comparison.bone.reasons) reasons.push_back(name + ": " + reason);
    for (const std::string& reason : comparison.tunnel.reasons)
      reasons.push_back(name + ", tunnel: " + reason);
  }
  return reasons;
}

std::vector<BetterKept> better_kept_in(const std::filesystem::path& file, const PostopAnswer& answer) {
  std::vector<BetterKept> better;
  try {
    if (!std::filesystem::is_regular_file(file)) return better;
    for (const auto& [key, kept] : postop::read_achieved_file(file)) {
      const auto now = answer.comparisons.find(key);
      if (now == answer.comparisons.end() || is_relied_on(now->second, relied_on(kept))) continue;
      if (!answer.planned.contains(key) || postop::is_against(kept.tunnel, key, answer.planned))
        better.push_back({key, first_doubt(now->second)});
    }
  } catch (const InvalidInput&) {  // broken: it tells nobody anything
  }
  return better;
}

std::vector<BetterKept> keep_tunnel_by_tunnel(const std::filesystem::path& file,
                                              const std::filesystem::path& case_folder,
                                              const PostopAnswer& answer) {
  std::vector<BetterKept> better = better_kept_in(file, answer);
  if (better.empty()) {
    postop::write_achieved_file(file, answer.comparisons, answer.places);
    return better;
  }
  if (better.size() == answer.comparisons.size()) return better;
  const Comparisons before = postop::read_achieved_file(file);
  Comparisons kept;
  for (const auto& [key, why_not_now] : better) {
    postop::Comparison& stays = kept[key] = before.at(key);
    stays.kept_because =
        "newer images show it less well" + (why_not_now.empty() ? std::string() : ": " + why_not_now);
  }
  // Of this plan's, by the landmarks of now, as those beside them.
  const cases::Case knee = cases::load_case(case_folder);  // whose plan may have changed meanwhile
  Comparisons planned_now = kept;
  std::erase_if(planned_now, [&](const auto& one) { return !knee.plan.tunnels.contains(one.first); });
  auto places = places_of(knee, planned_now);
  places.insert(answer.places.begin(), answer.places.end());
  Comparisons together = kept;
  together.insert(answer.comparisons.begin(), answer.comparisons.end());
  postop::write_achieved_file(file, together, places);
  return better;
}

PostopAnswer compare_with_postop(const PostopQuestion& question) {
  const cases::Case knee = cases::load_case(question.case_folder);
  const auto plan = planned(knee, question);
  PostopAnswer answer;
  for (const tunnels::Tunnel& tunnel : plan) answer.planned.emplace(tunnel.key(), tunnel);
  postop::PostopSourceOptions options;
  options.series = question.series;
  options.labels = question.labels;
  options.on_progress = [&](double share) {
    if (question.on_progress) question.on_progress("Reading the images", share);
  };
  answer.images = question.read ? question.read(options) : postop::read_postop(question.source, options);
  if ((answer.was_stopped = question.stops && question.stops())) return answer;
  answer.other_patient = other_patient_of(answer.images, question.case_folder);
  if (question.refuses_another_patient && !answer.other_patient.empty()) return answer;
  try {
    compare_all(knee, plan, question, answer);
  } catch (const InvalidInput& error) {
    throw InvalidInput(question.source, "", error.what());
  }
  if (!answer.other_patient.empty()) {
    for (auto& [key, comparison] : answer.comparisons) postop::doubt(comparison, kOtherPatient);
  }
  if (const std::string other_side = other_side_of(answer.images, knee); !other_side.empty())
    for (auto& [key, comparison] : answer.comparisons) postop::doubt(comparison, other_side);
  return answer;
}

}  // namespace arthronaut::open_case
