// Which live pictures: the cameras that are connected, the streams that were used before, and a field in
// which the address of another one is typed, or of an outside tracker that sees bones and tools in the place
// of the pictures; beside each what it shows now. Worked by a pedal, one key for the next, one to open, or by
// a click on what is to be opened.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/previews/source_previews.h"
#include "app/widgets/controls.h"
#include "app/widgets/layout.h"
#include "navigation/sources/camera_modes.h"
#include "navigation/sources/connected_cameras.h"

namespace arthronaut::navigate {

struct LivePictures {
  std::string name;           // for the screen: what the camera is called, the address without a password
  std::optional<int> device;  // of /dev/videoN
  std::string address;        // of a stream; of a camera what was typed, where it was
  [[nodiscard]] bool operator==(const LivePictures& other) const = default;
};

// How it is to be opened; of this size where it has it and none was typed. Precondition: it is a device.
[[nodiscard]] sources::CameraAddress camera_address_of(const LivePictures& pictures,
                                                       const Eigen::Vector2i& prefers_px);

class CameraChoice {
 public:
  // Opens one to be looked at, on a thread of its own; must refuse what is in use. Null: it is what is
  // navigated by.
  using Look = std::function<std::unique_ptr<sources::FrameSource>(const LivePictures&)>;
  // Offers them; the one that was used before is chosen, a stream also where it gave no picture, else the
  // first. What did not open stands in the field, too.
  // Where there is none at all the field waits for an address. Without `look` nothing is previewed.
  void open(const std::vector<sources::ConnectedCamera>& cameras, const std::vector<std::string>& streams,
            const std::optional<LivePictures>& before = std::nullopt, const Look& look = {});
  // The same with the field chosen, whatever is on offer.
  void choose_field();
  // What was looked at is let go.
  void close();
  [[nodiscard]] bool is_open() const { return is_open_; }
  // In turn; after the last one the field, in which an address is typed.
  void choose_next();
  // The same for a foot, which types nothing: past the field, where it would be caught.
  void choose_next_offered();
  // Where nobody has chosen yet and what is chosen does not answer: the first one that gives pictures. Every
  // frame.
  void prefer_what_answers();
  // What is chosen was asked for a picture, and gives none.
  [[nodiscard]] bool chosen_does_not_answer() const;
  // Empty: nothing is on offer, or the field is chosen.
  [[nodiscard]] std::optional<LivePictures> chosen() const;
  [[nodiscard]] std::size_t count() const { return offered_.size(); }

  // Takes an address as it was typed: what it opens. Empty: a tracker's, which opens nothing, or none, and
  // then trouble() says what an address looks like.
  [[nodiscard]] std::optional<LivePictures> take_address(std::string typed);
  // What stands in the field.
  [[nodiscard]] const std::string& typed() const { return text_; }
  // Of what was typed last; empty: nothing is wrong.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  // Of the outside tracker that was typed, "igtl://HOST:PORT", for whatever live source is begun from now on.
  // Empty: none was, or "igtl://" alone, and the tools say who sees them.
  [[nodiscard]] const std::string& tracker() const { return tracker_; }
  void forget_tracker() { tracker_.clear(); }
  // While it is open; what was clicked on, or typed and entered with Enter, in that frame. Esc or the
  // pedal for the way back closes it.
  [[nodiscard]] std::optional<LivePictures> draw(const widgets::Ui& ui, const widgets::Rect& video);
  // What the keys do now: in the field a letter is a letter.
  [[nodiscard]] std::string_view keys() const;
  // The field takes the keys.
  [[nodiscard]] bool wants_text() const { return is_open_ && (wants_focus_ || is_typing_); }

 private:
  // The one that was clicked on.
  [[nodiscard]] std::optional<LivePictures> draw_rows(const widgets::Ui& ui, widgets::Rect& box,
                                                      float height);

  std::vector<LivePictures> offered_;
  std::size_t chosen_ = 0;  // offered_.size(): the field
  bool is_open_ = false, wants_focus_ = false, is_typing_ = false;
  bool was_chosen_ = false;  // by a hand
  std::string text_, trouble_, tracker_;
  previews::SourcePreviews previews_;
};

}  // namespace arthronaut::navigate
