#include "tests/app/window/display.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace arthronaut::test {

namespace {

using Clock = std::chrono::steady_clock;

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

void end(pid_t process) {
  if (process <= 0) return;
  kill(process, SIGTERM);
  waitpid(process, nullptr, 0);
}

// Starts a program; its descriptor `from` writes into the returned pipe.
std::pair<pid_t, int> start(const std::vector<std::string>& arguments, int from,
                            const std::map<std::string, std::string>& environment) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process");
  if (process == 0) {
    close(ends[0]);  // before dup2: it may be `from` itself
    dup2(ends[1], from);
    if (ends[1] != from) close(ends[1]);
    for (const auto& [key, value] : environment) setenv(key.c_str(), value.c_str(), 1);
    const int nothing = open("/dev/null", O_RDWR);
    for (const int other : {1, 2})
      if (other != from) dup2(nothing, other);
    std::vector<char*> raw;
    for (const std::string& argument : arguments) raw.push_back(const_cast<char*>(argument.c_str()));
    raw.push_back(nullptr);
    execvp(raw[0], raw.data());
    _exit(127);
  }
  close(ends[1]);
  return {process, ends[0]};
}

}  // namespace

std::string missing_for_window_tests() {
  for (const char* program : {"Xvfb", "xdotool", "import"})
    if (!is_installed(program)) return std::string(program) + " is not installed";
  return "";
}

