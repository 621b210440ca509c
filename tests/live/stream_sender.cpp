// Sends the marker scene by RTSP, rtsp://127.0.0.1:PORT/scope, until it is killed, and spoils it as it is
// told:
//   stream_sender PORT [jpeg|vp8|h264]      then lines on standard input:
//   live | black | frozen | torn | repeated | stalled | small
// Says "listening" when it can be connected to. A program of its own, to be killed and to be stopped.
#include <gst/app/gstappsrc.h>
#include <gst/rtsp-server/rtsp-server.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

#include "tests/live/marker_scene.h"

namespace {

using arthronaut::test::kSceneHeight;
using arthronaut::test::kSceneWidth;

constexpr int kRate = 30;

std::mutex g_mutex;
GstElement* g_source = nullptr;  // of the medium that is being sent

void on_media(GstRTSPMediaFactory*, GstRTSPMedia* media, gpointer) {
  GstElement* const bin = gst_rtsp_media_get_element(media);
  const std::lock_guard lock(g_mutex);
  if (g_source != nullptr) gst_object_unref(g_source);
  g_source = gst_bin_get_by_name_recurse_up(GST_BIN(bin), "pictures");
  gst_object_unref(bin);
}

GstCaps* caps_of(int width, int height) {
  return gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "GRAY8", "width", G_TYPE_INT, width,
                             "height", G_TYPE_INT, height, "framerate", GST_TYPE_FRACTION, kRate, 1, nullptr);
}

void push(const std::vector<std::uint8_t>& picture, int width, int height) {
  const std::lock_guard lock(g_mutex);
  if (g_source == nullptr) return;
  GstCaps* const caps = caps_of(width, height);
  gst_app_src_set_caps(GST_APP_SRC(g_source), caps);
  gst_caps_unref(caps);
  GstBuffer* const buffer = gst_buffer_new_allocate(nullptr, picture.size(), nullptr);
  gst_buffer_fill(buffer, 0, picture.data(), picture.size());
  gst_app_src_push_buffer(GST_APP_SRC(g_source), buffer);
}

// Every second pixel of every second row.
std::vector<std::uint8_t> small_of(const std::vector<std::uint8_t>& picture) {
  std::vector<std::uint8_t> small;
  for (int y = 0; y < kSceneHeight; y += 2)
    for (int x = 0; x < kSceneWidth; x += 2)
      small.push_back(picture[static_cast<std::size_t>(y * kSceneWidth + x)]);
  return small;
}

// Empty while nothing was said.
std::string said() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return "";
  char line[64] = {};
  if (std::fgets(line, sizeof line, stdin) == nullptr) return "end";
  std::string text(line);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  gst_init(nullptr, nullptr);
  const std::string codec = count > 2 ? arguments[2] : "jpeg";
  const std::string encoder =
      codec == "vp8"    ? "vp8enc deadline=1 cpu-used=8 target-bitrate=8000000 keyframe-max-dist=15 ! "
                          "rtpvp8pay name=pay0"
      : codec == "h264" ? "openh264enc bitrate=8000000 rate-control=bitrate gop-size=15 complexity=low ! "
                          "rtph264pay name=pay0 config-interval=-1"
                        : "jpegenc quality=92 ! rtpjpegpay name=pay0";
  GstRTSPServer* const server = gst_rtsp_server_new();
  gst_rtsp_server_set_service(server, arguments[1]);
  GstRTSPMediaFactory* const factory = gst_rtsp_media_factory_new();
  gst_rtsp_media_factory_set_shared(factory, TRUE);
  const std::string launch =
      "( appsrc name=pictures is-live=true format=time do-timestamp=true max-buffers=2 leaky-type=downstream "
      "! "
      "videoconvert ! video/x-raw,format=I420 ! " +
      encoder + " )";
  gst_rtsp_media_factory_set_launch(factory, launch.c_str());
  g_signal_connect(factory, "media-configure", G_CALLBACK(on_media), nullptr);
  GstRTSPMountPoints* const mounts = gst_rtsp_server_get_mount_points(server);
  gst_rtsp_mount_points_add_factory(mounts, "/scope", factory);
  g_object_unref(mounts);
  if (gst_rtsp_server_attach(server, nullptr) == 0) return 1;
  GMainLoop* const loop = g_main_loop_new(nullptr, FALSE);
  std::thread([loop] { g_main_loop_run(loop); }).detach();

  const arthronaut::test::MarkerScene scene;
  std::setvbuf(stdin, nullptr, _IONBF, 0);
  std::puts("listening");
  std::fflush(stdout);
  std::string mode = "live";
  auto due = std::chrono::steady_clock::now();
  long began = 0;
  for (long frame = 1;; ++frame) {
    due += std::chrono::microseconds(1'000'000 / kRate);
    std::this_thread::sleep_until(due);
    if (const std::string word = said(); word == "end") {
      std::_Exit(0);
    } else if (!word.empty()) {
      mode = word;
      began = frame;
    }
    const long since = frame - began;
    if (mode == "stalled") continue;
    // A source that hangs goes on with its last picture, and one that repeats shows each five times: from the
    // first picture on that is told to be spoiled all are.
    const long kept = began - 1 + (mode == "repeated" ? 5 * ((since + 1) / 5) : 0);
    if (mode == "black")
      push(scene.black(frame), kSceneWidth, kSceneHeight);
    else if (mode == "frozen" || mode == "repeated")
      push(scene.live(kept), kSceneWidth, kSceneHeight);
    else if (mode == "torn" && since % 8 == 0)
      push(scene.torn(frame), kSceneWidth, kSceneHeight);
    else if (mode == "small")
      push(small_of(scene.live(frame)), kSceneWidth / 2, kSceneHeight / 2);
    else
      push(scene.live(frame), kSceneWidth, kSceneHeight);
  }
}
