// Which live pictures: the cameras that are connected, the streams that were used before, and a field in
// which the address of another one is typed. Worked by a pedal: one key for the next, one to open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "app/widgets/layout.h"
#include "navigation/sources/connected_cameras.h"

namespace arthronaut::navigate {

struct LivePictures {
  std::string name;           // for the screen: what the camera is called, the address without a password
  std::optional<int> device;  // of /dev/videoN
  std::string address;        // of a stream, where it is no device
  [[nodiscard]] bool operator==(const LivePictures& other) const = default;
};

class CameraChoice {
 public:
  // Offers them; the one that was used before is chosen, else the first. Where there is none at all the field
  // waits for an address.
  void open(const std::vector<sources::ConnectedCamera>& cameras, const std::vector<std::string>& streams,
            const std::optional<LivePictures>& before = std::nullopt);
  void close() { *this = {}; }
  [[nodiscard]] bool is_open() const { return is_open_; }
  // In turn; after the last one the field, in which an address is typed.
  void choose_next();
  // Empty: nothing is on offer, or the field is chosen.
  [[nodiscard]] std::optional<LivePictures> chosen() const;
  [[nodiscard]] std::size_t count() const { return offered_.size(); }

  // Takes an address as it was typed: what it opens, or empty, and then the screen says what an address looks
  // like.
  [[nodiscard]] std::optional<LivePictures> take_address(std::string typed);
  // While it is open; what was typed and entered with Enter, in that frame. Esc closes it.
  [[nodiscard]] std::optional<LivePictures> draw(const widgets::Ui& ui, const widgets::Rect& video);
  // The field takes the keys.
  [[nodiscard]] bool wants_text() const { return is_open_ && (wants_focus_ || is_typing_); }

 private:
  void draw_rows(const widgets::Ui& ui, widgets::Rect& box) const;

  std::vector<LivePictures> offered_;
  std::size_t chosen_ = 0;  // offered_.size(): the field
  bool is_open_ = false, wants_focus_ = false, is_typing_ = false;
  std::string text_, trouble_;
};

}  // namespace arthronaut::navigate
