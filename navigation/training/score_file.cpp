#include "navigation/training/score_file.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "planning/files/atomic_file.h"
#include "planning/files/json_document.h"
#include "planning/files/private_folder.h"
#include "planning/library/known_folders.h"

namespace arthronaut::training {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
constexpr std::string_view kScoreFormat = "arthronaut.score", kTrainingFormat = "arthronaut.training";
constexpr int kScoreVersion = 1;

ordered_json json_of(const Score& score) {
  ordered_json node;
  node["exercise"] = score.exercise;
  node["level"] = to_text(score.level);
  node["when_utc"] = score.when_utc;
  node["trainee"] = score.trainee;
  node["knee"] = score.knee;
  node["seed"] = score.seed;
  node["session"] = score.session;
  if (!score.case_created_utc.empty()) node["case_created_utc"] = score.case_created_utc;
  node["is_done"] = score.is_done;
  node["points"] = score.points;
  node["rule"] = score.rule;
  node["parts"] = ordered_json::array();
  for (const ScorePart& part : score.parts) {
    ordered_json one;
    one["measure"] = to_text(part.measure);
    one["value"] = part.value ? ordered_json(*part.value) : ordered_json(nullptr);
    one["unit"] = unit_of(part.measure);
    one["good"] = part.good;
    one["limit"] = part.limit;
    one["points"] = part.points;
    one["most_points"] = part.most_points;
    one["caps_at"] = part.caps_at ? ordered_json(*part.caps_at) : ordered_json(nullptr);
    one["reason"] = part.reason;
    one["advice"] = part.advice;
    node["parts"].push_back(std::move(one));
  }
  node["better"] = score.better;
  return node;
}

Measure measure_of(const files::JsonObject& node) {
  const std::string text = node.text("measure");
  for (int i = 0; i <= static_cast<int>(Measure::OffBone); ++i)
    if (to_text(static_cast<Measure>(i)) == text) return static_cast<Measure>(i);
  node.fail("measure", "\"" + text + "\" is nothing that a score measures");
}

Level level_of(const files::JsonObject& node) {
  const std::string text = node.text("level");
  for (const Level level : {Level::Easy, Level::Medium, Level::Hard})
    if (to_text(level) == text) return level;
  node.fail("level", "\"" + text + "\" is no level");
}

Score score_from(const files::JsonObject& node) {
  Score score;
  score.exercise = node.text("exercise");
  score.level = level_of(node);
  score.when_utc = node.text("when_utc");
  score.trainee = node.text("trainee");
  score.knee = node.text("knee");
  score.session = node.text("session");
  if (node.has("case_created_utc")) score.case_created_utc = node.text("case_created_utc");
  const std::int64_t seed = node.integer("seed");
  if (seed < 0) node.fail("seed", "must not be below 0");
  score.seed = static_cast<std::uint64_t>(seed);
  score.is_done = node.boolean("is_done");
  score.points = node.number("points");
  if (score.points < 0 || score.points > 100) node.fail("points", "must lie in 0 to 100");
  if (node.has("rule")) score.rule = static_cast<int>(node.integer("rule"));
  for (const files::JsonObject& one : node.objects("parts")) {
    ScorePart part;
    part.measure = measure_of(one);
    if (one.has("value")) part.value = one.number("value");
    part.good = one.number("good");
    part.limit = one.number("limit");
    part.points = one.number("points");
    part.most_points = one.number("most_points");
    if (one.has("caps_at")) part.caps_at = one.number("caps_at");
    part.reason = one.text("reason");
    part.advice = one.text("advice");
    score.parts.push_back(std::move(part));
  }
  score.better = node.texts("better");
  return score;
}

double time_of(const Score& score) {
  for (const ScorePart& part : score.parts)
    if (part.measure == Measure::Time && part.value) return *part.value;
  return 1e9;
}

}  // namespace

void write_score_file(const fs::path& file, const Score& score) {
  ordered_json document;
  document["format"] = kScoreFormat;
  document["version"] = kScoreVersion;
  document.update(json_of(score));
  files::write_json(file, document);
}

std::vector<Score> read_training_file(const fs::path& file) {
  std::vector<Score> scores;
  if (!fs::exists(file)) return scores;
  for (const files::JsonObject& node :
       files::read_json(file, kTrainingFormat, kScoreVersion).objects("scores"))
    scores.push_back(score_from(node));
  return scores;
}

void add_to_training_file(const fs::path& file, const Score& score) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  files::create_private_folder(folder);
  const library::LibraryTurn turn(folder);  // from reading to writing nobody else's
  std::vector<Score> scores = read_training_file(file);
  scores.push_back(score);
  auto nodes = ordered_json::array();
  for (const Score& one : scores) nodes.push_back(json_of(one));
  files::write_json(file,
                    {{"format", kTrainingFormat}, {"version", kScoreVersion}, {"scores", std::move(nodes)}});
}

fs::path training_file() {
  const char* const data = std::getenv("XDG_DATA_HOME");
  const char* const home = std::getenv("HOME");
  const fs::path base = data != nullptr && *data != '\0'
                            ? fs::path(data)
                            : fs::path(home != nullptr ? home : ".") / ".local/share";
  return base / "arthronaut" / "training.json";
}

const Score* best_of(const std::vector<Score>& scores, std::string_view exercise, Level level) {
  const Score* best = nullptr;
  for (const Score& score : scores) {
    if (score.exercise != exercise || score.level != level || !score.is_done || score.trainee != kByHand)
      continue;
    const bool is_earlier = is_by_earlier_rule(score);
    const bool same_rule = best == nullptr || is_by_earlier_rule(*best) == is_earlier;
    const bool is_better =
        best == nullptr || (!same_rule ? !is_earlier
                                       : score.points > best->points || (score.points == best->points &&
                                                                         time_of(score) < time_of(*best)));
    if (is_better) best = &score;
  }
  return best;
}

}  // namespace arthronaut::training
