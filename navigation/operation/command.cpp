#include "navigation/operation/command.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <tuple>

#include "navigation/registration/registration_file.h"
#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "planning/tunnels/tunnel_json.h"

namespace arthronaut::operation {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCommandFormat = "arthronaut.command";
constexpr int kCommandVersion = 1;

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
                                                                            "give registration",
                                                                            "confirm time-out",
                                                                            "check guide",
                                                                            "trust guide",
                                                                            "resume operation",
                                                                            "take back drilled",
                                                                            "marker out"};

void add(Json& json, const Draw& draw) { json["on"] = draw.on; }
void add(Json& json, const ExcludeStroke& exclude) {
  json["curve"] = exclude.curve;
  json["is_excluded"] = exclude.is_excluded;
}
void add(Json& json, const ChooseRegistration& choose) { json["entry"] = choose.entry; }
void add(Json& json, const ReadDepthStop& stop) { json["depth_mm"] = stop.depth_mm; }
void add(Json& json, const std::optional<PlannedTunnel>& plan) {
  if (!plan) return;
  tunnels::put_key(plan->tunnel.key(), json);
  json.update(tunnels::to_json(plan->tunnel));
  json["length_mm"] = plan->length_mm;
}
void add(Json& json, const OfferPlan& offer) {
  add(json, offer.plan);
  if (offer.moves_target) json["moves_target"] = true;
}
void add(Json& json, const TakePlanOver& take) {
  if (take.asks_time_out) json["asks_time_out"] = true;
}
void add(Json& json, const registration::RegistrationSummary& registration,
         const registration::Provenance& of) {
  json["registration"] = registration::to_json(registration, &of);
  json["placement"] = of.placement;
}
void add(Json& json, const GiveRegistration& give) {
  add(json, give.registration, give.of);
  json["is_resumed"] = give.is_resumed;
}
void add(Json& json, const ConfirmTimeOut& time_out) {
  json["patient_was_shown"] = time_out.patient_was_shown;
  if (!time_out.beside.empty()) json["beside"] = time_out.beside;
}
// Where pictures came, nothing: such commands stay as they were.
void add(Json& json, const TunnelDrilled& drilled) {
  if (drilled.without_picture_s > 0) json["without_picture_s"] = drilled.without_picture_s;
}
void add(Json& json, const MarkerOut& out) {
  if (out.without_picture_s > 0) json["without_picture_s"] = out.without_picture_s;
}
void add(Json& json, const ResumeOperation& resume) {
  json["session"] = resume.session;
  json["of"] = registration::to_json(resume.of);
  if (resume.plan) add(json["plan"], resume.plan);
  if (resume.moves_target) json["moves_target"] = true;
  if (resume.depth_stop_mm) json["depth_stop_mm"] = *resume.depth_stop_mm;
  if (resume.registration) add(json["in_force"], *resume.registration, resume.registration_of);
  json["stroke_count"] = resume.stroke_count;
  // Curve, x, y, z of every point: a flat list is shorter by half.
  Json::array_t drawn, touches;
  for (const strokes::CurvePoint& point : resume.drawn) {
    drawn.emplace_back(point.curve);
    for (const double x : point.position_mm) drawn.emplace_back(x);
  }
  for (const Eigen::Vector3d& touch : resume.touches_mm)
    for (const double x : touch) touches.emplace_back(x);
  json["drawn"] = std::move(drawn);
  json["touches_mm"] = std::move(touches);
  if (resume.control_point_mm) json["control_point_mm"] = files::to_json(*resume.control_point_mm);
}
// A command without a word beside its name.
template <typename Plain>
void add(Json&, const Plain&) {}

std::optional<PlannedTunnel> plan_from(const files::JsonObject& json) {
  if (!json.has("bone")) return std::nullopt;
  PlannedTunnel plan;
  plan.tunnel = tunnels::read_tunnel(json, tunnels::read_key(json));
  plan.length_mm = json.number("length_mm");
  return plan;
}

bool moves_target_from(const files::JsonObject& json) {
  return json.has("moves_target") && json.boolean("moves_target");
}

GiveRegistration registration_from(const files::JsonObject& json) {
  const auto record = registration::registration_record_from(json.object("registration"));
  if (!record.of) json.fail("registration", "does not say what it is of");
  GiveRegistration give{record.registration, *record.of, json.boolean("is_resumed")};
  give.of.placement = json.int32("placement");
  return give;
}

// A list of numbers, so many for each thing.
std::vector<double> numbers_by(std::size_t size, const files::JsonObject& json, std::string_view key) {
  std::vector<double> numbers = json.numbers(key);
  if (numbers.size() % size != 0) json.fail(key, "is cut off");
  return numbers;
}

