#include "app/screen_copy/screen_copies.h"

#include <utility>

#include "app/scene/image.h"
#include "navigation/recording/session.h"
#include "navigation/worker/niceness.h"
#include "planning/files/format.h"
#include "planning/files/private_folder.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::screen_copy {

namespace {

constexpr double kSaidFor_s = 5;

constexpr int kStandsBackBy = 10;  // guidance first

// A name that nothing in the folder has yet, and nothing that is still being written will have.
std::filesystem::path new_file(const std::filesystem::path& case_folder, const char* extension,
                               std::set<std::filesystem::path>& given) {
  const std::filesystem::path folder = screens_folder(case_folder);
  files::create_private_folder(folder);
  const std::string time = files::utc_now_as("%Y%m%d-%H%M%S");
  for (int number = 1;; ++number) {
    const std::string name = time + (number > 1 ? "-" + std::to_string(number) : "") + extension;
    const bool is_there =
        std::filesystem::exists(folder / name) || std::filesystem::exists(folder / (name + ".part"));
    if (!is_there && given.insert(folder / name).second) return folder / name;
  }
}

scene::Image image_of(const widgets::ScreenPicture& picture) {
  scene::Image image{picture.width, picture.height, {}};
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  image.rgb.resize(3 * width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = picture.bgra.data() + 4 * width * (height - 1 - y);
    std::uint8_t* to = image.rgb.data() + 3 * width * y;
    for (std::size_t x = 0; x < width; ++x, from += 4, to += 3) {
      to[0] = from[2];
      to[1] = from[1];
      to[2] = from[0];
    }
  }
  return image;
}

// As much stays free as a session's own video leaves.
bool is_nearly_full(const std::filesystem::path& folder) {
  const recording::DiskLimits limits;
  return limits.free_bytes(folder) < limits.video_stops_below_bytes;
}

}  // namespace

std::filesystem::path screens_folder(const std::filesystem::path& case_folder) {
  return case_folder / "screens";
}

ScreenCopies::ScreenCopies(std::string stream_address, std::function<void()> wake)
    : stream_address_(std::move(stream_address)),
      wake_(std::move(wake)),
      pictures_([](widgets::ScreenPicture&) {}),
      shots_(
          worker::Backlog::Lossless,
          [](auto& inbox) {
            worker::stand_back(kStandsBackBy);
            while (const auto shot = inbox.next()) {
              const std::string name = shot->first.filename().string();
              try {  // a disk that is full ends no later screenshot
                scene::write_png(shot->first, image_of(*shot->second));
                inbox.publish(Said{"Screenshot " + name + " is in the case"});
              } catch (const IoError& error) {
                inbox.publish(Said{"No screenshot: " + std::string(error.what())});
              }
            }
          },
          wake_) {}

ScreenCopies::~ScreenCopies() {
  end(recording_);
  end(stream_);
  shots_.finish();
}

void ScreenCopies::say(std::string words) {
  said_ = std::move(words);
  said_until_s_ = now_s_ + kSaidFor_s;
}

void ScreenCopies::take_screenshot(const std::filesystem::path& case_folder, const std::string& refusal) {
  if (!refusal.empty()) return say("No screenshot: " + refusal);
  try {  // said on the screen, where the key was pressed
    shot_file_ = new_file(case_folder, ".png", given_);
  } catch (const IoError& error) {
    say("No screenshot: " + std::string(error.what()));
  }
}

void ScreenCopies::begin(Output& output, const std::string& target) {
  output.target = target;
  output.begun_s = -1;
  const auto body = [target](auto& inbox) {
    worker::stand_back(kStandsBackBy);
    const std::filesystem::path folder = std::filesystem::path(target).parent_path();
    // The one that still waits when it is ended is written, too.
    const auto next = [&inbox] {
      auto picture = inbox.next();
      return picture ? picture : inbox.poll();
    };
    std::optional<ScreenEncoder> encoder;
    bool has_room = true;
    for (long count = 0; const auto picture = next(); ++count) {
      const bool is_due = !is_stream(target) && count % static_cast<long>(kRate) == 0;
      has_room = !is_due || !is_nearly_full(folder);
      if (!has_room) break;
      if (!encoder) encoder.emplace(target, (*picture)->width, (*picture)->height);
      encoder->encode(**picture);
    }
    if (encoder) {
      encoder->finish();
      inbox.publish(Written{});
    }
    if (!has_room) throw IoError(target, "the disk is nearly full");
  };
  output.writer = std::make_unique<Writer>(worker::Backlog::NewestWins, body, wake_);
}

