#include "app/sounds/player.h"

#include <alsa/asoundlib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "navigation/worker/worker.h"
#include "planning/log/log.h"

namespace arthronaut::sounds {

namespace {

constexpr unsigned kLatency_us = 100'000;
constexpr std::size_t kPiece = kSampleRate / 50;  // so soon the end of the program is heard of

// ALSA writes what it finds to standard error; it is told on the screen instead.
void say_nothing(const char*, int, const char*, int, const char*, ...) {}

std::string in_words(int error) {
  switch (-error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "no loudspeaker is connected";
    case EBUSY:
      return "another program holds the loudspeaker";
    case EACCES:
    case EPERM:
      return "this user may not use the loudspeaker";
    default:
      return "the loudspeaker does not play";
  }
}

class Device {
 public:
  explicit Device(const std::string& name) {
    const int opened = snd_pcm_open(&pcm_, name.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
    if (opened < 0) {
      fail(opened);
      return;
    }
    snd_pcm_nonblock(pcm_, 0);
    const int set = snd_pcm_set_params(pcm_, SND_PCM_FORMAT_S16, SND_PCM_ACCESS_RW_INTERLEAVED, 1,
                                       kSampleRate, 1, kLatency_us);
    if (set < 0) fail(set);
  }
  ~Device() {
    if (pcm_ != nullptr) snd_pcm_close(pcm_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] const std::string& system_says() const { return system_says_; }
  template <typename Stops>
  void play(const std::vector<std::int16_t>& samples, const Stops& stops) {
    for (std::size_t at = 0; at < samples.size() && trouble_.empty();) {
      if (stops()) return void(snd_pcm_drop(pcm_));
      const std::size_t count = std::min(kPiece, samples.size() - at);
      snd_pcm_sframes_t written = snd_pcm_writei(pcm_, samples.data() + at, count);
      if (written < 0) written = snd_pcm_recover(pcm_, static_cast<int>(written), 1);
      if (written < 0) return fail(static_cast<int>(written));
      at += static_cast<std::size_t>(written);
    }
    if (trouble_.empty()) snd_pcm_drain(pcm_);
  }

 private:
  void fail(int error) {
    trouble_ = in_words(error);
    system_says_ = snd_strerror(error);
  }

  snd_pcm_t* pcm_ = nullptr;
  std::string trouble_, system_says_;
};

}  // namespace

struct Player::Thread {
  explicit Thread(const std::string& device)
      : worker(worker::Backlog::NewestWins, [this, device](auto& inbox) {
          snd_lib_error_set_handler(say_nothing);
          std::string told;
          const auto tell = [&](const Device& of) {
            if (of.trouble() != told && !of.trouble().empty())
              log::warning("sound: " + of.trouble() + " (" + of.system_says() + ")");
            told = of.trouble();
            inbox.publish(told);
          };
          tell(Device(device));
          while (inbox.next()) {
            const std::optional<Sound> sound = take();
            if (!sound || is_muted) continue;
            Device opened(device);
            opened.play(samples_of(*sound), [&] { return inbox.stops() || is_muted; });
            tell(opened);
          }
          snd_lib_error_set_handler(nullptr);
          snd_config_update_free_global();
        }) {}
  void ask(Sound sound) {
    {
      const std::scoped_lock lock(mutex);
      if (!waiting || urgency_of(sound) >= urgency_of(*waiting)) waiting = sound;
    }
    worker.post({});
  }
  std::optional<Sound> take() {
    const std::scoped_lock lock(mutex);
    return std::exchange(waiting, std::nullopt);
  }
  struct Call {};

  std::atomic<bool> is_muted = false;
  std::mutex mutex;
  std::optional<Sound> waiting;
  worker::Worker<Call, std::string> worker;  // last: its thread uses what is above
};

Player::Player(const std::string& device) : thread_(std::make_unique<Thread>(device)) {}
Player::~Player() = default;

void Player::play(Sound sound) {
  if (!thread_->is_muted) thread_->ask(sound);
}
void Player::mute(bool on) { thread_->is_muted = on; }
bool Player::is_muted() const { return thread_->is_muted; }

std::string Player::trouble() const {
  if (const std::string failure = thread_->worker.failure(); !failure.empty()) return failure;
  const auto known = thread_->worker.latest();
  return known != nullptr ? *known : std::string();
}

void Player::finish() const { thread_->worker.finish(); }

}  // namespace arthronaut::sounds
