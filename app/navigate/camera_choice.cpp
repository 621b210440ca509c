#include "app/navigate/camera_choice.h"

#include <imgui_stdlib.h>

#include <algorithm>

#include "navigation/openigtlink/igtl_tracker.h"
#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {

namespace {

constexpr std::string_view kTracker = "igtl://";

}  // namespace

sources::CameraAddress camera_address_of(const LivePictures& pictures, const Eigen::Vector2i& prefers_px) {
  sources::CameraAddress address{pictures.device.value()};
  if (!pictures.address.empty()) address = sources::read_camera_address(pictures.address);
  address.wish.prefers_px = prefers_px;
  return address;
}

void CameraChoice::open(const std::vector<sources::ConnectedCamera>& cameras,
                        const std::vector<std::string>& streams, const std::optional<LivePictures>& before,
                        const Look& look) {
  close();
  is_open_ = true;
  for (const sources::ConnectedCamera& camera : cameras) offered_.push_back({camera.name, camera.index, ""});
  for (const std::string& address : streams)
    offered_.push_back({sources::shown_address(address), std::nullopt, address});
  // A stream that gave no picture when it was asked is kept nowhere. A foot must be able to ask it again.
  if (before && !before->device && std::find(offered_.begin(), offered_.end(), before) == offered_.end()) {
    offered_.push_back(*before);
    // What did not open is there to be put right, too; a password is not shown again.
    if (sources::shown_address(before->address) == before->address) text_ = before->address;
  }
  const auto same = std::find(offered_.begin(), offered_.end(), before);
  if (same != offered_.end()) chosen_ = static_cast<std::size_t>(same - offered_.begin());
  wants_focus_ = offered_.empty();
  if (same == offered_.end() && before) text_ = before->address;  // of a camera that was taken away
  if (!look) return;
  std::vector<previews::Opener> openers;
  for (const LivePictures& one : offered_) openers.emplace_back([look, one] { return look(one); });
  previews_.show(openers);
}

void CameraChoice::close() {
  previews_.close();
  offered_.clear();
  chosen_ = 0;
  is_open_ = wants_focus_ = is_typing_ = was_chosen_ = false;
  text_.clear();
  trouble_.clear();
}

void CameraChoice::prefer_what_answers() {
  if (was_chosen_ || !chosen_does_not_answer()) return;
  for (std::size_t i = 0; i < offered_.size() && previews_.is_shown(i); ++i)
    if (previews_.latest(i).picture != nullptr) {
      chosen_ = i;
      return;
    }
}

bool CameraChoice::chosen_does_not_answer() const {
  return is_open_ && chosen_ < offered_.size() && previews_.is_shown(chosen_) &&
         previews_.latest(chosen_).does_not_answer();
}

void CameraChoice::choose_field() {
  was_chosen_ = true;
  chosen_ = offered_.size();
  wants_focus_ = true;
}

void CameraChoice::choose_next() {
  was_chosen_ = true;
  chosen_ = (chosen_ + 1) % (offered_.size() + 1);
  wants_focus_ = chosen_ == offered_.size();
}

void CameraChoice::choose_next_offered() {
  if (offered_.empty()) return;
  was_chosen_ = true;
  chosen_ = chosen_ + 1 < offered_.size() ? chosen_ + 1 : 0;
  wants_focus_ = false;
}

std::optional<LivePictures> CameraChoice::chosen() const {
  return is_open_ && chosen_ < offered_.size() ? std::optional(offered_[chosen_]) : std::nullopt;
}

std::optional<LivePictures> CameraChoice::take_address(std::string typed) {
  const std::size_t first = typed.find_first_not_of(" \t"), last = typed.find_last_not_of(" \t");
  typed = first == std::string::npos ? "" : sources::with_small_scheme(typed.substr(first, last - first + 1));
  trouble_.clear();
  try {  // what was typed is answered where it was typed
    if (typed.starts_with(kTracker)) {
      if (typed != kTracker) (void)openigtlink::tracker_address(typed);
      tracker_ = typed != kTracker ? typed : "";
      return std::nullopt;
    }
    if (sources::is_camera_address(typed))
      return LivePictures{typed, sources::read_camera_address(typed).index, typed};
  } catch (const InvalidInput& refused) {
    trouble_ = refused.what();
    return std::nullopt;
  }
  // One that can't be opened must not end what runs.
  if (sources::is_stream_address(typed)) {
    if (const std::string why = sources::why_no_stream(typed); !why.empty()) {
      trouble_ = sources::shown_address(typed) + ": " + why;
      return std::nullopt;
    }
    return LivePictures{sources::shown_address(typed), std::nullopt, typed};
  }
  trouble_ =
      "No address: rtsp://HOST/PATH, udp://@:PORT, gst:PIPELINE ! appsink, /dev/video0?rate=60, "
      "igtl://TRACKER:PORT";
  return std::nullopt;
}

