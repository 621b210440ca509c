#include <nlohmann/json.hpp>
#include <set>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "planning/cases/case.h"
#include "planning/cases/case_lock.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/landmarks/off_shape.h"
#include "planning/landmarks/propose.h"

namespace arthronaut::command_line {

namespace {

using bones::BoneKind;
using landmarks::LandmarkState;

struct LandmarkArguments {
  std::string case_folder;
  std::vector<std::string> set, confirm;
  bool propose = false, as_json = false;
  std::string roof = "ends";
};

struct NamedPlace {
  BoneKind bone = BoneKind::Femur;
  std::string name;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
};

// "femur.notch_apex"; the name empty in "femur".
NamedPlace place_from(const std::string& text) {
  const auto dot = text.find('.');
  NamedPlace place;
  place.bone = bones::bone_kind_from_text(text.substr(0, dot));
  if (dot == std::string::npos) return place;
  place.name = text.substr(dot + 1);
  if (landmarks::find_landmark(place.bone, place.name) == nullptr) {
    std::string known;
    for (const auto& kind : landmarks::known_landmarks(place.bone)) known += " " + std::string(kind.name);
    throw InvalidInput("the " + std::string(bones::to_text(place.bone)) + " has no landmark \"" + place.name +
                       "\"; it has" + known);
  }
  return place;
}

// "femur.notch_apex=1,2,3".
NamedPlace placed_from(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || text.find('.') == std::string::npos)
    throw InvalidInput("\"" + text + "\" is not BONE.NAME=x,y,z");
  NamedPlace place = place_from(text.substr(0, equals));
  std::string rest = text.substr(equals + 1) + ",";
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto comma = rest.find(',');
    const std::string number = comma == std::string::npos ? "" : rest.substr(0, comma);
    std::size_t used = 0;
    try {
      place.at_mm[k] = std::stod(number, &used);
    } catch (const std::logic_error&) {
      used = 0;
    }
    if (used == 0 || used != number.size() || !std::isfinite(place.at_mm[k]))
      throw InvalidInput("\"" + text + "\" is not BONE.NAME=x,y,z");
    rest.erase(0, comma + 1);
  }
  if (!rest.empty()) throw InvalidInput("\"" + text + "\" has more than three numbers");
  return place;
}

// What somebody placed, and what he looked at and calls right.
struct NamedPlaces {
  std::vector<NamedPlace> placed, confirmed;
};

constexpr std::string_view kAll = "all";  // that the case holds

NamedPlaces places_of(const LandmarkArguments& arguments, const cases::Case& knee) {
  NamedPlaces places;
  for (const std::string& text : arguments.set) places.placed.push_back(placed_from(text));
  for (const std::string& text : arguments.confirm) {
    if (text != kAll) {
      places.confirmed.push_back(place_from(text));
      continue;
    }
    for (const auto& [kind, bone] : knee.bones) places.confirmed.push_back({.bone = kind, .name = ""});
  }
  return places;
}

const bones::Bone& bone_of(const cases::Case& knee, BoneKind kind, const std::string& folder) {
  const auto found = knee.bones.find(kind);
  if (found == knee.bones.end())
    throw InvalidInput(folder, "case.json", "holds no " + std::string(bones::to_text(kind)));
  return found->second;
}

void refuse_far_off(const bones::Bone& bone, const NamedPlace& place, const std::string& folder) {
  constexpr double kFarOff_mm = 60;  // long axes and centres lie inside; further off it is another frame
  const auto bounds = geometry::bounds_of(bone.mesh);
  const Eigen::Vector3d nearest = place.at_mm.cwiseMax(bounds.min_mm).cwiseMin(bounds.max_mm);
  if ((nearest - place.at_mm).norm() > kFarOff_mm) {
    const std::string name(bones::to_text(place.bone));
    throw InvalidInput(folder, name,
                       files::format("--set %s.%s lies %.0f mm off it", name.c_str(), place.name.c_str(),
                                     (nearest - place.at_mm).norm()));
  }
}

