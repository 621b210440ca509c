#include "navigation/openigtlink/igtl_tracker.h"

#include <igtl_util.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "navigation/openigtlink/igtl_reader.h"
#include "navigation/openigtlink/tracker_connection.h"
#include "navigation/sources/capture_time.h"
#include "navigation/sources/frame_source.h"
#include "navigation/sources/source_line.h"
#include "navigation/worker/worker.h"
#include "planning/geometry/error.h"
#include "planning/log/log.h"

namespace arthronaut::openigtlink {

namespace {

using BookWorker = worker::Worker<std::monostate, tracker::PoseBook>;

constexpr std::string_view kScheme = "igtl://";
constexpr int kReceive_ms = 50;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
// A message that has begun and does not go on; one that goes on and on, since its length was wrong; a
// connection on which nothing comes; poses that are all late.
constexpr std::int64_t kHalfMessage_ns = 2 * kSecond_ns, kEndlessMessage_ns = 5 * kSecond_ns,
                       kSilence_ns = 5 * kSecond_ns, kBehind_ns = 2 * kSecond_ns;
constexpr std::int64_t kNoPose_ns = kSecond_ns;
constexpr std::chrono::milliseconds kPause{500};

// STT_TDATA: a header whose body is the interval in ms and the name of a coordinate system, none.
std::vector<std::uint8_t> ask_for_tracking_data() {
  constexpr std::size_t kBody = 36;
  std::vector<std::uint8_t> message(IgtlReader::kHeaderSize + kBody, 0);
  message[1] = 1;
  const std::string_view type = "STT_TDATA";
  std::copy(type.begin(), type.end(), message.begin() + 2);
  message[49] = kBody;
  // Of 36 bytes, 20 ms in the fourth.
  message[IgtlReader::kHeaderSize + 3] = 20;
  std::uint64_t checksum = crc64(message.data() + IgtlReader::kHeaderSize, kBody, 0);
  for (std::size_t at = IgtlReader::kHeaderSize; at-- > IgtlReader::kHeaderSize - 8; checksum >>= 8)
    message[at] = static_cast<std::uint8_t>(checksum & 0xFF);
  return message;
}

// One connection's messages, put into the book.
class Listener : public MessageListener {
 public:
  explicit Listener(tracker::PoseBook& book) : book_(book) {}
  void pose(std::string_view device, const std::optional<geometry::RigidTransform>& target_from_source,
            double stamp_utc_s) override {
    if (book_.take({device, target_from_source, stamp_utc_s, now_ns}))
      pose_ns = now_ns;
    else if (strangers.size() < kMostNamed)
      strangers.emplace(device);
  }
  void status(std::string_view device, bool is_ok, std::string_view words) override {
    if (!is_ok) book_.take_lost(device);
    told = is_ok ? "" : std::string(device) + " says: " + std::string(words.substr(0, kMostWords));
  }
  void refused(const std::string& why) override {
    ++refused_count;
    refusal = why;
    if (refused_count == 1) log::warning("OpenIGTLink: " + why);
  }

  static constexpr std::size_t kMostNamed = 4, kMostWords = 80;
  std::int64_t now_ns = 0, pose_ns = 0;
  std::set<std::string, std::less<>> strangers;  // names that nobody here goes by
  std::string told, refusal;
  long refused_count = 0;

 private:
  tracker::PoseBook& book_;
};

std::string names_of(const std::set<std::string, std::less<>>& strangers) {
  std::string names;
  for (const std::string& name : strangers) names += (names.empty() ? "" : ", ") + name;
  return names;
}

// What the thread does.
class Reading {
 public:
  Reading(BookWorker::Inbox& inbox, sources::SourceLine& line, const std::string& name,
          const TrackerAddress& address, const tracker::TrackedBodies& bodies)
      : inbox_(inbox), line_(line), name_(name), address_(address), book_(bodies) {}

  void run() {
    while (!inbox_.stops()) {
      TrackerConnection connection;
      const std::string why = connection.open(address_, [&] { return inbox_.stops(); });
      const std::string ending = why.empty() ? read(connection) : why;
      book_.end();
      inbox_.publish(book_);
      say(ending + "; connecting again");
      inbox_.sleep_until(BookWorker::Clock::now() + kPause);
    }
  }

 private:
  void say(const std::string& words) { line_.say(words.empty() ? "" : name_ + ": " + words); }

