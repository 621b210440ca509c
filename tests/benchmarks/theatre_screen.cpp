// The theatre's screen with everything running, on a display of its own: the real window, an operation on a
// live 1080p60 H.264 stream by RTSP over the loopback, with tracking, recording, video, plan, 3D and
// bullseye.
//   theatre_screen [SECONDS] [--seed N] [--size WxH] [--without-record] [--shot FILE.png] [--stream FILE.mkv]
// --stream: taken where it is there, else made and kept, for the next run.
// Registers on the path-traced scratching first, then measures while the guide comes and goes: pictures a
// second, what a frame costs and in which part, how soon a key is seen, how old a picture is on the screen,
// what of the stream was looked at and recorded. And, before, how soon the window is there.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "navigation/recording/session.h"
#include "navigation/tools/tool_set.h"
#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/files/json_document.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/quantile.h"
#include "tests/app/window/display.h"
#include "tests/child_process.h"
#include "tests/recorded_data.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;

struct Choice {
  double seconds = 60;
  int width = 1920, height = 1080;  // of the screen
  unsigned seed = 1;
  bool records = true;
  std::string shot, stream;
};

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
void wait_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

void run(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
}

// The case of the clips: the same scope, bone and marker in both. The guide counts as measured.
void make_case(const fs::path& folder, const fs::path& clips) {
  cases::Case knee;
  knee.name = "Theatre screen";
  knee.created_utc = files::utc_now();
  auto& bone = knee.bones[bones::BoneKind::Femur];
  bone = {bones::BoneKind::Femur, bones::read_mesh_file(clips / "probe_wet/bone.stl").mesh, "bone.stl"};
  const auto truth = files::read_json(clips / "guide_wet/gt/tunnel.json", "arthronaut-acceptance.tunnel", 1);
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = truth.vector3("entry_mm");
  tunnel.direction = truth.vector3("direction").normalized();
  knee.plan.put(tunnel, bones::mesh_sha256(bone.mesh));
  cases::save_case(folder, knee);
  fs::copy_file(clips / "guide_wet/camera.json", cases::camera_file(folder));
  tools::ToolSet tools = tools::read_tools_file(clips / "guide_wet/tools.json");
  for (tools::Tool& tool : tools.tools) tool.provenance = {provenance::Origin::Measured, files::utc_now()};
  tools::write_tools_file(cases::tools_file(folder), tools);
}

// Scratching for 12 s, then the guide to and fro for long enough, without B-frames.
fs::path make_stream(const fs::path& folder, const fs::path& clips, double seconds) {
  const std::string quiet = "ffmpeg -v error -y ",
                    code = " -an -c:v libx264 -preset veryfast -bf 0 -g 60 -b:v 12M ";
  const auto text = [](const fs::path& file) { return "'" + file.string() + "'"; };
  run(quiet + "-i " + text(clips / "probe_wet/clip.mkv") + code + text(folder / "probe.mkv"));
  run(quiet + "-i " + text(clips / "guide_wet/clip.mkv") +
      " -filter_complex '[0]split[a][b];[b]reverse[r];[a][r]concat'" + code + text(folder / "guide.mkv"));
  std::ofstream list(folder / "list.txt");
  for (int i = 0; i < 3; ++i) list << "file probe.mkv\n";
  for (double done_s = 0; done_s < seconds; done_s += 80 / 60.0) list << "file guide.mkv\n";
  list.close();
  run(quiet + "-f concat -safe 0 -i " + text(folder / "list.txt") + " -c copy " + text(folder / "whole.mkv"));
  return folder / "whole.mkv";
}

// xdotool, started once: what it takes to start is not the screen's.
class Hand {
 public:
  explicit Hand(const std::string& display)
      : pipe_(::popen(("DISPLAY=" + display + " xdotool -").c_str(), "w")) {}
  ~Hand() { ::pclose(pipe_); }
  Hand(const Hand&) = delete;
  Hand& operator=(const Hand&) = delete;
  void press(const std::string& key) const {
    std::fprintf(pipe_, "key --delay 0 %s\n", key.c_str());
    std::fflush(pipe_);
  }

 private:
  FILE* pipe_;
};

struct Key {
  const char *key, *state;
  double stays_s;  // before it is pressed again, to be as it was
};
// The last goes through the operation's thread.
constexpr Key kKeys[]{{"v", "overlay", 0.5},
                      {"Return", "menu", 0.25},
                      {"u", "view", 0.25},
                      {"h", "layout", 0.25},
                      {"d", "draws", 0.5}};

struct Reactions {
  std::vector<double> ms, of_operation_ms, frames;
  int unseen = 0;
};

// From the press to the frame on the screen that shows its effect first.
void press_and_watch(const test::RunningWorkstation& app, const Hand& hand, const Key& key,
                     Reactions& reactions) {
  const std::size_t before = app.frames().size();
  const double pressed_s = now_s();
  hand.press(key.key);
  wait_s(key.stays_s);
  const auto frames = app.frames();
  int drawn = 0;
  for (std::size_t i = before; i < frames.size(); ++i) {
    if (frames[i].number("shown_s") < pressed_s) continue;
    ++drawn;
    if (!frames[i].states.contains(key.state)) continue;
    const double ms = 1000 * (frames[i].number("shown_s") - pressed_s);
    reactions.ms.push_back(ms);
    reactions.frames.push_back(drawn);
    if (std::strcmp(key.state, "draws") == 0) reactions.of_operation_ms.push_back(ms);
    return;
  }
  ++reactions.unseen;
}

