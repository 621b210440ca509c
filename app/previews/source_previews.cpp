#include "app/previews/source_previews.h"

#include <imgui.h>

#include <chrono>
#include <cstdint>
#include <utility>

#include "navigation/sources/camera_modes.h"
#include "navigation/worker/worker.h"
#include "planning/files/format.h"

namespace arthronaut::previews {

namespace {

constexpr std::size_t kMostShown = 4;
// As often as a small picture needs to live.
constexpr auto kBetweenPictures = std::chrono::milliseconds(90);
constexpr auto kMeasured = std::chrono::milliseconds(1000);
constexpr const char* kBeingOpened = "is being opened";

// Pictures a second, by those that came in the last second.
class RateMeter {
 public:
  using Clock = std::chrono::steady_clock;
  void came(Clock::time_point now) {
    if (count_++ == 0) begun_ = now;
    const std::chrono::duration<double> passed = now - begun_;
    if (passed < kMeasured) return;
    rate_ = static_cast<double>(count_ - 1) / passed.count();
    count_ = 1;
    begun_ = now;
  }
  [[nodiscard]] double rate() const { return rate_; }

 private:
  Clock::time_point begun_;
  long count_ = 0;
  double rate_ = 0;
};

}  // namespace

std::string words_of(const Preview& preview) {
  if (!preview.trouble.empty()) return preview.trouble;
  if (preview.is_open_here) return "is open now";
  if (preview.does_not_answer()) return "does not answer";
  if (preview.picture == nullptr) return kBeingOpened;
  const std::string size = sources::size_in_words(preview.size_px);
  const std::string known =
      preview.frames_per_second > 0 ? size + files::format(", %.1f/s", preview.frames_per_second) : size;
  return preview.remark.empty() ? known : known + "; " + preview.remark;
}

class SourcePreview::Reader {
 public:
  explicit Reader(Opener opener)
      : worker_(worker::Backlog::NewestWins,
                [opener = std::move(opener)](Worker::Inbox& inbox) { read(opener, inbox); }) {}
  // A live source may wait for its camera for hours.
  ~Reader() {
    worker_.request_stop();
    if (const auto known = worker_.latest(); known != nullptr && known->line != nullptr) known->line->end();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] Preview latest() const {
    const auto known = worker_.latest();
    Preview preview = known != nullptr ? known->preview : Preview();
    if (known != nullptr && known->line != nullptr) {
      preview.trouble = known->line->trouble();
      preview.remark = known->line->remark();
    }
    preview.waited_s = std::chrono::duration<double>(RateMeter::Clock::now() - begun_).count();
    if (worker_.has_ended() && !worker_.failure().empty()) preview.trouble = worker_.failure();
    return preview;
  }

 private:
  struct Known {
    Preview preview = {};
    std::shared_ptr<sources::SourceLine> line = nullptr;
  };
  using Worker = worker::Worker<int, Known>;

  static void read(const Opener& opener, Worker::Inbox& inbox) {
    const std::unique_ptr<sources::FrameSource> source = opener();
    if (source == nullptr) return inbox.publish({.preview = {.is_open_here = true}});
    const sources::SourceInfo& info = source->info();
    Known known{.preview = {.size_px = info.image_size_px}, .line = info.line};
    inbox.publish(known);
    RateMeter meter;
    RateMeter::Clock::time_point published;
    while (!inbox.stops()) {
      camera::FramePtr frame = source->next();
      if (frame == nullptr) return;
      const auto now = RateMeter::Clock::now();
      meter.came(now);
      if (now - published < kBetweenPictures) continue;
      published = now;
      known.preview.size_px = {frame->width, frame->height};
      known.preview.frames_per_second = info.is_live() ? meter.rate() : info.frames_per_second;
      known.preview.picture = std::move(frame);
      inbox.publish(known);
      if (!info.is_live()) return;
    }
  }

  const RateMeter::Clock::time_point begun_ = RateMeter::Clock::now();
  Worker worker_;
};

SourcePreview::SourcePreview(Opener opener) : reader_(std::make_unique<Reader>(std::move(opener))) {}
SourcePreview::~SourcePreview() = default;
Preview SourcePreview::latest() const { return reader_->latest(); }

void SourcePreviews::show(const std::vector<Opener>& openers) {
  close();
  for (const Opener& opener : openers) {
    if (previews_.size() == kMostShown) break;
    previews_.push_back({std::make_unique<SourcePreview>(opener), std::make_unique<widgets::VideoTexture>()});
  }
}

void SourcePreviews::close() {
  for (Shown& one : previews_) ending_.end(std::move(one.preview));
  previews_.clear();
}

bool SourcePreviews::draw(const widgets::Ui& ui, const widgets::Rect& row, std::size_t index,
                          const std::string& name, bool is_chosen) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImGui::SetCursorScreenPos(row.min());
  ImGui::PushID(static_cast<int>(index));
  const bool is_clicked = ImGui::InvisibleButton("##source", {row.width, row.height});
  ui.log.note("source_" + std::to_string(index), ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const bool is_pointed_at = ImGui::IsItemHovered();
  ImGui::PopID();
  if (is_chosen || is_pointed_at)
    draw.AddRectFilled(row.min(), row.max(),
                       is_chosen ? IM_COL32(28, 74, 104, 255) : IM_COL32(30, 36, 44, 255));
  widgets::Rect rest = row.inset(ui.theme.px(6));
  const widgets::Rect place = rest.cut_left(rest.height * 16 / 9, ui.theme.px(16));
  std::string words;
  if (is_shown(index)) {
    Shown& shown = previews_[index];
    const Preview preview = shown.preview->latest();
    words = words_of(preview);
    shown.texture->upload(preview.picture);
    draw.AddRectFilled(place.min(), place.max(), IM_COL32(0, 0, 0, 255));
    if (shown.texture->texture() != 0 && shown.texture->height() > 0) {
      const float aspect =
          static_cast<float>(shown.texture->width()) / static_cast<float>(shown.texture->height());
      const widgets::Rect picture = widgets::fitted(place, aspect);
      // What stands still because nothing comes is no picture of now.
      const ImU32 tint = preview.trouble.empty() ? IM_COL32_WHITE : IM_COL32(90, 90, 90, 255);
      draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(shown.texture->texture())),
                    picture.min(), picture.max(), {0, 0}, {1, 1}, tint);
    }
    ui.log.note_state("source_" + std::to_string(index), words);
  }
  const float line = ui.theme.strong->FontSize * 1.25F;
  const float top = rest.y + std::max(0.F, (rest.height - 2 * line) / 2);
  draw.PushClipRect(rest.min(), rest.max(), true);
  draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {rest.x, top},
               is_chosen ? widgets::kText : widgets::kQuietText, name.c_str());
  draw.AddText(ui.theme.body, ui.theme.body->FontSize, {rest.x, top + line}, widgets::kQuietText,
               words.c_str(), nullptr, rest.width);
  draw.PopClipRect();
  return is_clicked;
}

}  // namespace arthronaut::previews
