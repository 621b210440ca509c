#include "app/widgets/graphics_window.h"

#include <GL/glew.h>
// GLEW stands before GLFW: both declare OpenGL.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <future>
#include <optional>
#include <utility>

#include "app/widgets/draw_pace.h"
#include "app/widgets/input_queue.h"
#include "app/widgets/key_labels.h"
#include "app/widgets/screen_drawing.h"
#include "app/widgets/software_drawing.h"
#include "app/widgets/two_screens.h"
#include "planning/geometry/error.h"

namespace arthronaut::widgets {

namespace {

// The one that the user calls the first stands first.
std::vector<ScreenArea> connected_screens() {
  std::vector<ScreenArea> screens;
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
    if (mode == nullptr) continue;
    ScreenArea area{0, 0, mode->width, mode->height};
    glfwGetMonitorPos(monitors[i], &area.x, &area.y);
    screens.push_back(area);
  }
  return screens;
}

// Set by whatever thread reads a hand or a foot; the window is one.
std::atomic<bool> woken_by_hand{false};

void put_window(GLFWwindow* window, const ScreenArea& area) {
  glfwSetWindowPos(window, area.x, area.y);
  glfwSetWindowSize(window, area.width, area.height);
}

}  // namespace

struct GraphicsWindow::State {
  GLFWwindow* window = nullptr;
  ImFontAtlas fonts;
  Theme theme;
  InputQueue queue;
  std::vector<InputEvent> dealt;
  std::optional<CursorPlace> cursor;  // the newest that was told; none: the window was moved since
  std::array<bool, ImGuiMouseButton_COUNT> buttons = {};  // that are down in this frame
  std::vector<KeyPress> keys;
  std::vector<int> released;
  std::vector<std::filesystem::path> dropped;
  double diagonal_mm = 0;
  int frames_to_hold = 0;
  bool has_input = false, by_processor = false;
  double begun_s = 0;
  ScreenDrawing drawing;
  DrawPace pace{false};
  std::optional<ScreenArea> on_one_screen;  // where it was, while it covers two

