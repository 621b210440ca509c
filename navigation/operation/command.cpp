#include "navigation/operation/command.h"

#include <array>
#include <nlohmann/json.hpp>

#include "navigation/registration/registration_file.h"
#include "planning/files/json_document.h"

namespace arthronaut::operation {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "arthronaut.command";
constexpr int kVersion = 1;

// In the order of the variant.
constexpr std::array<std::string_view, std::variant_size_v<Command>> kNames{"draw",
                                                                            "touch",
                                                                            "control point",
                                                                            "forget touches",
                                                                            "take back stroke",
                                                                            "exclude stroke",
                                                                            "clear strokes",
                                                                            "register strokes",
                                                                            "choose registration",
                                                                            "offer plan",
                                                                            "take plan over",
                                                                            "skip verification",
                                                                            "marker placed anew",
                                                                            "depth stop",
                                                                            "tunnel drilled",
                                                                            "give registration"};

void add(Json& json, const Draw& draw) { json["on"] = draw.on; }
void add(Json& json, const ExcludeStroke& exclude) {
  json["curve"] = exclude.curve;
  json["is_excluded"] = exclude.is_excluded;
}
void add(Json& json, const ChooseRegistration& choose) { json["entry"] = choose.entry; }
void add(Json& json, const ReadDepthStop& stop) { json["depth_mm"] = stop.depth_mm; }
void add(Json& json, const OfferPlan& offer) {
  if (!offer.plan) return;
  const tunnels::Tunnel& tunnel = offer.plan->tunnel;
  json["bone"] = bones::to_text(tunnel.bone);
  json["entry_mm"] = files::to_json(tunnel.entry_mm);
  json["direction"] = files::to_json(tunnel.direction);
  json["diameter_mm"] = tunnel.diameter_mm;
  json["length_mm"] = offer.plan->length_mm;
}
void add(Json& json, const GiveRegistration& give) {
  json["registration"] = registration::to_json(give.registration, &give.of);
  json["placement"] = give.of.placement;
  json["is_resumed"] = give.is_resumed;
}
// A command without a word beside its name.
template <typename Plain>
void add(Json&, const Plain&) {}

OfferPlan plan_from(const files::JsonObject& json) {
  OfferPlan offer;
  if (!json.has("bone")) return offer;
  PlannedTunnel plan;
  plan.tunnel.bone = bones::bone_kind_from_text(json.text("bone"));
  plan.tunnel.entry_mm = json.vector3("entry_mm");
  plan.tunnel.direction = json.vector3("direction");
  plan.tunnel.diameter_mm = json.positive_number("diameter_mm");
  plan.length_mm = json.number("length_mm");
  offer.plan = plan;
  return offer;
}

GiveRegistration registration_from(const files::JsonObject& json) {
  const auto record = registration::registration_record_from(json.object("registration"));
  if (!record.of) json.fail("registration", "does not say what it is of");
  GiveRegistration give{record.registration, *record.of, json.boolean("is_resumed")};
  give.of.placement = static_cast<int>(json.integer("placement"));
  return give;
}

// The command of that place in the variant, as it is without a word beside its name.
template <std::size_t Index = 0>
Command plain(std::size_t index) {
  if constexpr (Index < std::variant_size_v<Command>) {
    return index == Index ? Command(std::in_place_index<Index>) : plain<Index + 1>(index);
  } else {
    return TakeTouch{};
  }
}

}  // namespace

std::string_view name_of(const Command& command) { return kNames[command.index()]; }

std::string to_text(const Command& command) {
  Json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["command"] = name_of(command);
  std::visit([&](const auto& c) { add(json, c); }, command);
  return json.dump();
}

Command command_from_text(const std::string& text, const std::string& name) {
  const files::JsonObject json = files::parse_json(text, name, kFormat, kVersion);
  const std::string word = json.text("command");
  std::size_t index = 0;
  while (index < kNames.size() && kNames[index] != word) ++index;
  if (index == kNames.size()) json.fail("command", "is not known: " + word);
  Command command = plain(index);
  if (auto* draw = std::get_if<Draw>(&command)) draw->on = json.boolean("on");
  if (auto* exclude = std::get_if<ExcludeStroke>(&command))
    *exclude = {static_cast<int>(json.integer("curve")), json.boolean("is_excluded")};
  if (auto* choose = std::get_if<ChooseRegistration>(&command)) {
    if (json.integer("entry") < 0) json.fail("entry", "must not be negative");
    choose->entry = static_cast<std::size_t>(json.integer("entry"));
  }
  if (auto* stop = std::get_if<ReadDepthStop>(&command)) stop->depth_mm = json.number("depth_mm");
  if (std::holds_alternative<OfferPlan>(command)) command = plan_from(json);
  if (std::holds_alternative<GiveRegistration>(command)) command = registration_from(json);
  return command;
}

}  // namespace arthronaut::operation