void print(const char* what, const std::vector<double>& values) {
  if (values.empty()) return;
  std::printf("| %s | %.1f | %.1f | %.1f |\n", what, geometry::quantile(values, 0.5),
              geometry::quantile(values, 0.99), *std::max_element(values.begin(), values.end()));
}

void print_frames(const std::vector<test::DrawnFrame>& frames, double from_s, double to_s) {
  std::map<std::string, std::vector<double>> parts;
  std::vector<double> ages_ms, gaps_ms;
  double last_picture = -1, last_s = 0, bytes = 0, scenes = 0;
  long drawn = 0, pictures = 0;
  for (const test::DrawnFrame& frame : frames) {
    const double shown_s = frame.number("shown_s");
    if (shown_s < from_s || shown_s > to_s) continue;
    ++drawn;
    bytes += frame.number("uploaded_bytes");
    scenes += frame.number("scenes");
    for (const char* part :
         {"frame_ms", "work_ms", "build_ms", "video_ms", "overlay_ms", "draw_ms", "swap_ms"})
      parts[part].push_back(frame.number(part));
    if (frame.number("scenes") > 0) parts["scene_ms"].push_back(frame.number("scene_ms"));
    const double picture = frame.number("picture");
    if (picture <= last_picture) continue;
    last_picture = picture;
    ++pictures;
    ages_ms.push_back(1000 * (shown_s - frame.number("captured_s")));
    if (last_s > 0) gaps_ms.push_back(1000 * (shown_s - last_s));
    last_s = shown_s;
  }
  const double seconds = to_s - from_s;
  std::printf(
      "frames %.1f a second, new pictures %.1f a second, 3D %.1f a second, uploads %.0f MB a second\n",
      static_cast<double>(drawn) / seconds, static_cast<double>(pictures) / seconds, scenes / seconds,
      1e-6 * bytes / seconds);
  std::printf("| ms | median | 99 %% | worst |\n|---|---|---|---|\n");
  print("from a new picture to the next", gaps_ms);
  print("capture to display", ages_ms);
  print("a frame, without the wait for it", parts["frame_ms"]);
  print("keys, queues, states", parts["work_ms"]);
  print("building it, all of the next three in it", parts["build_ms"]);
  print("video", parts["video_ms"]);
  print("plan on the video", parts["overlay_ms"]);
  print("3D, where it is drawn", parts["scene_ms"]);
  print("handing it to OpenGL", parts["draw_ms"]);
  print("swap, with what was left to compute", parts["swap_ms"]);
}

void print_record(const fs::path& folder) {
  const recording::RecordedSession session(folder);
  const auto& frames = session.frames();
  if (frames.empty()) return;
  const double sent =
      60e-9 * static_cast<double>(frames.back().timestamp_ns - frames.front().timestamp_ns) + 1;
  std::printf("sent %.0f, looked at and recorded %zu (%.2f %%), pictures kept %zu\n", sent, frames.size(),
              100 * static_cast<double>(frames.size()) / sent, session.pictures().size());
  // Most are lost together, as where the first scene with a guide is drawn: when.
  double worst = 0, worst_s = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    const auto from = std::ranges::lower_bound(frames, frames[i].timestamp_ns - kSecond_ns, {},
                                               [](const auto& frame) { return frame.timestamp_ns; });
    const auto there = static_cast<double>(frames.begin() + static_cast<std::ptrdiff_t>(i) - from);
    const double lost = 60e-9 * static_cast<double>(frames[i].timestamp_ns - from->timestamp_ns) - there;
    if (lost > worst) worst = lost, worst_s = 1e-9 * static_cast<double>(frames[i].timestamp_ns);
  }
  std::printf("most of them within a second: %.0f, until %.1f s\n", worst,
              worst_s - 1e-9 * static_cast<double>(frames.front().timestamp_ns));
  for (const recording::SessionEvent& event : session.events())
    if (event.kind == recording::kLatencyEvent || event.kind == recording::kDroppedPicturesEvent ||
        event.kind == recording::kPicturesKeptEvent)
      std::printf("%s: %s\n", event.kind.c_str(), event.text.c_str());
}

void measure_start(const test::VirtualDisplay& display, const fs::path& folder) {
  std::vector<double> ms;
  for (int i = 0; i < 5; ++i) {
    const double begun_s = now_s();
    test::RunningWorkstation app(display, folder, {"--frames", "2"});
    (void)app.wait_for_exit(30);
    wait_s(0.1);  // until what it wrote was read
    if (const auto frames = app.frames(); !frames.empty())
      ms.push_back(1000 * (frames.front().number("shown_s") - begun_s));
  }
  std::printf("start to the first frame: median %.0f ms, worst %.0f ms of %zu\n", geometry::quantile(ms, 0.5),
              ms.empty() ? 0 : *std::max_element(ms.begin(), ms.end()), ms.size());
}

