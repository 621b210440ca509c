#include "app/setup/frame_feed.h"

#include <chrono>
#include <exception>
#include <utility>

#include "navigation/worker/pace.h"

namespace arthronaut::setup {

namespace {

constexpr auto kWait = std::chrono::milliseconds(50);
// A still is looked at again for the sake of "held still" and of what changed since; there is no hurry.
constexpr auto kStillAgain = std::chrono::milliseconds(250);

}  // namespace

// Where the newest picture wins the reader waits for nobody, and what it publishes takes the place of what
// nobody took. Else it goes on when it hears that the picture is done with.
FrameFeed::FrameFeed(FeedSource source)
    : source_(std::move(source)),
      reader_(worker::Backlog::Lossless, [this](Reader::Inbox& inbox) { read(source_, inbox); }) {}

// A live source may wait for its camera to be plugged in again, for hours.
FrameFeed::~FrameFeed() {
  reader_.request_stop();
  if (const auto newest = reader_.latest(); newest != nullptr && newest->line != nullptr) newest->line->end();
}

std::string FrameFeed::trouble() const {
  const auto newest = reader_.latest();
  return newest != nullptr && newest->line != nullptr ? newest->line->trouble() : "";
}

void FrameFeed::read(const FeedSource& source, Reader::Inbox& inbox) {
  const std::unique_ptr<sources::FrameSource> opened = source.open();
  const std::shared_ptr<sources::SourceLine> line = opened->info().line;
  inbox.publish(Picture{nullptr, 0, line});
  const bool is_paced = !opened->info().is_live() && !source.is_stills;
  const bool waits = source.is_stills || !source.newest_wins;
  worker::Pace pace;
  for (long number = 1; !inbox.stops(); ++number) {
    camera::FramePtr frame = opened->next();
    if (frame == nullptr) return;
    if (is_paced) inbox.sleep_until(pace.due(frame->timestamp_ns));
    inbox.publish(Picture{std::move(frame), number, line});
    if (!waits) continue;
    auto done = inbox.next();
    while (done && *done != number) done = inbox.next();
    if (!done) return;
  }
}

long FrameFeed::newest_number() const {
  const auto newest = reader_.latest();
  return newest == nullptr ? 0 : newest->number;
}

camera::FramePtr FrameFeed::next() {
  if (newest_number() == given_) seen_ = reader_.wait_for_other_than(seen_, Reader::Clock::now() + kWait);
  seen_ = reader_.latest();
  const long number = seen_ == nullptr ? 0 : seen_->number;
  const bool is_standing = source_.is_stills && given_ > passed_;
  const bool again = is_standing && Reader::Clock::now() - given_at_ > kStillAgain;
  if (number > given_ || again) {
    given_ = number;
    given_at_ = Reader::Clock::now();
    if (!source_.newest_wins && !source_.is_stills) reader_.post(number);
    return seen_->frame;
  }
  if (reader_.error() != nullptr && !std::exchange(has_thrown_, true))
    std::rethrow_exception(reader_.error());
  return nullptr;
}

void FrameFeed::advance() {
  if (!source_.is_stills || newest_number() > given_) return;  // nobody has looked at the one that came
  if (std::exchange(passed_, given_) != given_) reader_.post(given_);
}

bool FrameFeed::has_started() const { return reader_.latest() != nullptr; }

bool FrameFeed::awaits_still() const {
  return source_.is_stills && newest_number() == passed_ && !reader_.has_ended();
}

// An error that nobody was told yet is still to come.
bool FrameFeed::has_ended() const {
  return reader_.has_ended() && newest_number() == given_ && (has_thrown_ || reader_.error() == nullptr);
}

}  // namespace arthronaut::setup
