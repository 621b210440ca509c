// A foot switch by its bytes: as the kernel gives them, through a pipe in the place of a device.
#include "app/pedals/foot_switch.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "tests/temporary_folder.h"

namespace arthronaut::pedals {
namespace {

std::string bytes_of(int type, int code, int value, std::chrono::milliseconds at = {}) {
  input_event event{};
  event.input_event_sec = at.count() / 1000;
  event.input_event_usec = at.count() % 1000 * 1000;
  event.type = static_cast<__u16>(type);
  event.code = static_cast<__u16>(code);
  event.value = value;
  std::string bytes(sizeof event, '\0');
  std::memcpy(bytes.data(), &event, sizeof event);
  return bytes;
}
std::string report() { return bytes_of(EV_SYN, SYN_REPORT, 0); }
std::string press(int code, std::chrono::milliseconds at = {}) {
  return bytes_of(EV_KEY, code, 1, at) + report();
}
std::string release(int code, std::chrono::milliseconds at = {}) {
  return bytes_of(EV_KEY, code, 0, at) + report();
}

std::vector<PedalEvent> decoded(PedalDecoder& decoder, const std::string& bytes) {
  std::vector<PedalEvent> events;
  decoder.take(bytes.data(), bytes.size(), events);
  return events;
}

const std::vector<PedalEvent> kOnePress{{Pedal::DoIt, true}, {Pedal::DoIt, false}};

// Presses and releases of the pedals that are known; repeats, other keys and other devices' events are none.
TEST(PedalDecoder, TellsPressAndRelease) {
  PedalDecoder decoder(usual_settings().codes);
  const std::string noise = bytes_of(EV_MSC, MSC_SCAN, 7) + bytes_of(EV_REL, REL_X, 1) + press(KEY_ESC);
  EXPECT_EQ(decoded(decoder, noise + press(KEY_B) + bytes_of(EV_KEY, KEY_B, 2) + release(KEY_B)), kOnePress);
  EXPECT_TRUE(decoded(decoder, release(KEY_B)).empty()) << "it was up already";
}

// However the bytes are cut, the same events come.
TEST(PedalDecoder, TakesBytesAsTheyCome) {
  const std::string bytes = press(KEY_B) + release(KEY_B);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    PedalDecoder decoder(usual_settings().codes);
    std::vector<PedalEvent> events = decoded(decoder, bytes.substr(0, cut));
    for (const PedalEvent& event : decoded(decoder, bytes.substr(cut))) events.push_back(event);
    EXPECT_EQ(events, kOnePress) << cut;
  }
}

// A pedal that is down when events are lost, or the plug is pulled, is let go: nothing stays held for ever.
TEST(PedalDecoder, LetsGoOfWhatItLosesSightOf) {
  PedalDecoder decoder(usual_settings().codes);
  EXPECT_EQ(decoded(decoder, press(KEY_B) + bytes_of(EV_SYN, SYN_DROPPED, 0) + bytes_of(EV_KEY, KEY_A, 1)),
            kOnePress)
      << "until the next report nothing counts";
  EXPECT_EQ(decoded(decoder, report() + press(KEY_A)).size(), 1U);
  std::vector<PedalEvent> events;
  decoder.end(events);
  EXPECT_EQ(events, (std::vector<PedalEvent>{{Pedal::Back, false}}));
}

// A foot that slips off and on again has pressed once, however often it trembles; another pedal, a press
// after a pause and one whose clock was set back count.
TEST(PedalDecoder, ASlipIsNoSecondPress) {
  using std::chrono::milliseconds;
  PedalDecoder decoder(usual_settings().codes);
  std::string trembling;
  for (int i = 0; i < 5; ++i)
    trembling += press(KEY_B, milliseconds(5000 + 300 * i)) + release(KEY_B, milliseconds(5100 + 300 * i));
  EXPECT_EQ(decoded(decoder, trembling), kOnePress);
  EXPECT_EQ(decoded(decoder, press(KEY_A, milliseconds(6310)) + release(KEY_A, milliseconds(6320))).size(),
            2U);
  const milliseconds after =
      milliseconds(6300) + std::chrono::duration_cast<milliseconds>(PedalDecoder::kSlip);
  EXPECT_EQ(decoded(decoder, press(KEY_B, after) + release(KEY_B, after + milliseconds(80))), kOnePress);
  EXPECT_EQ(decoded(decoder, press(KEY_B, milliseconds(10)) + release(KEY_B, milliseconds(90))), kOnePress);
}

class Pipe : public ::testing::Test {
 protected:
  Pipe() { settings_.foot_switches = {path_}; }
  void make() const { ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0); }
  [[nodiscard]] static std::vector<PedalEvent> wait_for(FootSwitch& foot, std::size_t count) {
    std::vector<PedalEvent> events;
    for (int i = 0; i < 500 && events.size() < count; ++i) {
      for (const PedalEvent& event : foot.take()) events.push_back(event);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return events;
  }
  template <typename IsSo>
  static bool becomes(const IsSo& is_so) {
    for (int i = 0; i < 500 && !is_so(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return is_so();
  }
  // Plugged in: the writing end is there until it is closed.
  [[nodiscard]] int plug_in() const {
    int descriptor = -1;
    (void)becomes([&] {  // which asks once more in the end
      if (descriptor < 0) descriptor = open(path_.c_str(), O_WRONLY | O_NONBLOCK);
      return descriptor >= 0;
    });
    return descriptor;
  }
  static void send(int descriptor, const std::string& bytes) {
    ASSERT_EQ(write(descriptor, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "event7";
  TheatreSettings settings_ = usual_settings();
};

// Plugged in after the program began, pulled and plugged in again: it works whenever it is there, and a pedal
// that was down when the plug was pulled is up.
TEST_F(Pipe, IsReadWheneverItIsThere) {
  FootSwitch foot(settings_, [] {});
  EXPECT_TRUE(becomes([&] { return !foot.status().trouble.empty(); }));
  EXPECT_TRUE(foot.status().devices.empty());
  make();
  int device = plug_in();
  ASSERT_GE(device, 0);
  send(device, press(KEY_B) + release(KEY_B));
  EXPECT_EQ(wait_for(foot, 2), kOnePress);
  EXPECT_EQ(foot.status().devices, std::vector<std::string>{path_.string()});
  EXPECT_EQ(foot.status().trouble, "");
  send(device, press(KEY_B, std::chrono::seconds(2)));
  close(device);
  EXPECT_EQ(wait_for(foot, 2), kOnePress);
  device = plug_in();
  ASSERT_GE(device, 0);
  send(device, press(KEY_B) + release(KEY_B));
  EXPECT_EQ(wait_for(foot, 2), kOnePress);
  close(device);
}

// Who may not read the device is told which one, and what to do.
TEST_F(Pipe, SaysThatPermissionIsDenied) {
  if (geteuid() == 0) {
    // The superuser may read everything: a link in a circle is refused to anybody.
    std::filesystem::create_symlink(path_, path_);
    FootSwitch foot(settings_, [] {});
    EXPECT_TRUE(becomes([&] { return foot.status().trouble.starts_with(path_.string() + ": "); }));
    return;
  }
  make();
  ASSERT_EQ(chmod(path_.c_str(), 0), 0);
  FootSwitch foot(settings_, [] {});
  EXPECT_TRUE(becomes([&] { return foot.status().trouble.find("permission denied") != std::string::npos; }));
  EXPECT_EQ(foot.status().trouble.find(path_.string()), 0U);
}

// Another program that has taken it gets all its events: it is not shown as one that works, and works as soon
// as the other program has ended.
TEST_F(Pipe, SaysThatAnotherProgramHasTakenIt) {
  std::atomic<bool> is_taken = true;
  make();
  const int keeps_open = open(path_.c_str(), O_RDWR | O_NONBLOCK);
  FootSwitch foot(
      settings_, [] {}, [&](int) { return is_taken ? EBUSY : 0; });
  EXPECT_TRUE(becomes([&] { return foot.status().trouble.find("another program") != std::string::npos; }));
  EXPECT_EQ(foot.status().trouble.find(path_.string()), 0U);
  EXPECT_TRUE(foot.status().devices.empty());
  is_taken = false;
  EXPECT_TRUE(becomes([&] { return foot.status().devices.size() == 1; }));
  EXPECT_EQ(foot.status().trouble, "");
  close(keeps_open);
}

// It ends at once, with a device and without one.
TEST_F(Pipe, EndsAtOnce) {
  const auto started = std::chrono::steady_clock::now();
  {
    FootSwitch foot(settings_, [] {});
  }
  make();
  {
    FootSwitch foot(settings_, [] {});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::seconds(30));
}

}  // namespace
}  // namespace arthronaut::pedals
