// What the sources show that somebody chooses among: the newest picture of each, its size, how many come a
// second, or why none does. A live source is opened as it would be for the operation, and let go as soon as
// the choice is made; of a file or a simulation the first picture stands.
//
// A preview takes nothing from anybody: whoever makes the openers gives such as refuse a camera that is in
// use (sources::DeviceTurns::open_if_free), and close() frees all without being waited for.
//
// One thread, the screen's; each source is read on one of its own.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "app/widgets/video_texture.h"
#include "navigation/sources/background_end.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::previews {

// Null: it is open here already, and shown elsewhere on the screen.
using Opener = std::function<std::unique_ptr<sources::FrameSource>()>;

struct Preview {
  camera::FramePtr picture = nullptr;
  Eigen::Vector2i size_px{0, 0};
  double frames_per_second = 0;  // measured where it is live, else what the file says; 0: not known yet
  std::string trouble = {};      // why no picture comes
  std::string remark = {};       // what is wrong with those that come
  double waited_s = 0;           // for the first one, since it was asked for
  bool is_open_here = false;     // and not opened a second time
  // None came, and none is to be expected soon; a stream that is there takes less.
  [[nodiscard]] bool does_not_answer() const {
    constexpr double kAnswers_s = 4;
    return picture == nullptr && !is_open_here && (!trouble.empty() || waited_s > kAnswers_s);
  }
};
// "1920 x 1080, 59.9/s" and the remark, the trouble, that it is being opened, or does not answer.
[[nodiscard]] std::string words_of(const Preview& preview);

// One source, read on a thread of its own. The destructor waits for the picture that is being made.
class SourcePreview {
 public:
  explicit SourcePreview(Opener opener);
  ~SourcePreview();
  SourcePreview(const SourcePreview&) = delete;
  SourcePreview& operator=(const SourcePreview&) = delete;
  [[nodiscard]] Preview latest() const;

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

class SourcePreviews {
 public:
  // In place of what was shown before. The first four are opened; more would be too much for a machine and
  // its sockets.
  void show(const std::vector<Opener>& openers);
  void close();
  [[nodiscard]] bool is_shown(std::size_t index) const { return index < previews_.size(); }
  [[nodiscard]] Preview latest(std::size_t index) const {  // precondition: is_shown()
    return previews_[index].preview->latest();
  }
  // Picture on the left, beside it the name, and below it the words. True: it was clicked on.
  [[nodiscard]] bool draw(const widgets::Ui& ui, const widgets::Rect& row, std::size_t index,
                          const std::string& name, bool is_chosen);

 private:
  struct Shown {
    std::unique_ptr<SourcePreview> preview;
    std::unique_ptr<widgets::VideoTexture> texture;
  };
  std::vector<Shown> previews_;
  sources::BackgroundEnd ending_;
};

}  // namespace arthronaut::previews
