#include "planning/plan_review/proposed_landmarks.h"

#include <future>

#include "planning/landmarks/grid_landmarks.h"
#include "planning/landmarks/insertion_grids.h"

namespace arthronaut::plan_review {

namespace {

bool has_grid(const cases::Case& knee, bones::BoneKind kind) {
  return landmarks::has_grid(knee.bones.at(kind).mesh, kind, knee.side, knee.landmarks.at(kind));
}

}  // namespace

std::map<bones::BoneKind, ProposedBone> propose_landmarks(cases::Case& knee, Proposing proposing,
                                                          const std::stop_token& stop,
                                                          const std::function<void()>& bone_done) {
  const auto done = [&bone_done] {
    if (bone_done) bone_done();
  };
  std::map<bones::BoneKind, std::future<ProposedBone>> coming;
  for (const auto& [kind, bone] : knee.bones) {
    knee.landmarks[kind];  // there for every bone, if empty
    knee.landmark_states[kind];
    if (bone.mesh.empty()) continue;
    const bool is_asked_for = proposing == Proposing::Planned ? !knee.plan.of(kind).empty()
                              : proposing == Proposing::WithoutConfirmed
                                  ? state_of_grid(knee, kind) != landmarks::LandmarkState::Confirmed
                                  : false;
    if (has_grid(knee, kind) && !is_asked_for) {
      done();
      continue;
    }
    coming[kind] =
        std::async(std::launch::async, [&mesh = bone.mesh, kind = kind, side = knee.side, stop, done] {
          ProposedBone made;
          made.surface = std::make_shared<const geometry::Surface>(mesh);
          made.proposal =
              landmarks::propose(mesh, kind, {.side = side, .surface = made.surface.get(), .stop = stop});
          done();
          return made;
        });
  }
  std::map<bones::BoneKind, ProposedBone> proposed;
  for (auto& [kind, made] : coming) {
    ProposedBone& bone = proposed[kind];
    bone = made.get();
    if (has_grid(knee, kind)) continue;
    const landmarks::Landmarks before = knee.landmarks[kind];
    landmarks::take_proposal(bone.proposal, knee.landmarks[kind], knee.landmark_states[kind]);
    bone.was_taken = knee.landmarks[kind] != before;
  }
  return proposed;
}

landmarks::LandmarkState state_of_grid(const cases::Case& knee, bones::BoneKind kind) {
  const auto marks = knee.landmarks.find(kind);
  const auto states = knee.landmark_states.find(kind);
  const bool is_confirmed =
      marks != knee.landmarks.end() &&
      landmarks::is_grid_confirmed(
          kind, marks->second,
          states == knee.landmark_states.end() ? landmarks::LandmarkStates{} : states->second);
  return is_confirmed ? landmarks::LandmarkState::Confirmed : landmarks::LandmarkState::Proposed;
}

}  // namespace arthronaut::plan_review