  static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int mods) {
    const auto kind = action == GLFW_RELEASE  ? InputEvent::Kind::Release
                      : action == GLFW_REPEAT ? InputEvent::Kind::Repeat
                                              : InputEvent::Kind::Press;
    of(window).has_input = true;
    of(window).queue.add({kind, key, scancode, mods, 0});
  }
  static void on_cursor(GLFWwindow* window, double x_px, double y_px) {
    of(window).has_input = true;
    of(window).cursor = CursorPlace{x_px, y_px};
  }
  static void on_moved(GLFWwindow* window, int, int) { of(window).cursor.reset(); }
  // Where it was for the event that is told now: on a machine that is late, not where it is now.
  [[nodiscard]] CursorPlace cursor_place() const {
    CursorPlace place = cursor.value_or(CursorPlace{});
    if (!cursor) glfwGetCursorPos(window, &place.x_px, &place.y_px);
    return place;
  }
  static void on_wheel(GLFWwindow* window, double x, double y) {
    State& s = of(window);
    s.has_input = true;
    s.queue.add({InputEvent::Kind::Wheel, 0, 0, 0, 0, s.cursor_place(), x, y});
  }
  static void on_uncovered(GLFWwindow* window) {
    of(window).drawing.forget();
    of(window).has_input = true;
  }
  static void on_button(GLFWwindow* window, int button, int action, int mods) {
    State& s = of(window);
    s.has_input = true;
    const auto kind =
        action == GLFW_RELEASE ? InputEvent::Kind::ButtonRelease : InputEvent::Kind::ButtonPress;
    s.queue.add({kind, button, 0, mods, 0, s.cursor_place()});
  }
  static void on_letter(GLFWwindow* window, unsigned codepoint) {
    of(window).queue.add({InputEvent::Kind::Text, 0, 0, 0, codepoint});
  }
  static void on_drop(GLFWwindow* window, int count, const char** paths) {
    for (int i = 0; i < count; ++i) of(window).dropped.emplace_back(paths[i]);
  }
  // The screen that the window is on, as large as the user says it is or else as it says itself. A size that
  // no screen in a theatre has is one that nobody measured.
  [[nodiscard]] Screen screen() const {
    Screen screen;
    if (window != nullptr) glfwGetFramebufferSize(window, &screen.width_px, &screen.height_px);
    screen.diagonal_mm = diagonal_mm;
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return screen;
    screen.width_px = mode->width;
    screen.height_px = mode->height;
    constexpr double kSmallest_mm = 20 * 25.4, kLargest_mm = 100 * 25.4;
    int width_mm = 0, height_mm = 0;
    glfwGetMonitorPhysicalSize(monitor, &width_mm, &height_mm);
    const double said_mm = std::hypot(width_mm, height_mm);
    if (diagonal_mm <= 0 && said_mm >= kSmallest_mm && said_mm <= kLargest_mm) screen.diagonal_mm = said_mm;
    return screen;
  }
  // True: something came before the time was up.
  bool wait(double timeout_s) {
    has_input = !queue.is_empty();
    const double until_s = glfwGetTime() + timeout_s;
    if (timeout_s > 0 && !has_input)
      glfwWaitEventsTimeout(timeout_s);
    else
      glfwPollEvents();
    const auto is_asked_for = [this] {
      has_input = woken_by_hand.exchange(false) || has_input;
      return has_input;
    };
    const bool came = is_asked_for() || glfwGetTime() < until_s;
    for (double left_s = 0; !is_asked_for() && (left_s = pace.due_s() - glfwGetTime()) > 0;)
      glfwWaitEventsTimeout(left_s);
    begun_s = glfwGetTime();
    return came;
  }
  void build(float scale) {
    theme = build_theme(fonts, scale, afar_px(screen(), scale));
    build_style(scale);
  }
  // Whether a field has the keys in the frame that is about to begin: asked before ImGui tells by io.
  [[nodiscard]] static bool takes_text() { return ImGui::GetCurrentContext()->WantTextInputNextFrame == 1; }
  void deal_input() {
    keys.clear();
    released.clear();
    dealt.clear();
    if (frames_to_hold > 0 && !takes_text()) {
      --frames_to_hold;
      return;
    }
    frames_to_hold = 0;
    queue.take_frame(dealt, takes_text());
    for (const InputEvent& event : dealt) {
      if (event.kind == InputEvent::Kind::Text)
        ImGui_ImplGlfw_CharCallback(window, event.codepoint);
      else if (!is_of_mouse(event))
        deal_key(event);
    }
  }
  void deal_key(const InputEvent& event) {
    constexpr int kOurs = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;
    const bool is_release = event.kind == InputEvent::Kind::Release;
    const bool is_repeat = event.kind == InputEvent::Kind::Repeat;
    const int action = is_release ? GLFW_RELEASE : is_repeat ? GLFW_REPEAT : GLFW_PRESS;
    ImGui_ImplGlfw_KeyCallback(window, event.key, event.scancode, action, event.mods);
    const char* printed = glfwGetKeyName(event.key, event.scancode);
    const LabelledKey key = labelled_key(event.key, event.mods & kOurs, printed != nullptr ? printed : "");
    if (is_release)
      released.push_back(key.key);
    else
      keys.push_back({key.key, key.mods, is_repeat});
  }
  // In the place of the mouse as it is now, which ImGui's backend has just asked for: the mouse as it was
  // when what belongs to this frame came. While a click still waits, it stands where it stood.
  void place_mouse(const ImVec2& before) {
    ImGuiIO& io = ImGui::GetIO();
    if (queue.waits_with_mouse()) io.MousePos = before;
    for (const InputEvent& event : dealt) {
      if (!is_of_mouse(event)) continue;
      io.MousePos = ImVec2(static_cast<float>(event.place.x_px), static_cast<float>(event.place.y_px));
      io.MouseWheelH += static_cast<float>(event.wheel_x);
      io.MouseWheel += static_cast<float>(event.wheel_y);
      if (event.kind != InputEvent::Kind::Wheel && event.key < static_cast<int>(buttons.size()))
        buttons.at(static_cast<std::size_t>(event.key)) = event.kind == InputEvent::Kind::ButtonPress;
    }
    std::copy(buttons.begin(), buttons.end(), io.MouseDown);
  }
};

GraphicsWindow::GraphicsWindow(const std::string& title, double diagonal_mm)
    : state_(std::make_unique<State>()) {
  state_->diagonal_mm = diagonal_mm;
  if (glfwInit() == GLFW_FALSE) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw DeviceError(std::string("no display to open a window on") +
                      (reason != nullptr ? std::string(": ") + reason : ""));
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, 0);
  // The whole screen: a window manager keeps its bars, and where there is none the window fills the display.
  glfwWindowHint(GLFW_MAXIMIZED, GLFW_TRUE);
  int width = 1920, height = 1080;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr; mode != nullptr) {
    width = mode->width;
    height = mode->height;
  }
  // Letters take as long as the window: they are drawn beside it, for the size that it is likely to have.
  const float scale = scale_for(width, height);
  std::future<Theme> letters = std::async(
      std::launch::async, [&fonts = state_->fonts, scale, afar = afar_px(state_->screen(), scale)] {
        return build_theme(fonts, scale, afar);
      });
  state_->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (state_->window == nullptr) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    const std::string why = reason != nullptr ? reason : "unknown";
    glfwTerminate();
    throw DeviceError("no window with OpenGL 3.3: " + why);
  }
  glfwMakeContextCurrent(state_->window);
  glfwSwapInterval(1);
  glewExperimental = GL_TRUE;
  glewInit();
  glfwSetWindowSizeLimits(state_->window, 960, 540, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSetWindowUserPointer(state_->window, state_.get());
  state_->by_processor = widgets::draws_by_processor();
  state_->pace = DrawPace(state_->by_processor);
  state_->drawing = ScreenDrawing(state_->window, state_->by_processor);
  glfwSetWindowRefreshCallback(state_->window, &State::on_uncovered);
  // ImGui's own, which follow, call these.
  glfwSetCursorPosCallback(state_->window, &State::on_cursor);
  glfwSetWindowPosCallback(state_->window, &State::on_moved);
  state_->theme = letters.get();  // before there is a context
  IMGUI_CHECKVERSION();
  ImGui::CreateContext(&state_->fonts);
  build_style(scale);
  ImGui::GetIO().IniFilename = nullptr;  // the layout is ours: nothing to remember
  ImGui_ImplGlfw_InitForOpenGL(state_->window, true);
  // In the place of ImGui's own, whose work is done when an event's frame has come.
  glfwSetMouseButtonCallback(state_->window, &State::on_button);
  glfwSetScrollCallback(state_->window, &State::on_wheel);
  glfwSetKeyCallback(state_->window, &State::on_key);
  glfwSetCharCallback(state_->window, &State::on_letter);
  glfwSetDropCallback(state_->window, &State::on_drop);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

GraphicsWindow::~GraphicsWindow() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  state_->fonts.Locked = false;  // where a frame was broken off
  glfwDestroyWindow(state_->window);
  glfwTerminate();
}

