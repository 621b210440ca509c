#include "app/sounds/player.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/temporary_folder.h"

namespace arthronaut::sounds {
namespace {

std::vector<char> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// ALSA's own file device takes what a loudspeaker would get: the samples, to the last one.
TEST(Player, PlaysTheSamples) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "played.raw";
  {
    Player player("file:'" + file.string() + "',raw");
    player.finish();
    ASSERT_EQ(player.trouble(), "");
    player.play(Sound::Reached);
    player.finish();
    EXPECT_EQ(player.trouble(), "");
  }
  const std::vector<std::int16_t> samples = samples_of(Sound::Reached);
  const std::vector<char> played = bytes_of(file);
  ASSERT_GE(played.size(), 2 * samples.size());
  const auto* const as_bytes = reinterpret_cast<const char*>(samples.data());
  EXPECT_TRUE(std::equal(as_bytes, as_bytes + 2 * samples.size(), played.begin()));
}

// No device: said as who stands in the theatre would say it, without the system's words, and nothing else
// comes of it.
TEST(Player, SaysThatThereIsNoDevice) {
  Player player("hw:CARD=nosuchcard");
  player.finish();
  EXPECT_EQ(player.trouble(), "no loudspeaker is connected");
  player.play(Sound::Lost);
  player.finish();
  EXPECT_EQ(player.trouble(), "no loudspeaker is connected");
}

TEST(Player, MutedPlaysNothing) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "played.raw";
  {
    Player player("file:'" + file.string() + "',raw");
    player.finish();
    player.mute(true);
    EXPECT_TRUE(player.is_muted());
    player.play(Sound::Lost);
    player.finish();
  }
  EXPECT_TRUE(bytes_of(file).empty());
}

}  // namespace
}  // namespace arthronaut::sounds
