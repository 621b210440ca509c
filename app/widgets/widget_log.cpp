#include "app/widgets/widget_log.h"

#include <cmath>
#include <cstdio>

namespace arthronaut::widgets {

void WidgetLog::note(std::string_view name, const ImVec2& min, const ImVec2& max) {
  if (!prints_) return;
  frame_ += "WIDGET " + std::string(name);
  for (const float value : {min.x, min.y, max.x - min.x, max.y - min.y})
    frame_ += " " + std::to_string(std::lround(value));
  frame_ += "\n";
}

void WidgetLog::note_button(std::string_view name, const ImVec2& min, const ImVec2& max) {
  next_buttons_.push_back({min.x, min.y, max.x - min.x, max.y - min.y});
  note(name, min, max);
}

void WidgetLog::note_state(std::string_view key, std::string_view value) {
  if (!prints_) return;
  const auto known = states_.find(key);
  if (known != states_.end() && known->second == value) return;
  states_.insert_or_assign(std::string(key), std::string(value));
  new_states_ += "STATE " + std::string(key) + " " + std::string(value) + "\n";
}

void WidgetLog::add(std::string_view what, double amount) {
  if (!prints_) return;
  const auto known = numbers_.find(what);
  if (known != numbers_.end())
    known->second += amount;
  else
    numbers_.emplace(what, amount);
}

void WidgetLog::end_frame() {
  buttons_.swap(next_buttons_);
  next_buttons_.clear();
  if (!prints_) return;
  add("shown_s", std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
  if (frame_ != printed_) {
    std::printf("%sREADY\n", frame_.c_str());
    printed_ = frame_;
  }
  std::fputs(new_states_.c_str(), stdout);
  std::fputs("FRAME", stdout);
  for (const auto& [what, amount] : numbers_) std::printf(" %s=%.6f", what.c_str(), amount);
  std::fputs("\n", stdout);
  std::fflush(stdout);
  numbers_.clear();
  new_states_.clear();
  frame_.clear();
}

}  // namespace arthronaut::widgets
