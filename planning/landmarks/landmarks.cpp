#include "planning/landmarks/landmarks.h"

#include <algorithm>
#include <array>

#include "planning/geometry/error.h"

namespace arthronaut::landmarks {

namespace {

constexpr std::array kFemur{
    LandmarkKind{"blumensaat_anterior", "Blumensaat's line, anterior end",
                 "where the roof of the notch turns into the groove of the kneecap"},
    LandmarkKind{"blumensaat_posterior", "Blumensaat's line, posterior end",
                 "where the roof of the notch turns into the back of the shaft"},
    LandmarkKind{"notch_apex", "Notch, apex",
                 "the middle of the roof's ridge, halfway along Blumensaat's line"},
    LandmarkKind{"lateral_condyle_center", "Lateral condyle, centre",
                 "centre of the circle that its posterior outline follows in the lateral view"},
    LandmarkKind{"medial_condyle_center", "Medial condyle, centre",
                 "centre of the circle that its posterior outline follows in the lateral view"},
    LandmarkKind{"lateral_condyle_posterior", "Lateral condyle, posterior", "its most posterior point"},
    LandmarkKind{"medial_condyle_posterior", "Medial condyle, posterior", "its most posterior point"},
    LandmarkKind{"lateral_condyle_deep", "Lateral condyle, deep end",
                 "where a line at right angles to Blumensaat's touches its posterior outline"},
    LandmarkKind{"lateral_condyle_shallow", "Lateral condyle, shallow end",
                 "where a line at right angles to Blumensaat's touches its anterior outline"},
    LandmarkKind{"lateral_condyle_low", "Lateral condyle, low end",
                 "where a line along Blumensaat's touches its outline furthest from it"},
    LandmarkKind{"lateral_epicondyle", "Lateral epicondyle", "the outermost point of the lateral side"},
    LandmarkKind{"medial_epicondyle", "Medial epicondyle", "the outermost point of the medial side"},
    LandmarkKind{"shaft_distal", "Long axis, distal", "the axis of the shaft, its lower point"},
    LandmarkKind{"shaft_proximal", "Long axis, proximal", "the axis of the shaft, its upper point"},
    LandmarkKind{"native_footprint", "Native footprint",
                 "the centre of the ligament's own insertion, where it was seen"},
};

constexpr std::array kTibia{
    LandmarkKind{"plateau_anterior", "Plateau, anterior edge", "the foremost point of the plateau's rim"},
    LandmarkKind{"plateau_posterior", "Plateau, posterior edge", "the hindmost point of the plateau's rim"},
    LandmarkKind{"plateau_medial", "Plateau, medial edge", "the innermost point of the plateau's rim"},
    LandmarkKind{"plateau_lateral", "Plateau, lateral edge", "the outermost point of the plateau's rim"},
    LandmarkKind{"medial_eminence", "Medial eminence", "the tip of the medial intercondylar tubercle"},
    LandmarkKind{"lateral_eminence", "Lateral eminence", "the tip of the lateral intercondylar tubercle"},
    LandmarkKind{"tuberosity", "Tuberosity", "the foremost point of the tibial tuberosity"},
    LandmarkKind{"shaft_proximal", "Long axis, proximal", "the axis of the shaft, its upper point"},
    LandmarkKind{"shaft_distal", "Long axis, distal", "the axis of the shaft, its lower point"},
    LandmarkKind{"native_footprint", "Native footprint",
                 "the centre of the ligament's own insertion, where it was seen"},
};

}  // namespace

std::string_view to_text(LandmarkState state) {
  return state == LandmarkState::Proposed ? "proposed" : "confirmed";
}

LandmarkState landmark_state_from_text(std::string_view text) {
  if (text == "proposed") return LandmarkState::Proposed;
  if (text == "confirmed") return LandmarkState::Confirmed;
  throw InvalidInput("\"" + std::string(text) + "\" is no state of a landmark: proposed or confirmed");
}

LandmarkState state_of(const LandmarkStates& states, std::string_view name) {
  const auto found = states.find(std::string(name));
  return found == states.end() ? LandmarkState::Confirmed : found->second;
}

std::span<const LandmarkKind> known_landmarks(bones::BoneKind bone) {
  if (bone == bones::BoneKind::Femur) return kFemur;
  return kTibia;
}

const LandmarkKind* find_landmark(bones::BoneKind bone, std::string_view name) {
  const auto known = known_landmarks(bone);
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& kind) { return kind.name == name; });
  return found == known.end() ? nullptr : &*found;
}

}  // namespace arthronaut::landmarks
