// A display of the test's own (Xvfb), the workstation on it, and a hand (xdotool).
#pragma once

#include <sys/types.h>

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace arthronaut::test {

// What is missing on this machine to test the window; empty when nothing is.
[[nodiscard]] std::string missing_for_window_tests();

// Runs the program on the command line; its exit code, and what it said and complained.
[[nodiscard]] std::pair<int, std::string> run_arthronaut(const std::string& arguments);

// An X server without a screen. Gone when the test is over.
class VirtualDisplay {
 public:
  VirtualDisplay(int width, int height);
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  [[nodiscard]] const std::string& name() const { return name_; }  // ":7"

 private:
  pid_t process_ = -1;
  std::string name_;
};

struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  [[nodiscard]] std::array<int, 3> at(int x, int y) const;
};

struct Area {
  int x = 0, y = 0, width = 0, height = 0;
};

// A frame that was drawn: its numbers (widget_log.h), and the states that were others in it for the first
// time.
struct DrawnFrame {
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> states;
  [[nodiscard]] double number(const std::string& name) const {  // 0 where there is none
    const auto found = numbers.find(name);
    return found != numbers.end() ? found->second : 0;
  }
};

// The workstation with --list-widgets. What it prints is read as it comes.
class RunningWorkstation {
 public:
  // data_home holds the built-in case, which is opened at once unless other arguments are given.
  RunningWorkstation(const VirtualDisplay& display, const std::filesystem::path& data_home,
                     const std::vector<std::string>& arguments = {"--built-in"});
  ~RunningWorkstation();
  RunningWorkstation(const RunningWorkstation&) = delete;
  RunningWorkstation& operator=(const RunningWorkstation&) = delete;

  // False when the state did not become so within the time.
  [[nodiscard]] bool wait_for_state(const std::string& key, const std::string& value,
                                    double seconds = 40) const;
  // The list of widgets follows the states of the same frame: wait for what is to be used.
  [[nodiscard]] bool wait_for_widget(const std::string& name, double seconds = 40) const;
  [[nodiscard]] std::string state(const std::string& key) const;
  [[nodiscard]] std::map<std::string, std::string> states() const;  // all, as they are now
  [[nodiscard]] std::map<std::string, Area> widgets() const;        // of the last complete list
  [[nodiscard]] std::vector<DrawnFrame> frames() const;             // all that were drawn so far

  void press(const std::string& key) const;  // as xdotool names it
  // Holds the key down until the state is so, then lets go; false when it did not become so in time.
  [[nodiscard]] bool hold_until(const std::string& key, const std::string& state, const std::string& value,
                                double seconds = 40) const;
  void type(const std::string& text) const;  // as fast as it goes
  void click(const std::string& widget) const;
  void point_at(const std::string& widget) const;  // the mouse rests on its middle
  // The same with the mouse on a widget.
  [[nodiscard]] bool hold_click_until(const std::string& widget, const std::string& state,
                                      const std::string& value, double seconds = 40) const;
  void freeze(double seconds) const;  // the program stands still, as a machine that is overloaded
  void while_frozen(const std::function<void()>& act) const;  // so that all of it comes between two frames
  void click_at(int x, int y) const;
  void scroll_up(const std::string& widget) const;  // one step of the wheel over it
  void drag(int x0, int y0, int x1, int y1) const;
  [[nodiscard]] Picture screenshot() const;
  // Holds the key down until the program has ended; the exit code, or -1 when it has not.
  int hold_to_exit(const std::string& key, double seconds);
  void kill();  // at once, as a crash or a power cut ends it
  // The exit code, or -1 when it did not end within the time.
  int wait_for_exit(double seconds);

 private:
  void read_output(int pipe);
  void hand(const std::string& arguments) const;

  std::string display_;
  std::filesystem::path folder_;
  pid_t process_ = -1;
  mutable std::mutex mutex_;
  std::map<std::string, std::string> states_;
  std::map<std::string, Area> arriving_, widgets_;
  std::map<std::string, std::string> new_states_;
  std::vector<DrawnFrame> frames_;
  std::thread reader_;
};

}  // namespace arthronaut::test
