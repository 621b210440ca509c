// What giving the screen out costs: a picture of 1920 x 1080 as it is encoded, and as a screenshot.
#include <benchmark/benchmark.h>

#include <array>
#include <random>

#include "app/screen_copy/screen_encoder.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

// Half of it moves, as a video does, with its noise; half stands still, as panels do.
std::array<widgets::ScreenPicture, 8> pictures() {
  constexpr int kWidth = 1920, kHeight = 1080;
  std::mt19937 random(2);
  std::array<widgets::ScreenPicture, 8> made;
  for (std::size_t i = 0; i < made.size(); ++i) {
    made[i].width = kWidth;
    made[i].height = kHeight;
    made[i].bgra.resize(4 * kWidth * kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        std::uint8_t* const at = made[i].bgra.data() + 4 * (y * kWidth + x);
        const int moved = x < kWidth / 2 ? x + 6 * static_cast<int>(i) : x;
        const int noise = x < kWidth / 2 ? static_cast<int>(random() % 5) : 0;
        for (int c = 0; c < 3; ++c)
          at[c] = static_cast<std::uint8_t>((moved / 8 + y / 8 + 40 * c) % 200 + noise);
      }
  }
  return made;
}

void encode(benchmark::State& state) {
  const test::TemporaryFolder folder;
  auto shown = pictures();
  screen_copy::ScreenEncoder encoder(folder / "screen.mkv", 1920, 1080);
  double time_s = 0;
  std::size_t next = 0;
  for (auto _ : state) {
    widgets::ScreenPicture& picture = shown[next++ % shown.size()];
    picture.time_s = time_s += 1.0 / 15;
    encoder.encode(picture);
  }
}
BENCHMARK(encode)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace arthronaut