  // Until no more will come; why.
  std::string read(TrackerConnection& connection) {
    book_.begin(connection.round_trip_s());
    inbox_.publish(book_);
    connection.send(ask_for_tracking_data());
    Listener listener(book_);
    IgtlReader reader(listener);
    std::array<std::uint8_t, 16 * 1024> bytes;
    const std::int64_t begun_ns = sources::steady_now_ns();
    std::int64_t heard_ns = begun_ns, timely_ns = begun_ns, ended_ns = begun_ns;
    std::uint64_t ended_count = 0;
    listener.pose_ns = begun_ns;
    while (!inbox_.stops()) {
      const auto received = connection.receive(bytes, kReceive_ms);
      listener.now_ns = sources::steady_now_ns();
      if (received.count > 0) {
        heard_ns = listener.now_ns;
        if (!reader.take(std::span(bytes).first(received.count))) return listener.refusal;
        inbox_.publish(book_);
      }
      if (!received.ending.empty()) return received.ending;
      if (!book_.is_late()) timely_ns = listener.now_ns;
      if (listener.now_ns - timely_ns > kBehind_ns) return "its poses come late by its clock";
      if (listener.now_ns - heard_ns > kSilence_ns) return "it sends nothing";
      if (reader.is_within_message() && listener.now_ns - heard_ns > kHalfMessage_ns)
        return "a message broke off half-way";
      if (std::exchange(ended_count, reader.ended_count()) != reader.ended_count() ||
          !reader.is_within_message())
        ended_ns = listener.now_ns;
      if (listener.now_ns - ended_ns > kEndlessMessage_ns) return "a message does not end";
      tell(listener);
    }
    return "ended";
  }

  void tell(const Listener& listener) {
    if (listener.now_ns - listener.pose_ns <= kNoPose_ns) return say("");
    if (!listener.told.empty()) return say(listener.told);
    if (!listener.refusal.empty()) return say("connected; " + listener.refusal);
    const std::string strangers = names_of(listener.strangers);
    say(strangers.empty() ? "connected, but no pose comes"
                          : "connected; it sends " + strangers + ", which tools.json does not name");
  }

  BookWorker::Inbox& inbox_;
  sources::SourceLine& line_;
  const std::string& name_;
  const TrackerAddress& address_;
  tracker::PoseBook book_;
};

}  // namespace

TrackerAddress tracker_address(std::string_view typed) {
  const std::string text = sources::with_small_scheme(std::string(typed));
  const auto fail = [&](const char* why) {
    throw InvalidInput("\"" + text + "\" is no tracker's address (igtl://HOST:PORT): " + why);
  };
  if (!text.starts_with(kScheme)) fail("it does not begin with igtl://");
  std::string_view rest = std::string_view(text).substr(kScheme.size());
  TrackerAddress address;
  const bool is_bracketed = rest.starts_with('[');
  const std::size_t bracket = is_bracketed ? rest.find(']') : 0;
  if (bracket == std::string_view::npos) fail("a bracket is not closed");
  const std::size_t colon = rest.find(':', bracket);
  address.host = is_bracketed ? rest.substr(1, bracket - 1) : rest.substr(0, colon);
  if (address.host.empty() || address.host.find_first_of("/@ ") != std::string::npos)
    fail("there is no host");
  if (is_bracketed && bracket + 1 != std::min(colon, rest.size())) fail("after the host comes the port");
  if (colon == std::string_view::npos) return address;
  const std::string_view port = rest.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (error != std::errc() || end != port.data() + port.size() || address.port < 1 || address.port > 65535)
    fail("the port must be 1 to 65535");
  return address;
}

void see_by(tools::ToolSet& tools, const std::string& address) {
  if (address.empty()) return;
  if (!tools.tracker) tools.tracker.emplace();
  tools.tracker->address = address;
}

std::unique_ptr<tracker::PoseSource> listen_to_tracker(const pipeline::PipelineOptions& options) {
  return std::make_unique<IgtlTracker>(
      options.tools.tracker->address,
      tracker::TrackedBodies{options.tools, options.bone, options.probe_name, options.guide_name});
}

struct IgtlTracker::State {
  State(const std::string& text, const tracker::TrackedBodies& with)
      : name(text),
        address(tracker_address(text)),
        bodies(with),
        worker(worker::Backlog::NewestWins,
               [this](BookWorker::Inbox& inbox) { Reading(inbox, line, name, address, bodies).run(); }) {
    line.say(name + ": connecting");
  }
  const std::string name;
  const TrackerAddress address;
  const tracker::TrackedBodies bodies;
  sources::SourceLine line;
  BookWorker worker;  // last: ends before the rest goes
};

IgtlTracker::IgtlTracker(const std::string& address, const tracker::TrackedBodies& bodies)
    : state_(std::make_unique<State>(address, bodies)) {}
IgtlTracker::~IgtlTracker() = default;

void IgtlTracker::poses_at(std::int64_t now_ns, tracker::TrackerPoses& poses) {
  if (const auto book = state_->worker.latest())
    book->poses_at(now_ns, poses);
  else
    tracker::set_all(state_->bodies.tools, tracker::BodyState::NotConnected, poses);
}

std::string IgtlTracker::trouble() const { return state_->line.trouble(); }
const std::string& IgtlTracker::name() const { return state_->name; }

}  // namespace arthronaut::openigtlink
