#include "app/pedals/foot_switch.h"

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <mutex>

#include "navigation/worker/worker.h"

namespace arthronaut::pedals {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostWaiting = 64;
constexpr std::chrono::milliseconds kLook{100};     // how often it is asked whether it is to end
constexpr std::chrono::milliseconds kSearch{1000};  // how often devices are looked for

// An open device; closed with it.
class Device {
 public:
  Device(int descriptor, std::string name, std::map<int, Pedal> codes)
      : descriptor_(descriptor), name_(std::move(name)), decoder_(std::move(codes)) {}
  Device(Device&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)),
        name_(std::move(other.name_)),
        decoder_(std::move(other.decoder_)) {}
  Device& operator=(Device&&) = delete;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  // False when it is gone.
  bool read_events(std::vector<PedalEvent>& events) {
    std::array<char, 64 * sizeof(input_event)> bytes{};
    for (;;) {
      const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
      if (count > 0) {
        decoder_.take(bytes.data(), static_cast<std::size_t>(count), events);
        continue;
      }
      if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return true;
      if (count < 0 && errno == EINTR) continue;
      decoder_.end(events);
      return false;
    }
  }

 private:
  int descriptor_;
  std::string name_;
  PedalDecoder decoder_;
};

std::string name_of_device(int descriptor) {
  std::array<char, 256> name{};
  if (ioctl(descriptor, EVIOCGNAME(name.size() - 1), name.data()) < 0) return "";
  return name.data();
}

bool names_a_pedal(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return name.find("pedal") != std::string::npos || name.find("foot") != std::string::npos;
}

}  // namespace

void PedalDecoder::take(const char* bytes, std::size_t count, std::vector<PedalEvent>& events) {
  rest_.insert(rest_.end(), bytes, bytes + count);
  std::size_t done = 0;
  for (; rest_.size() - done >= sizeof(input_event); done += sizeof(input_event)) {
    input_event event{};
    std::memcpy(&event, rest_.data() + done, sizeof event);
    if (event.type == EV_SYN) {
      if (event.code == SYN_DROPPED) {
        end(events);
        is_lost_ = true;
      } else {
        is_lost_ = false;
      }
      continue;
    }
    const auto found = event.type == EV_KEY && !is_lost_ ? codes_.find(event.code) : codes_.end();
    if (found == codes_.end() || (event.value != 0 && event.value != 1)) continue;  // repeats are no presses
    const auto held = std::find(down_.begin(), down_.end(), found->second);
    const bool is_down = event.value == 1;
    const std::chrono::microseconds time(std::int64_t{1'000'000} * event.input_event_sec +
                                         event.input_event_usec);
    const auto last_up = last_up_.find(found->second);
    // A clock that was set back makes no slip.
    const bool slips =
        is_down && last_up != last_up_.end() && time >= last_up->second && time < last_up->second + kSlip;
    if (!is_down) last_up_[found->second] = time;
    if (slips || is_down == (held != down_.end())) continue;
    if (is_down)
      down_.push_back(found->second);
    else
      down_.erase(held);
    events.push_back({found->second, is_down});
  }
  rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(done));
}

void PedalDecoder::end(std::vector<PedalEvent>& events) {
  for (const Pedal pedal : down_) events.push_back({pedal, false});
  down_.clear();
}

struct FootSwitch::Reader {
  struct Queue {
    std::mutex mutex;
    std::vector<PedalEvent> waiting;
  };
  using Worker = worker::Worker<int, Status>;

  Reader(const TheatreSettings& settings, const std::function<void()>& wake, const Grab& grabs)
      : worker(
            worker::Backlog::Lossless,
            [settings, queue = queue, wake, grabs](Worker::Inbox& inbox) {
              read_all(settings, *queue, wake, grabs, inbox);
            },
            wake) {}