nlohmann::ordered_json to_json(const cases::Case& knee,
                               const std::map<BoneKind, landmarks::Proposal>& proposals) {
  auto bones = nlohmann::ordered_json::array();
  for (const auto& [kind, bone] : knee.bones) {
    nlohmann::ordered_json node = {{"bone", bones::to_text(kind)}};
    if (const auto made = proposals.find(kind); made != proposals.end()) {
      const auto& by_shape = made->second.side_by_shape;
      node["side_by_shape"] =
          by_shape ? nlohmann::ordered_json(bones::to_text(*by_shape)) : nlohmann::ordered_json();
      if (kind == BoneKind::Femur && made->second.is_usable()) {
        node["roof"] = landmarks::to_text(made->second.roof);
        node["hill_mm"] = made->second.hill_mm;
      }
      auto doubts = made->second.doubts;
      if (!made->second.is_usable()) doubts.push_back(made->second.reason);
      node["doubts"] = doubts;
    }
    auto list = nlohmann::ordered_json::array();
    const auto marks = knee.landmarks.find(kind);
    const auto states = knee.landmark_states.find(kind);
    for (const auto& known : landmarks::known_landmarks(kind)) {
      if (marks == knee.landmarks.end() || !marks->second.contains(std::string(known.name))) continue;
      const auto state = states == knee.landmark_states.end()
                             ? LandmarkState::Confirmed
                             : landmarks::state_of(states->second, known.name);
      list.push_back({{"name", known.name},
                      {"position_mm", files::to_json(marks->second.at(std::string(known.name)))},
                      {"state", landmarks::to_text(state)}});
    }
    node["landmarks"] = std::move(list);
    bones.push_back(std::move(node));
  }
  return {{"format", "arthronaut.landmarks"},
          {"version", 1},
          {"side", bones::to_text(knee.side)},
          {"bones", bones}};
}

void list(const Context& context, const cases::Case& knee) {
  for (const auto& [kind, bone] : knee.bones) {
    context.say(std::string(bones::to_text(kind)) + ":");
    const auto marks = knee.landmarks.find(kind);
    if (marks == knee.landmarks.end()) {
      context.say("  no landmarks; --propose finds them from the shape");
      continue;
    }
    const auto states = knee.landmark_states.find(kind);
    for (const auto& [name, at] : marks->second) {
      const auto state = states == knee.landmark_states.end() ? LandmarkState::Confirmed
                                                              : landmarks::state_of(states->second, name);
      context.say(files::format("  %-26s %9.2f, %9.2f, %9.2f mm  %s", name.c_str(), at.x(), at.y(), at.z(),
                                std::string(landmarks::to_text(state)).c_str()));
    }
  }
}

// True when something was changed.
bool change(const LandmarkArguments& arguments, const NamedPlaces& places, cases::Case& knee,
            std::map<BoneKind, landmarks::Proposal>& proposals) {
  for (const NamedPlace& place : places.placed)
    refuse_far_off(bone_of(knee, place.bone, arguments.case_folder), place, arguments.case_folder);
  if (arguments.propose) {
    const Progress progress("Looking for landmarks", 0);
    for (const auto& [kind, bone] : knee.bones) {
      proposals[kind] =
          landmarks::propose(bone.mesh, kind,
                             {.side = knee.side,
                              .roof = arguments.roof == "ends" ? landmarks::RoofConvention::Ends
                                                               : landmarks::RoofConvention::Flat});
      if (proposals[kind].is_usable())
        landmarks::take_proposal(proposals[kind], knee.landmarks[kind], knee.landmark_states[kind]);
    }
  }
  for (const NamedPlace& place : places.placed) {
    knee.landmarks[place.bone][place.name] = place.at_mm;
    knee.landmark_states[place.bone][place.name] = LandmarkState::Confirmed;
  }
  for (const NamedPlace& place : places.confirmed) {
    const auto marks = knee.landmarks.find(place.bone);
    if (marks == knee.landmarks.end() || (!place.name.empty() && !marks->second.contains(place.name)))
      throw InvalidInput(arguments.case_folder, "case.json",
                         "holds no landmark to confirm there; --propose first");
    for (const auto& [name, at] : marks->second) {
      if (place.name.empty() || place.name == name)
        knee.landmark_states[place.bone][name] = LandmarkState::Confirmed;
    }
  }
  return arguments.propose || !places.placed.empty() || !places.confirmed.empty();
}