void ScreenCopies::end(Output& output) {
  if (output.writer == nullptr) return;
  output.writer->request_stop();
  ending_.push_back(std::exchange(output, {}));
}

void ScreenCopies::toggle_recording(const std::filesystem::path& case_folder, const std::string& refusal) {
  if (is_recording()) return end(recording_);
  if (!refusal.empty()) return say("The screen is not recorded: " + refusal);
  try {
    begin(recording_, new_file(case_folder, ".mkv", given_).string());
  } catch (const IoError& error) {
    say("The screen is not recorded: " + std::string(error.what()));
  }
}

void ScreenCopies::toggle_stream() {
  if (is_streaming()) {
    end(stream_);
    return say("The screen is not sent any more");
  }
  if (stream_address_.empty())
    return say("The screen is not sent: theatre.json names no screen_stream (udp://HOST:PORT)");
  begin(stream_, stream_address_);
}

std::shared_ptr<widgets::ScreenPicture> ScreenCopies::wanted(double now_s) {
  now_s_ = now_s;
  const bool is_due = is_busy() && now_s >= next_s_;
  if (shot_file_.empty() && !is_due) return nullptr;
  // Evenly, whatever the screen's own rate.
  if (is_due) next_s_ = std::max(next_s_ + 1 / kRate, now_s - 1 / kRate);
  return pictures_.take();
}

void ScreenCopies::take(const widgets::ScreenPicturePtr& picture) {
  if (!shot_file_.empty()) shots_.post({std::exchange(shot_file_, {}), picture});
  for (Output* const output : {&recording_, &stream_}) {
    if (output->writer == nullptr) continue;
    if (output->begun_s < 0) output->begun_s = picture->time_s;
    output->writer->post(picture);
  }
}

std::string ScreenCopies::outcome_of(const Output& ended) {
  const std::string failure = ended.writer->failure();
  if (is_stream(ended.target)) return failure.empty() ? "" : "The stream of the screen has ended: " + failure;
  const bool is_whole = ended.writer->latest() != nullptr;
  if (!failure.empty())
    return (is_whole ? "The recording of the screen has ended: "
                     : "The recording of the screen is not whole: ") +
           failure;
  return is_whole ? "The screen is in the case: " + std::filesystem::path(ended.target).filename().string()
                  : "The screen is not recorded: it was ended before its first picture";
}

void ScreenCopies::read_ended() {
  for (Output* const output : {&recording_, &stream_})
    if (output->writer != nullptr && output->writer->has_ended()) end(*output);
  std::erase_if(ending_, [this](const Output& output) {
    if (!output.writer->has_ended()) return false;
    if (std::string words = outcome_of(output); !words.empty()) say(std::move(words));
    return true;
  });
}

std::string ScreenCopies::words(double now_s) {
  now_s_ = now_s;
  read_ended();
  if (const auto shot = shots_.latest(); shot != last_shot_) {
    last_shot_ = shot;
    say(shot->words);
  }
  std::string words = now_s < said_until_s_ ? said_ : "";
  const auto add = [&](const std::string& more) { words += (words.empty() ? "" : ".  ") + more; };
  if (is_recording()) {
    const int seconds = recording_.begun_s < 0 ? 0 : static_cast<int>(now_s - recording_.begun_s);
    add(files::format("SCREEN IS RECORDED %d:%02d", seconds / 60, seconds % 60));
  }
  if (is_streaming()) add("SCREEN IS SENT to " + stream_.target);
  return words;
}

}  // namespace arthronaut::screen_copy