std::pair<int, std::string> run_arthronaut(const std::string& arguments) {
  FILE* const pipe = popen((std::string(ARTHRONAUT_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no process");
  std::string output;
  for (int letter = fgetc(pipe); letter != EOF; letter = fgetc(pipe)) output += static_cast<char>(letter);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), output};
}

VirtualDisplay::VirtualDisplay(int width, int height) {
  constexpr int kDisplayDescriptor = 3;
  const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
  const auto [process, pipe] = start(
      {"Xvfb", "-displayfd", std::to_string(kDisplayDescriptor), "-screen", "0", screen, "-nolisten", "tcp"},
      kDisplayDescriptor, {});
  process_ = process;
  name_ = ":";
  char letter = 0;
  while (read(pipe, &letter, 1) == 1 && letter != '\n') name_ += letter;
  close(pipe);
  if (name_ == ":") throw std::runtime_error("Xvfb did not start");
}

VirtualDisplay::~VirtualDisplay() { end(process_); }

std::array<int, 3> Picture::at(int x, int y) const {
  const std::size_t i =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  return {rgb.at(i), rgb.at(i + 1), rgb.at(i + 2)};
}

RunningWorkstation::RunningWorkstation(const VirtualDisplay& display, const std::filesystem::path& data_home,
                                       const std::vector<std::string>& arguments)
    : display_(display.name()), folder_(data_home) {
  std::vector<std::string> words{ARTHRONAUT_PROGRAM, "--list-widgets"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto [process, pipe] = start(
      words, 1, {{"DISPLAY", display_}, {"XDG_DATA_HOME", data_home.string()}, {"HOME", data_home.string()}});
  process_ = process;
  reader_ = std::thread([this, pipe = pipe] { read_output(pipe); });
}

RunningWorkstation::~RunningWorkstation() {
  end(process_);
  reader_.join();
}

void RunningWorkstation::read_output(int pipe) {
  FILE* stream = fdopen(pipe, "r");
  char* line = nullptr;
  std::size_t capacity = 0;
  while (getline(&line, &capacity, stream) > 0) {
    std::istringstream words(line);
    std::string kind, name;
    words >> kind;
    const std::lock_guard lock(mutex_);
    if (kind == "STATE") {
      std::string value;
      words >> name >> std::ws;
      std::getline(words, value);
      states_[name] = new_states_[name] = value;
      if (name == "key_clash") ADD_FAILURE() << "two actions share a key: " << value;
    } else if (kind == "WIDGET") {
      Area area;
      words >> name >> area.x >> area.y >> area.width >> area.height;
      arriving_[name] = area;
    } else if (kind == "READY") {
      widgets_ = std::move(arriving_);
      arriving_.clear();
    } else if (kind == "FRAME") {
      DrawnFrame frame{{}, std::exchange(new_states_, {})};
      for (std::string word; words >> word;) {
        const std::size_t at = word.find('=');
        frame.numbers[word.substr(0, at)] = std::atof(word.c_str() + at + 1);
      }
      frames_.push_back(std::move(frame));
    }
  }
  free(line);
  fclose(stream);
}

bool RunningWorkstation::wait_for_state(const std::string& key, const std::string& value,
                                        double seconds) const {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < until) {
    if (state(key) == value) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

bool RunningWorkstation::wait_for_widget(const std::string& name, double seconds) const {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < until) {
    if (widgets().contains(name)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

std::string RunningWorkstation::state(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = states_.find(key);
  return found == states_.end() ? "" : found->second;
}

std::map<std::string, std::string> RunningWorkstation::states() const {
  const std::lock_guard lock(mutex_);
  return states_;
}

std::map<std::string, Area> RunningWorkstation::widgets() const {
  const std::lock_guard lock(mutex_);
  return widgets_;
}

std::vector<DrawnFrame> RunningWorkstation::frames() const {
  const std::lock_guard lock(mutex_);
  return frames_;
}

void RunningWorkstation::hand(const std::string& arguments) const {
  if (std::system(("DISPLAY=" + display_ + " xdotool " + arguments).c_str()) != 0)
    throw std::runtime_error("xdotool " + arguments);
}

void RunningWorkstation::press(const std::string& key) const { hand("key " + key); }

bool RunningWorkstation::hold_until(const std::string& key, const std::string& state,
                                    const std::string& value, double seconds) const {
  hand("keydown " + key);
  const bool became = wait_for_state(state, value, seconds);
  hand("keyup " + key);
  return became;
}

bool RunningWorkstation::hold_click_until(const std::string& widget, const std::string& state,
                                          const std::string& value, double seconds) const {
  point_at(widget);
  hand("mousedown 1");
  const bool became = wait_for_state(state, value, seconds);
  hand("mouseup 1");
  return became;
}

void RunningWorkstation::freeze(double seconds) const {
  while_frozen([seconds] { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); });
}

void RunningWorkstation::while_frozen(const std::function<void()>& act) const {
  ::kill(process_, SIGSTOP);
  act();
  ::kill(process_, SIGCONT);
}

void RunningWorkstation::type(const std::string& text) const { hand("type --delay 0 '" + text + "'"); }

void RunningWorkstation::point_at(const std::string& widget) const {
  const auto all = widgets();
  const auto found = all.find(widget);
  if (found == all.end()) throw std::runtime_error("no widget " + widget);
  const Area& area = found->second;
  hand("mousemove " + std::to_string(area.x + area.width / 2) + " " +
       std::to_string(area.y + area.height / 2) + " sleep 0.2");
}

void RunningWorkstation::click(const std::string& widget) const {
  point_at(widget);
  hand("mousedown 1 sleep 0.2 mouseup 1");
}

void RunningWorkstation::click_at(int x, int y) const {
  hand("mousemove " + std::to_string(x) + " " + std::to_string(y) +
       " sleep 0.2 mousedown 1 sleep 0.2 mouseup 1");
}

void RunningWorkstation::scroll_up(const std::string& widget) const {
  point_at(widget);
  hand("click 4");
}

void RunningWorkstation::drag(int x0, int y0, int x1, int y1) const {
  const auto text = [](int x, int y) { return std::to_string(x) + " " + std::to_string(y); };
  hand("mousemove " + text(x0, y0) + " sleep 0.2 mousedown 1 sleep 0.2 mousemove " +
       text((x0 + x1) / 2, (y0 + y1) / 2) + " sleep 0.2 mousemove " + text(x1, y1) + " sleep 0.2 mouseup 1");
}

Picture RunningWorkstation::screenshot() const {
  const std::filesystem::path file = folder_ / "screen.ppm";
  if (std::system(("DISPLAY=" + display_ + " import -window root -depth 8 ppm:" + file.string()).c_str()) !=
      0)
    throw std::runtime_error("import failed");
  std::ifstream stream(file, std::ios::binary);
  std::string magic;
  int most = 0;
  Picture picture;
  stream >> magic >> picture.width >> picture.height >> most;
  stream.get();
  picture.rgb.resize(3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  stream.read(reinterpret_cast<char*>(picture.rgb.data()), static_cast<std::streamsize>(picture.rgb.size()));
  if (!stream) throw std::runtime_error("the screenshot is cut off");
  return picture;
}

void RunningWorkstation::kill() {
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = -1;
}

int RunningWorkstation::hold_to_exit(const std::string& key, double seconds) {
  hand("keydown " + key);
  const int code = wait_for_exit(seconds);
  hand("keyup " + key);
  return code;
}

int RunningWorkstation::wait_for_exit(double seconds) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < until) {
    int status = 0;
    if (waitpid(process_, &status, WNOHANG) == process_) {
      process_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return -1;
}

}  // namespace arthronaut::test