bool GraphicsWindow::begin_frame(double timeout_s) {
  State& s = *state_;
  const bool came = s.wait(timeout_s);
  int width = 0, height = 0;
  glfwGetFramebufferSize(s.window, &width, &height);
  const float scale = scale_for(width, height);
  if (width > 0 && scale != s.theme.scale) {
    s.build(scale);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    s.drawing.forget();
  }
  s.deal_input();
  ImGui_ImplOpenGL3_NewFrame();
  const ImVec2 mouse_before = ImGui::GetIO().MousePos;
  ImGui_ImplGlfw_NewFrame();
  s.place_mouse(mouse_before);
  ImGui::NewFrame();
  // A field takes every key but the one that means nothing in a line of text: the pedal for the way back,
  // which must not be dead in a field that was opened by a slip.
  if (ImGui::GetIO().WantTextInput)
    std::erase_if(s.keys, [](const KeyPress& press) { return press.key != GLFW_KEY_PAGE_UP; });
  return came;
}

void GraphicsWindow::draw_frame() {
  ImGui::Render();
  state_->drawing.draw();
}

void GraphicsWindow::show_frame(bool pictures_are_late) {
  state_->drawing.show();
  state_->pace.drawn(state_->begun_s, glfwGetTime(), pictures_are_late);
}

long GraphicsWindow::drawn_px() const { return state_->drawing.drawn_px(); }

bool GraphicsWindow::can_cover_two() { return across_two(connected_screens()).has_value(); }
bool GraphicsWindow::covers_two() const { return state_->on_one_screen.has_value(); }

void GraphicsWindow::cover_two(bool covers) {
  State& s = *state_;
  if (covers == covers_two()) return;
  if (!covers) {
    glfwSetWindowAttrib(s.window, GLFW_DECORATED, GLFW_TRUE);
    put_window(s.window, *std::exchange(s.on_one_screen, std::nullopt));
    glfwMaximizeWindow(s.window);
    return;
  }
  const std::optional<ScreenArea> area = across_two(connected_screens());
  if (!area) return;
  glfwRestoreWindow(s.window);  // a maximized one is kept on its screen
  ScreenArea before;
  glfwGetWindowPos(s.window, &before.x, &before.y);
  glfwGetWindowSize(s.window, &before.width, &before.height);
  s.on_one_screen = before;
  glfwSetWindowAttrib(s.window, GLFW_DECORATED, GLFW_FALSE);
  put_window(s.window, *area);
}

void GraphicsWindow::await_text_field() {
  constexpr int kFramesToFocus = 6;  // ImGui takes two
  if (!ImGui::GetIO().WantTextInput) state_->frames_to_hold = kFramesToFocus;
}

const std::vector<KeyPress>& GraphicsWindow::keys() const { return state_->keys; }
const std::vector<int>& GraphicsWindow::released_keys() const { return state_->released; }
void GraphicsWindow::keep_open() { glfwSetWindowShouldClose(state_->window, GLFW_FALSE); }
std::vector<std::filesystem::path> GraphicsWindow::take_dropped() {
  return std::exchange(state_->dropped, {});
}
bool GraphicsWindow::should_close() const { return glfwWindowShouldClose(state_->window) == GLFW_TRUE; }
void GraphicsWindow::make_current() const { glfwMakeContextCurrent(state_->window); }
Screen GraphicsWindow::screen() const { return state_->screen(); }
const Theme& GraphicsWindow::theme() const { return state_->theme; }
double GraphicsWindow::now_s() { return glfwGetTime(); }
bool GraphicsWindow::draws_by_processor() const { return state_->by_processor; }
void GraphicsWindow::wake() { glfwPostEmptyEvent(); }
void GraphicsWindow::wake_by_hand() {
  woken_by_hand = true;
  glfwPostEmptyEvent();
}

}  // namespace arthronaut::widgets
