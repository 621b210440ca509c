// What a list of a thousand cases costs: five sessions each, as the index has them and with a look at every
// folder; the first reading of all; a search.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "navigation/recording/session_facts.h"
#include "planning/library/case_query.h"
#include "planning/library/library.h"
#include "tests/planning/library/made_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::library {
namespace {

namespace fs = std::filesystem;
constexpr int kCases = 1000, kSessions = 5;

// Sessions with what the library reads of them but for the record, which is as long as an operation is.
class ThousandCases {
 public:
  ThousandCases() {
    for (int i = 0; i < kCases; ++i) {
      const fs::path folder = folder_ / "data" / "cases" / ("Knee" + std::to_string(i) + ".arthro");
      fs::create_directories(folder);
      test::make_case(folder, {.name = "Knee " + std::to_string(i), .side = i % 2 == 0 ? "left" : "right"});
      test::write_text(
          folder / "note.json",
          R"({"format": "arthronaut.note", "version": 1, "text": "a note of usual length, #study",
                           "changed_utc": "2026-01-31T12:00:00Z"})");
      for (int session = 1; session <= kSessions; ++session) {
        const fs::path of = folder / "sessions" / ("000" + std::to_string(session) + "-20260131-120000");
        fs::create_directories(of);
        test::write_text(of / "session.sqlite", "");
        test::write_text(of / "achieved.json",
                         R"({"format": "arthronaut.achieved", "version": 1, "bone": "femur",
          "planned": {"entry_mm": [0, 0, 0], "direction": [0, 0, 1], "diameter_mm": 9},
          "measured": {"entry_mm": [1, 0, 0], "direction": [0, 0, 1], "diameter_mm": 9},
          "timestamp_ns": 1, "pose_count": 9, "sigma_offset_mm": 1, "sigma_angle_deg": 1})");
      }
    }
    (void)open()->look();
  }
  [[nodiscard]] std::unique_ptr<Library> open() const {
    return std::make_unique<Library>(folder_ / "data", recording::read_session_facts);
  }
  void forget_index() const { fs::remove(folder_ / "data" / "library-3.sqlite"); }

 private:
  const test::TemporaryFolder folder_;
};

const ThousandCases& cases() {
  static const ThousandCases made;
  return made;
}

void list_of_the_index(benchmark::State& state) {
  for (auto _ : state) {
    if (cases().open()->known().size() != kCases) state.SkipWithError("cases are missing");
  }
}
BENCHMARK(list_of_the_index)
    ->Setup([](const benchmark::State&) { (void)cases(); })
    ->Unit(benchmark::kMillisecond);

void list_with_a_look_at_every_folder(benchmark::State& state) {
  for (auto _ : state) {
    if (cases().open()->look().size() != kCases) state.SkipWithError("cases are missing");
  }
}
BENCHMARK(list_with_a_look_at_every_folder)
    ->Setup([](const benchmark::State&) { (void)cases(); })
    ->Unit(benchmark::kMillisecond);

void first_reading_of_all(benchmark::State& state) {
  for (auto _ : state) {
    cases().forget_index();
    if (cases().open()->look().size() != kCases) state.SkipWithError("cases are missing");
  }
}
BENCHMARK(first_reading_of_all)->Unit(benchmark::kMillisecond);

void search_for_words(benchmark::State& state) {
  const auto records = cases().open()->look();
  for (auto _ : state)
    benchmark::DoNotOptimize(find_cases(records, {.words = "left #study 99", .order = CaseOrder::Name}));
}
BENCHMARK(search_for_words)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace arthronaut::library
