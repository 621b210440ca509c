// Cards over the picture that ask something, and the field in which the depth stop's reading is typed.
#pragma once

#include <optional>
#include <string>

#include "app/navigate/beginning_words.h"
#include "app/widgets/layout.h"

namespace arthronaut::navigate {

void draw_card(const widgets::Ui& ui, const widgets::Rect& area, const Card& card);

class DepthEntry {
 public:
  void open();
  void close() { is_open_ = wants_focus_ = false; }
  // At the foot of the picture while it is open; the reading, in mm, in the frame in which it was entered.
  // What is no reading is told and asked for again; Esc or the pedal for the way back closes it.
  [[nodiscard]] std::optional<double> draw(const widgets::Ui& ui, const widgets::Rect& video);
  [[nodiscard]] bool is_open() const { return is_open_; }
  [[nodiscard]] bool wants_focus() const { return wants_focus_; }

 private:
  std::string text_, trouble_;
  bool is_open_ = false, wants_focus_ = false;
};

}  // namespace arthronaut::navigate