// Of the bones on which somebody placed or confirmed something: a slip is as confirmed as what is right.
void say_far_from_shape(const Context& context, const NamedPlaces& places, const cases::Case& knee,
                        const std::map<BoneKind, landmarks::Proposal>& proposals) {
  std::set<BoneKind> touched;
  for (const auto& named : {places.placed, places.confirmed})
    for (const NamedPlace& place : named) touched.insert(place.bone);
  for (const BoneKind kind : touched) {
    const auto made = proposals.find(kind);
    const landmarks::Proposal proposal =
        made != proposals.end() ? made->second
                                : landmarks::propose(knee.bones.at(kind).mesh, kind, {.side = knee.side});
    for (const landmarks::OffShape& one : landmarks::off_shape(knee.landmarks.at(kind), proposal))
      if (one.off_mm > landmarks::kFarFromShape_mm)
        context.say(files::format("  ! %s.%s lies %.1f mm from where the bone's shape puts it: look",
                                  std::string(bones::to_text(kind)).c_str(), one.name.c_str(), one.off_mm));
  }
}

}  // namespace

void add_landmarks_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<LandmarkArguments>();
  CLI::App* sub =
      add_subcommand(app, context, "landmarks",
                     "Propose a bone's landmarks from its shape, place or confirm them, or list them",
                     "arthronaut landmarks Knee.arthro --propose --set femur.notch_apex=-71.2,8.1,44.0");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  auto* propose =
      sub->add_flag("--propose", arguments->propose, "Propose from the shape what nobody has confirmed");
  sub->add_option("--set", arguments->set,
                  "In mm, LPS: placed by hand, and so confirmed. One each time it is given")
      ->option_text("BONE.NAME=X,Y,Z")
      ->allow_extra_args(false)  // one each: the case may follow
      ->check(read_by([](const std::string& text) { (void)placed_from(text); }));
  sub->add_option("--confirm", arguments->confirm,
                  "Looked at and right: landmarks, all those of a bone, or all")
      ->option_text("BONE[.NAME],... or all")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(read_by([](const std::string& text) {
        if (text != kAll) (void)place_from(text);
      }));
  sub->add_option("--roof", arguments->roof,
                  "How Blumensaat's line is proposed: flat (through the roof without its hill) or ends "
                  "(joins its ends)")
      ->check(CLI::IsMember({"flat", "ends"}))
      ->needs(propose)
      ->capture_default_str();
  sub->add_flag("--json", arguments->as_json, "Print the landmarks as JSON");
  sub->callback([arguments, &context] {
    const bool writes = arguments->propose || !arguments->set.empty() || !arguments->confirm.empty();
    cases::CaseLock lock;
    if (writes) lock = cases::lock_or_refuse(arguments->case_folder);
    if (!lock.notice().empty() && !arguments->as_json) context.say(lock.notice() + ".");
    auto knee = cases::load_case(arguments->case_folder);
    std::map<BoneKind, landmarks::Proposal> proposals;
    const NamedPlaces places = places_of(*arguments, knee);
    if (change(*arguments, places, knee, proposals)) cases::save_case(arguments->case_folder, knee);
    if (arguments->as_json) {
      files::write_atomically("-", to_json(knee, proposals).dump(2) + "\n");
    } else {
      list(context, knee);
      say_far_from_shape(context, places, knee, proposals);
    }
    std::vector<std::string> reasons;
    for (const auto& [kind, proposal] : proposals) {
      if (!proposal.is_usable())
        reasons.push_back("the " + std::string(bones::to_text(kind)) +
                          " gives no landmarks: " + proposal.reason);
      reasons.insert(reasons.end(), proposal.doubts.begin(), proposal.doubts.end());
    }
    if (!reasons.empty()) context.say_unreliable("The proposal of landmarks", reasons);
  });
}

}  // namespace arthronaut::command_line
