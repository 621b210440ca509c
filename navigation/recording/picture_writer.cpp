#include "navigation/recording/picture_writer.h"

#include <atomic>
#include <exception>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "navigation/pipeline/bounded_queue.h"
#include "navigation/recording/packet_file.h"
#include "navigation/recording/stream_copy.h"
#include "navigation/recording/video_encoder.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

constexpr std::size_t kWaitingPictures = 32;  // half a second, 200 MB at 1080p

// Streams now and then name their clock's ticks. Files count in ms: beyond this a picture could not be found
// by its time.
constexpr double kMostPerSecond = 240, kUnknownPerSecond = 60;

double rate_of_file(double frames_per_second) {
  const bool is_credible = frames_per_second >= 1 && frames_per_second <= kMostPerSecond;
  return is_credible ? frames_per_second : kUnknownPerSecond;
}

// Writes pictures into parts, in one thread.
class VideoParts {
 public:
  VideoParts(std::filesystem::path folder, const PictureWriterOptions& options, const PictureNews& news)
      : folder_(std::move(folder)), options_(options), news_(news) {}

  void keep(const camera::Frame& picture) {
    const bool is_kept = options_.as == PicturesAs::AsTheyCame && keep_as_it_came(picture);
    if (!is_kept) encode(picture);
  }

  void end_part() {
    if (copy_ != nullptr) copy_->finish();
    if (encoder_) encoder_->finish();
    if ((copy_ != nullptr || encoder_) && news_.ended) news_.ended(part_);
    copy_.reset();
    encoder_.reset();
  }
  // After a failure: what the file holds is all that it will hold.
  void leave_part() {
    const bool had_part = copy_ != nullptr || encoder_;
    try {
      if (copy_ != nullptr) copy_->finish();
      if (encoder_) encoder_->finish();
    } catch (const std::runtime_error&) {
      // As it was to be expected: the first failure is the one that is told.
    }
    copy_.reset();
    encoder_.reset();
    if (had_part && news_.ended) news_.ended(part_);
  }
  // Packets that came before the next picture are not wanted.
  void forget_what_came() { may_reach_back_ = false; }

 private:
  bool keep_as_it_came(const camera::Frame& picture) {
    KeptPicture kept;
    if (copy_ != nullptr && copy_->take(picture, kept)) {
      tell(kept);
      return true;
    }
    if (copy_ != nullptr) leave_copy();
    const sources::EncodedPacketPtr start = start_for(picture);
    if (start == nullptr) return false;
    auto begun = std::make_unique<StreamCopy>(folder_ / next_file(), options_.packets, start, picture);
    // The first picture of a part decides whether there will be one.
    if (!begun->take(picture, kept)) {
      begun->finish();
      std::error_code ignored;
      std::filesystem::remove(folder_ / next_file(), ignored);
      note_refusal(*begun);
      return false;
    }
    end_part();
    copy_ = std::move(begun);
    begin(picture, {next_file(), count_, PicturesAs::AsTheyCame, copy_->codec(), copy_->held_back()}, "");
    tell(kept);
    return true;
  }

  void leave_copy() {
    note_refusal(*copy_);
    end_part();
  }

  void note_refusal(const StreamCopy& copy) {
    why_ = copy.refusal();
    if (copy.is_hopeless()) hopeless_ = copy.format();
  }

  // Where a new part can begin for this picture; null: nowhere, and why_ says why.
  sources::EncodedPacketPtr start_for(const camera::Frame& picture) {
    if (options_.packets == nullptr || picture.packet < 0) {
      why_ = "the source gives its pictures without any encoding";
      return nullptr;
    }
    sources::EncodedPacketPtr start = options_.packets->start_of(picture.packet);
    if (start != nullptr && start->format == hopeless_) return nullptr;
    if (start != nullptr && !PacketFile::takes(*start)) {
      hopeless_ = start->format;
      why_ = "there is no file format for such a stream";
      return nullptr;
    }
    // Among encoded pictures only where a new part loses nothing, and repeats nothing.
    const bool begins_here = start != nullptr && start->number == picture.packet;
    if (start != nullptr && (begins_here || (!encoder_ && may_reach_back_))) return start;
    if (why_.empty()) why_ = "decoding could not begin yet";
    return nullptr;
  }