ResumeOperation resume_from(const files::JsonObject& json) {
  ResumeOperation resume;
  resume.session = json.text("session");
  const auto given = [](const files::JsonObject& from) {
    const auto record = registration::registration_record_from(from.object("registration"));
    if (!record.of) from.fail("registration", "does not say what it is of");
    auto of = *record.of;
    of.placement = from.int32("placement");
    return std::pair(record.registration, of);
  };
  resume.of = registration::provenance_from(json.object("of"));
  if (json.has("plan")) resume.plan = plan_from(json.object("plan"));
  resume.moves_target = moves_target_from(json);
  if (json.has("depth_stop_mm")) resume.depth_stop_mm = json.number("depth_stop_mm");
  if (json.has("in_force"))
    std::tie(resume.registration, resume.registration_of) = given(json.object("in_force"));
  resume.stroke_count = json.int32("stroke_count");
  const std::vector<double> drawn = numbers_by(4, json, "drawn");
  for (std::size_t i = 0; i < drawn.size(); i += 4) {
    strokes::CurvePoint& point = resume.drawn.emplace_back();
    point.curve = static_cast<int>(std::clamp(drawn[i], 0.0, 1e9));
    point.position_mm = {drawn[i + 1], drawn[i + 2], drawn[i + 3]};
  }
  const std::vector<double> touches = numbers_by(3, json, "touches_mm");
  for (std::size_t i = 0; i < touches.size(); i += 3)
    resume.touches_mm.emplace_back(touches[i], touches[i + 1], touches[i + 2]);
  if (json.has("control_point_mm")) resume.control_point_mm = json.vector3("control_point_mm");
  return resume;
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

bool PlannedTunnel::operator==(const PlannedTunnel& other) const {
  return tunnel.key() == other.tunnel.key() && tunnel.entry_mm == other.tunnel.entry_mm &&
         tunnel.direction == other.tunnel.direction && tunnel.diameter_mm == other.tunnel.diameter_mm &&
         length_mm == other.length_mm;
}

std::string_view name_of(const Command& command) { return kNames[command.index()]; }

std::string to_text(const Command& command) {
  Json json;
  json["format"] = kCommandFormat;
  json["version"] = kCommandVersion;
  json["command"] = name_of(command);
  std::visit([&](const auto& c) { add(json, c); }, command);
  return json.dump();
}

namespace {

Command read_command(const std::string& text, const std::string& name) {
  const files::JsonObject json = files::parse_json(text, name, kCommandFormat, kCommandVersion);
  const std::string word = json.text("command");
  std::size_t index = 0;
  while (index < kNames.size() && kNames[index] != word) ++index;
  if (index == kNames.size()) json.fail("command", "is not known: " + word);
  Command command = plain(index);
  if (auto* draw = std::get_if<Draw>(&command)) draw->on = json.boolean("on");
  if (auto* exclude = std::get_if<ExcludeStroke>(&command))
    *exclude = {json.int32("curve"), json.boolean("is_excluded")};
  if (auto* choose = std::get_if<ChooseRegistration>(&command)) {
    if (json.integer("entry") < 0) json.fail("entry", "must not be negative");
    choose->entry = static_cast<std::size_t>(json.integer("entry"));
  }
  if (auto* stop = std::get_if<ReadDepthStop>(&command)) stop->depth_mm = json.number("depth_mm");
  if (auto* drilled = std::get_if<TunnelDrilled>(&command); drilled && json.has("without_picture_s"))
    drilled->without_picture_s = json.number("without_picture_s");
  if (auto* out = std::get_if<MarkerOut>(&command); out && json.has("without_picture_s"))
    out->without_picture_s = json.number("without_picture_s");
  if (std::holds_alternative<OfferPlan>(command))
    command = OfferPlan{plan_from(json), moves_target_from(json)};
  if (auto* take = std::get_if<TakePlanOver>(&command))
    take->asks_time_out = json.has("asks_time_out") && json.boolean("asks_time_out");
  if (auto* time_out = std::get_if<ConfirmTimeOut>(&command)) {
    time_out->patient_was_shown = json.boolean("patient_was_shown");
    if (json.has("beside")) time_out->beside = json.text("beside");
  }
  if (std::holds_alternative<ResumeOperation>(command)) command = resume_from(json);
  if (std::holds_alternative<GiveRegistration>(command)) command = registration_from(json);
  return command;
}

}  // namespace

Command command_from_text(const std::string& text, const std::string& name) {
  try {
    return read_command(text, name);
  } catch (const InvalidInput& error) {  // a word that is no bone does not know where it stands
    if (std::string_view(error.what()).find(name) != std::string_view::npos) throw;
    throw InvalidInput(name + ": " + error.what());
  }
}

}  // namespace arthronaut::operation
