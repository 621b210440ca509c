#include "app/sounds/player.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

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

// A device that does not take anything yet, as one that still plays: a pipe that nobody reads.
TEST(Player, OfSeveralThatWaitTheMostUrgentIsPlayed) {
  const test::TemporaryFolder folder;
  const std::filesystem::path pipe = folder / "played.pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::vector<char> played;
  {
    Player player("file:'" + pipe.string() + "',raw");
    for (const Sound sound : {Sound::Reached, Sound::Breakout, Sound::Lost, Sound::Refused})
      player.play(sound);
    const int reader = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(reader, 0);
    const auto read_what_is_there = [&] {
      std::vector<char> piece(1 << 16);
      for (ssize_t count = 0; (count = ::read(reader, piece.data(), piece.size())) > 0;)
        played.insert(played.end(), piece.begin(), piece.begin() + count);
    };
    std::jthread reading([&](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        read_what_is_there();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    player.finish();
    EXPECT_EQ(player.trouble(), "");
    reading.request_stop();
    reading.join();
    read_what_is_there();  // what was written while the thread slept for the last time
    ::close(reader);
  }
  const std::vector<std::int16_t> samples = samples_of(Sound::Breakout);
  ASSERT_GE(played.size(), 2 * samples.size());
  const auto* const as_bytes = reinterpret_cast<const char*>(samples.data());
  EXPECT_TRUE(std::equal(as_bytes, as_bytes + 2 * samples.size(), played.begin()));
  EXPECT_LT(played.size(), 2 * samples.size() + 2 * samples_of(Sound::Refused).size()) << "and no other one";
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