  void encode(const camera::Frame& picture) {
    if (!encoder_) {
      const PicturesAs as = options_.as == PicturesAs::AsTheyCame ? PicturesAs::Lossless : options_.as;
      encoder_.emplace(folder_ / next_file(), picture.width, picture.height,
                       rate_of_file(options_.frames_per_second), as);
      begin(picture, {next_file(), count_, as, encoder_->codec(), 0}, why_);
    }
    encoder_->encode(picture);
    const std::int64_t number = count_ - part_.first_picture;
    tell({picture.index, number, number, 0, digest_of_luma(camera::luma_of(picture, gray_))});
  }

  void begin(const camera::Frame& picture, VideoPart part, const std::string& why) {
    part_ = std::move(part);
    ++part_count_;
    may_reach_back_ = true;
    if (news_.begun) news_.begun(part_, picture, why);
    why_.clear();
  }

  void tell(const KeptPicture& kept) {
    ++count_;
    if (news_.kept) news_.kept(kept);
  }

  [[nodiscard]] std::string next_file() const {
    return part_count_ == 0 ? "video.mkv" : "video_" + std::to_string(part_count_ + 1) + ".mkv";
  }

  std::filesystem::path folder_;
  PictureWriterOptions options_;
  PictureNews news_;
  std::unique_ptr<StreamCopy> copy_;
  std::optional<VideoEncoder> encoder_;
  VideoPart part_;  // the one that is being written, or was last
  std::vector<std::uint8_t> gray_;
  std::shared_ptr<const sources::PacketFormat> hopeless_;
  std::string why_;
  std::int64_t count_ = 0;
  int part_count_ = 0;
  bool may_reach_back_ = true;
};

}  // namespace

struct PictureWriter::State {
  State(const std::filesystem::path& folder, const PictureWriterOptions& options, const PictureNews& news)
      : parts(folder, options, news), queue(kWaitingPictures) {}

  void run() {
    try {
      while (const auto picture = queue.pop()) {
        if (*picture == nullptr) {  // a part's end
          parts.end_part();
          parts.forget_what_came();
        } else {
          parts.keep(**picture);
        }
      }
      parts.end_part();
    } catch (...) {
      error = std::current_exception();
      parts.leave_part();  // before anybody waits for this thread
      failed = true;
      queue.close();
      while (queue.pop()) {
      }
    }
  }

  // `error` may be read only after the thread has ended.
  void join_and_report() {
    queue.close();
    if (worker.joinable()) worker.join();
    if (error) std::rethrow_exception(std::exchange(error, nullptr));
  }

  VideoParts parts;  // the thread's
  pipeline::BoundedQueue<camera::FramePtr> queue;
  bool part_is_open = false;  // by what was handed over; the caller's
  std::atomic<bool> failed = false;
  std::exception_ptr error;
  std::thread worker;
};

PictureWriter::PictureWriter(const std::filesystem::path& folder, const PictureWriterOptions& options,
                             const PictureNews& news)
    : state_(std::make_unique<State>(folder, options, news)) {
  state_->worker = std::thread([state = state_.get()] { state->run(); });
}

PictureWriter::~PictureWriter() {
  state_->queue.close();
  if (state_->worker.joinable()) state_->worker.join();
}

void PictureWriter::write(const camera::FramePtr& picture) {
  if (!state_->queue.push(picture)) state_->join_and_report();
  state_->part_is_open = true;
}

bool PictureWriter::try_write(const camera::FramePtr& picture) {
  if (state_->failed) state_->join_and_report();
  const bool is_taken = state_->queue.try_push(picture);
  state_->part_is_open = state_->part_is_open || is_taken;
  return is_taken;
}

void PictureWriter::end_part() {
  // One end for each run of pictures at most: the queue grows no further than to twice its room.
  if (!std::exchange(state_->part_is_open, false)) return;
  if (!state_->queue.push_at_once(nullptr)) state_->join_and_report();
}

void PictureWriter::finish() { state_->join_and_report(); }

}  // namespace arthronaut::recording
