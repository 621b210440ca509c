#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "navigation/training/trainee.h"
#include "planning/files/json_document.h"

namespace arthronaut::training {

namespace {

using nlohmann::ordered_json;
using simulator::HandInput;
using simulator::Held;
using simulator::Press;

constexpr std::string_view kHandFormat = "arthronaut.hand";
constexpr int kHandVersion = 1;
constexpr std::int64_t kMostFrames = 3'600'000;
constexpr std::array<std::string_view, 3> kHeld{"probe", "guide", "board"};
constexpr std::array<std::string_view, 11> kPresses{"none",   "touch",        "control point", "register",
                                                    "draw",   "stop drawing", "marker anew",   "drilled",
                                                    "finish", "picture",      "drop picture"};

bool is_same(const HandInput& a, const HandInput& b) {
  return a.held == b.held && a.moves_scope == b.moves_scope && a.move == b.move && a.tilt == b.tilt &&
         a.turn_lens == b.turn_lens && a.drill == b.drill && a.press == b.press;
}

ordered_json json_of(std::int64_t frame, const HandInput& input) {
  ordered_json node;
  node["frame"] = frame;
  node["held"] = kHeld[static_cast<std::size_t>(input.held)];
  node["moves_scope"] = input.moves_scope;
  node["move"] = files::to_json(input.move);
  node["tilt"] = files::to_json(input.tilt);
  node["turn_lens"] = input.turn_lens;
  node["drill"] = input.drill;
  node["press"] = kPresses[static_cast<std::size_t>(input.press)];
  return node;
}

struct Pushed {
  std::int64_t frame = 0;
  HandInput input;
};

Pushed pushed_from(const files::JsonObject& node) {
  Pushed pushed;
  pushed.frame = node.integer("frame");
  if (pushed.frame < 0 || pushed.frame > kMostFrames) node.fail("frame", "must lie in 0 to 3600000");
  const std::string held = node.text("held");
  const auto* const hand = std::find(kHeld.begin(), kHeld.end(), held);
  if (hand == kHeld.end()) node.fail("held", "must be \"probe\", \"guide\" or \"board\"");
  pushed.input.held = static_cast<Held>(hand - kHeld.begin());
  pushed.input.moves_scope = node.boolean("moves_scope");
  pushed.input.move = node.vector3("move");
  pushed.input.tilt = node.vector3("tilt");
  pushed.input.turn_lens = node.number("turn_lens");
  pushed.input.drill = node.number("drill");
  const std::string press = node.text("press");
  const auto* const found = std::find(kPresses.begin(), kPresses.end(), press);
  if (found == kPresses.end()) node.fail("press", "\"" + press + "\" is nothing that a pedal asks for");
  pushed.input.press = static_cast<Press>(found - kPresses.begin());
  return pushed;
}

}  // namespace

simulator::Hand read_hand_file(const std::filesystem::path& file) {
  const files::JsonObject document = files::read_json(file, kHandFormat, kHandVersion);
  auto pushes = std::make_shared<std::vector<Pushed>>();
  for (const files::JsonObject& node : document.objects("pushes")) {
    pushes->push_back(pushed_from(node));
    const std::size_t count = pushes->size();
    if (count > 1 && pushes->back().frame <= (*pushes)[count - 2].frame)
      node.fail("frame", "must be later than the one before");
  }
  const std::int64_t frames = document.integer("frames");
  if (frames < 1 || frames > kMostFrames) document.fail("frames", "must lie in 1 to 3600000");
  struct Progress {
    std::int64_t frame = 0;
    std::size_t at = 0;
  };
  return [pushes, frames, progress = std::make_shared<Progress>()](
             const simulator::HandScene&, const simulator::HandState&) -> std::optional<HandInput> {
    if (progress->frame >= frames) return std::nullopt;
    while (progress->at < pushes->size() && (*pushes)[progress->at].frame <= progress->frame) ++progress->at;
    HandInput input = progress->at > 0 ? (*pushes)[progress->at - 1].input : HandInput{};
    // A pedal is pressed once, however long what is pushed beside it stays.
    if (progress->at > 0 && (*pushes)[progress->at - 1].frame != progress->frame) input.press = Press::None;
    ++progress->frame;
    return input;
  };
}

void write_hand_file(const std::filesystem::path& file, const std::vector<simulator::HandTruth>& frames) {
  auto pushes = ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    HandInput before = i > 0 ? frames[i - 1].input : HandInput{};
    before.press = Press::None;
    if (i == 0 || !is_same(before, frames[i].input))
      pushes.push_back(json_of(frames[i].frame, frames[i].input));
  }
  files::write_json(file, {{"format", kHandFormat},
                           {"version", kHandVersion},
                           {"frames", frames.size()},
                           {"pushes", std::move(pushes)}});
}

}  // namespace arthronaut::training
