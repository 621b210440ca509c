// From a state of the operation to the sound device: the mode in the window's tick, without a window.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "app/navigate/navigate_view.h"
#include "planning/phantom/phantom_case.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::navigate {
namespace {

// What is played goes to a file, as to a loudspeaker: the default device of ALSA's settings.
class NavigateSound : public ::testing::Test {
 protected:
  NavigateSound() {
    std::ofstream(folder_ / "asound.conf")
        << "pcm.!default { type file slave.pcm { type null } format raw file \"" << played_.string()
        << "\" }\n";
    setenv("ALSA_CONFIG_PATH", (folder_ / "asound.conf").c_str(), 1);
  }
  ~NavigateSound() override { unsetenv("ALSA_CONFIG_PATH"); }

  [[nodiscard]] bool was_played(sounds::Sound sound) const {
    std::ifstream in(played_, std::ios::binary);
    const std::vector<char> played{std::istreambuf_iterator<char>(in), {}};
    const std::vector<std::int16_t> samples = sounds::samples_of(sound);
    const auto* const as_bytes = reinterpret_cast<const char*>(samples.data());
    return played.size() >= 2 * samples.size() &&
           std::equal(as_bytes, as_bytes + 2 * samples.size(), played.begin());
  }
  // Ticks as the window does, until it is so; a minute is more than any machine needs.
  template <typename Condition>
  [[nodiscard]] static bool becomes(NavigateView& view, const Condition& is_so) {
    for (int i = 0; i < 6000; ++i) {
      view.tick(0);
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path played_ = folder_ / "played.raw";
};

// A registration of another kind of pictures is void: the operation's next state has to be heard.
TEST_F(NavigateSound, WhatGuidedAndIsInDoubtIsHeard) {
  open_case::PlanModel model(phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test"));
  std::filesystem::create_directories(folder_ / "Knee.arthro");
  NavigateView view([] {}, [] {}, {}, [](Elsewhere) {});
  view.case_opened({&model, folder_ / "Knee.arthro"});
  view.lend(bones::BoneKind::Femur, test::plain_source(100'000, false, sources::SourceKind::Recording, 30));
  ASSERT_TRUE(becomes(view, [&] { return view.live()->operation->frame_count > 0; })) << view.notice();
  EXPECT_FALSE(was_played(sounds::Sound::Doubtful));
  operation::GiveRegistration give;
  give.registration.has_pose = give.registration.reliable = true;
  give.registration.reasons.clear();
  give.of = operation::provenance_of(*view.setup_in_use(), *view.live()->operation->source);
  give.of.source = sources::SourceKind::Simulation;
  view.ask(give);
  EXPECT_TRUE(becomes(view, [&] { return was_played(sounds::Sound::Doubtful); }));
  EXPECT_EQ(view.live()->operation->registration->in_force.standing, operation::Standing::Void);
}

}  // namespace
}  // namespace arthronaut::navigate