std::string_view CameraChoice::keys() const {
  if (!wants_text())
    return "K or V: the next one    Space, Enter or a click: open it    Page up or Esc: none";
  return offered_.empty() ? "Enter: open it    Esc: none" : "Enter, or a click: open it    Esc: none";
}

std::optional<LivePictures> CameraChoice::draw_rows(const widgets::Ui& ui, widgets::Rect& box, float height) {
  std::optional<LivePictures> clicked;
  for (std::size_t i = 0; i < offered_.size(); ++i) {
    const LivePictures& one = offered_[i];
    const std::string name =
        one.device ? one.name + "  (/dev/video" + std::to_string(*one.device) + ")" : one.name;
    if (previews_.draw(ui, box.cut_top(height), i, name, i == chosen_)) {
      chosen_ = i;
      clicked = one;
    }
  }
  return clicked;
}

std::optional<LivePictures> CameraChoice::draw(const widgets::Ui& ui, const widgets::Rect& video) {
  if (!is_open_) return std::nullopt;
  prefer_what_answers();
  const float row = ui.theme.px(56);
  // Pictures as large as there is room for them.
  const float count = static_cast<float>(offered_.size());
  const float picture = std::clamp((video.height - 4 * row) / std::max(count, 1.F), row, ui.theme.px(140));
  widgets::Rect box = video;
  box.height = picture * count + 4 * row;
  box.y = video.center().y - box.height / 2;
  ImGui::GetWindowDrawList()->AddRectFilled(box.min(), box.max(), IM_COL32(10, 12, 15, 255));
  widgets::text_centered(ui, box.cut_top(row), ui.theme.title, widgets::kText, "Which camera?");
  if (auto clicked = draw_rows(ui, box, picture)) return clicked;
  const std::string hint =
      !trouble_.empty()   ? trouble_
      : !tracker_.empty() ? "Tools seen by " + tracker_ + ". Now the pictures; igtl:// alone takes it back"
      : offered_.empty()  ? "No camera is connected. Type rtsp://HOST/PATH, udp://:PORT, igtl://TRACKER:PORT"
                          : "Or type rtsp://HOST/PATH, udp://:PORT, igtl://TRACKER:PORT";
  widgets::text_centered(ui, box.cut_top(row), ui.theme.strong,
                         trouble_.empty() ? widgets::kQuietText : widgets::kCaution, hint);
  const widgets::Rect field = box.cut_top(row).inset(ui.theme.px(6));
  ImGui::SetCursorScreenPos(field.min());
  ImGui::SetNextItemWidth(field.width);
  if (wants_focus_) ImGui::SetKeyboardFocusHere();
  const bool is_entered = ImGui::InputText("##stream", &text_, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.log.note("navigate.stream_field", ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  is_typing_ = ImGui::IsItemActive();
  // Esc; a click elsewhere leaves the field, and what is typed stays.
  const bool was_left =
      !wants_focus_ && ImGui::IsItemDeactivated() && !ImGui::IsMouseDown(ImGuiMouseButton_Left);
  wants_focus_ = false;
  ui.log.note_state("camera_keys", std::string(keys()));
  widgets::text_centered(ui, box, ui.theme.body, widgets::kQuietText, std::string(keys()));
  if (is_entered) {
    if (auto taken = take_address(text_)) return taken;
    if (trouble_.empty()) text_.clear();  // a tracker's: the pictures are still to be chosen
    wants_focus_ = true;
  } else if (was_left) {
    close();
  }
  return std::nullopt;
}

}  // namespace arthronaut::navigate