void expect(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(std::string("did not come about: ") + what);
}

// By the keys that a surgeon's team has: the address, the time-out, and whatever the pedal does next.
void reach_guidance(const test::RunningWorkstation& app, const std::string& address) {
  expect(app.wait_for_state("case", "open", 60), "the case");
  app.press("F2");
  expect(app.wait_for_state("mode", "navigate"), "Navigate");
  app.press("shift+k");
  expect(app.wait_for_state("cameras", "address"), "the field for an address");
  app.type(address);
  app.press("Return");
  expect(app.wait_for_state("picture", "live", 60), "the first picture");
  for (int i = 0; i < 200 && app.state("guidance") != "valid"; ++i) {
    // Nothing that ends the operation before it was measured: touches and the tunnel's end are left.
    const std::string next = app.state("next");
    if (app.state("pedal") == "acts" && (next.starts_with("time-out") || next.starts_with("register")))
      app.press("space");
    wait_s(0.2);
  }
  if (app.state("guidance") != "valid")
    std::printf("guidance: %s; next: %s\n", app.state("guidance").c_str(), app.state("next").c_str());
  expect(app.state("guidance") == "valid", "guidance");
}

std::string load() {
  std::string words;
  std::getline(std::ifstream("/proc/loadavg"), words);
  return words;
}

int measure(const Choice& choice) {
  const fs::path clips = test::recorded_data() / "arthroscopy";
  const test::TemporaryFolder folder;
  const fs::path case_folder = folder / "theatre.arthro";
  make_case(case_folder, clips);
  const fs::path stream = choice.stream.empty() ? folder / "stream.mkv" : fs::path(choice.stream);
  if (!fs::exists(stream)) fs::copy_file(make_stream(folder.path(), clips, choice.seconds + 60), stream);
  const std::string port = std::to_string(20000 + ::getpid() % 40000);
  const auto sender = test::send_by_rtsp(port, test::h264_clip_launch(stream));
  const test::VirtualDisplay display(choice.width, choice.height);
  measure_start(display, folder.path());

  test::RunningWorkstation app(display, folder.path(), {case_folder.string()});
  reach_guidance(app, test::rtsp_address(port));
  if (choice.records) {
    app.press("ctrl+r");
    expect(app.wait_for_state("recording", "on"), "the record of the video");
  }
  wait_s(3);
  std::printf("load before: %s\n", load().c_str());
  const Hand hand(display.name());
  hand.press("Shift_L");  // its first press asks for the keyboard's map
  wait_s(0.5);
  std::mt19937 random(choice.seed);
  std::uniform_real_distribution<double> pause_s(0.2, 0.7);
  Reactions reactions;
  const double from_s = now_s();
  for (std::size_t i = 0; now_s() < from_s + choice.seconds; ++i) {
    // Mostly the plan on the video, which changes nothing of what is drawn beside.
    const Key& key = kKeys[random() % 2 == 0 ? 0 : random() % std::size(kKeys)];
    for (int times = 0; times < 2; ++times) press_and_watch(app, hand, key, reactions);
    wait_s(pause_s(random));
  }
  const double to_s = now_s();
  std::printf("load after: %s\n", load().c_str());
  if (!choice.shot.empty()) run("DISPLAY=" + display.name() + " import -window root '" + choice.shot + "'");
  print_frames(app.frames(), from_s, to_s);
  print("key to the frame that shows it", reactions.ms);
  print("of it, by way of the operation", reactions.of_operation_ms);
  print("frames from the key to it", reactions.frames);
  if (reactions.unseen > 0)
    std::printf("%d of %zu keys were not seen in time\n", reactions.unseen, reactions.ms.size());
  const std::string session = app.state("journal");
  expect(app.hold_to_exit("ctrl+q", 60) == 0, "the end");
  print_record(case_folder / "sessions" / session);
  return 0;
}

}  // namespace
}  // namespace arthronaut

int main(int count, char** arguments) {
  arthronaut::Choice choice;
  bool is_understood = true;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    const bool has_next = i + 1 < count;
    if (word == "--seed" && has_next)
      choice.seed = static_cast<unsigned>(std::atoi(arguments[++i]));
    else if (word == "--size" && has_next)
      is_understood = std::sscanf(arguments[++i], "%dx%d", &choice.width, &choice.height) == 2;
    else if (word == "--shot" && has_next)
      choice.shot = arguments[++i];
    else if (word == "--stream" && has_next)
      choice.stream = arguments[++i];
    else if (word == "--without-record")
      choice.records = false;
    else
      choice.seconds = std::atof(word.c_str());
  }
  if (choice.seconds <= 0 || !is_understood) {
    std::puts(
        "theatre_screen [SECONDS] [--seed N] [--size WxH] [--without-record] [--shot FILE.png] [--stream "
        "FILE.mkv]");
    return 2;
  }
  try {
    return arthronaut::measure(choice);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
