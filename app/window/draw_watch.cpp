#include "app/window/draw_watch.h"

#include <array>
#include <cstdio>
#include <utility>

namespace arthronaut::window {

namespace {

std::string seconds_text(const char* format, std::chrono::duration<double> time) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), format, time.count());
  return text.data();
}

}  // namespace

DrawWatch::DrawWatch(Tell tell, std::chrono::milliseconds limit)
    : tell_(std::move(tell)),
      limit_(limit),
      watcher_(worker::Backlog::NewestWins, [this](Watcher::Inbox& inbox) { watch(inbox); }) {}

void DrawWatch::frame_drawn(bool matters) {
  matters_ = matters;
  last_ = Watcher::Clock::now().time_since_epoch().count();
}

void DrawWatch::watch(Watcher::Inbox& inbox) {
  Watcher::Clock::rep stands_since = 0;  // the frame after which the screen stood still; 0: it does not
  while (!inbox.stops()) {
    inbox.sleep_until(Watcher::Clock::now() + limit_ / 5);
    const Watcher::Clock::rep last = last_;
    const auto time_of = [](Watcher::Clock::rep frame) {
      return Watcher::Clock::time_point(Watcher::Clock::duration(frame));
    };
    if (stands_since != 0 && last != stands_since) {
      tell_(seconds_text("the screen moves again after %.1f s", time_of(last) - time_of(stands_since)));
      stands_since = 0;
    }
    const auto stood = Watcher::Clock::now() - time_of(last);
    if (last == 0 || last == stands_since || !matters_ || stood < limit_) continue;
    stands_since = last;
    tell_(seconds_text("the screen has stood still for %.1f s while an operation runs", stood));
  }
}

}  // namespace arthronaut::window