  // Opens what is there and not open yet; what can't be opened is told.
  static std::string find(const TheatreSettings& settings, const Grab& grabs,
                          std::map<fs::path, Device>& devices) {
    std::vector<fs::path> wanted = settings.foot_switches;
    const bool looks_for_names = wanted.empty();
    std::error_code error;
    if (looks_for_names)
      for (const fs::directory_entry& entry : fs::directory_iterator("/dev/input", error))
        if (entry.path().filename().string().starts_with("event")) wanted.push_back(entry.path());
    std::string trouble;
    for (const fs::path& path : wanted) {
      if (devices.contains(path)) continue;
      const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
      if (descriptor < 0) {
        // Of devices that nobody named, most are none of ours, and nobody knows which.
        if (!looks_for_names)
          trouble = path.string() + ": " +
                    (errno == EACCES ? "permission denied; its user must be in the group \"input\""
                                     : std::strerror(errno));
        continue;
      }
      const std::string name = name_of_device(descriptor);
      if (looks_for_names && !names_a_pedal(name)) {
        close(descriptor);
        continue;
      }
      // A file that is no device cannot be taken, and need not be.
      if (grabs(descriptor) == EBUSY) {
        close(descriptor);
        trouble = path.string() + ": another program has taken it, and all that is pressed goes there";
        continue;
      }
      // The times of its events are of a clock that nobody sets.
      const int clock = CLOCK_MONOTONIC;
      (void)ioctl(descriptor, EVIOCSCLOCKID, &clock);
      devices.emplace(path, Device(descriptor, name.empty() ? path.string() : name, settings.codes));
    }
    return trouble;
  }

  static void read_all(const TheatreSettings& settings, Queue& queue, const std::function<void()>& wake,
                       const Grab& grabs, Worker::Inbox& inbox) {
    std::map<fs::path, Device> devices;
    Clock::time_point next_search = Clock::now();
    Status told{{}, "not looked for yet"};
    std::string trouble;
    while (!inbox.stops()) {
      if (Clock::now() >= next_search) {
        trouble = find(settings, grabs, devices);
        next_search = Clock::now() + kSearch;
      }
      Status status{{}, trouble};
      for (const auto& [path, device] : devices) status.devices.push_back(device.name());
      if (status.devices != told.devices || status.trouble != told.trouble) {
        told = status;
        inbox.publish(std::move(status));
      }
      if (devices.empty()) {
        inbox.sleep_until(std::min(next_search, Clock::now() + kSearch));
        continue;
      }
      std::vector<pollfd> waits;
      for (const auto& [path, device] : devices) waits.push_back({device.descriptor(), POLLIN, 0});
      if (poll(waits.data(), waits.size(), static_cast<int>(kLook.count())) <= 0) continue;
      std::vector<PedalEvent> events;
      for (auto device = devices.begin(); device != devices.end();)
        device = device->second.read_events(events) ? std::next(device) : devices.erase(device);
      if (events.empty()) continue;
      {
        const std::lock_guard lock(queue.mutex);
        for (const PedalEvent& event : events)
          if (queue.waiting.size() < kMostWaiting) queue.waiting.push_back(event);
      }
      if (wake) wake();
    }
  }

  std::shared_ptr<Queue> queue = std::make_shared<Queue>();
  Worker worker;
};

int FootSwitch::grab(int descriptor) { return ioctl(descriptor, EVIOCGRAB, 1) == 0 ? 0 : errno; }

FootSwitch::FootSwitch(const TheatreSettings& settings, std::function<void()> wake, Grab grabs)
    : reader_(std::make_unique<Reader>(settings, wake, grabs)) {}
FootSwitch::~FootSwitch() = default;

std::vector<PedalEvent> FootSwitch::take() {
  const std::lock_guard lock(reader_->queue->mutex);
  return std::exchange(reader_->queue->waiting, {});
}

FootSwitch::Status FootSwitch::status() const {
  const auto status = reader_->worker.latest();
  if (status == nullptr) return {};
  return *status;
}

}  // namespace arthronaut::pedals
