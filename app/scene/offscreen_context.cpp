#include "app/scene/offscreen_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <string>

#include "planning/geometry/error.h"

// Debian's GLEW was built for GLX: without an X display its glewInit loads every entry point and then reports
// GLEW_ERROR_NO_GLX_DISPLAY (4), which VTK takes for a failure and logs for each frame. This definition
// stands before the library's and takes that one answer for success.
extern "C" unsigned int glewInit() {
  using Init = unsigned int (*)();
  static const auto init = reinterpret_cast<Init>(dlsym(RTLD_NEXT, "glewInit"));
  constexpr unsigned int kNoGlxDisplay = 4;
  const unsigned int result = init != nullptr ? init() : 1;
  return result == kNoGlxDisplay ? 0 : result;
}

namespace arthronaut::scene {

struct OffscreenContext::State {
  EGLDisplay display = EGL_NO_DISPLAY, previous_display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT, previous_context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE, previous_draw = EGL_NO_SURFACE, previous_read = EGL_NO_SURFACE;
  EGLenum previous_api = EGL_OPENGL_ES_API;
};

namespace {

[[noreturn]] void fail(const char* step) {
  throw DeviceError(std::string("no off-screen OpenGL: ") + step + " failed (EGL error " +
                    std::to_string(eglGetError()) + ")");
}

EGLDisplay open_display() {
  const auto get_platform_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  EGLDisplay display = EGL_NO_DISPLAY;
  if (get_platform_display != nullptr)
    display = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
  display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) fail("opening a display");
  return display;
}

}  // namespace

OffscreenContext::OffscreenContext() : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.previous_api = eglQueryAPI();
  s.previous_display = eglGetCurrentDisplay();
  s.previous_context = eglGetCurrentContext();
  s.previous_draw = eglGetCurrentSurface(EGL_DRAW);
  s.previous_read = eglGetCurrentSurface(EGL_READ);
  s.display = open_display();
  if (!eglBindAPI(EGL_OPENGL_API)) fail("choosing OpenGL");
  constexpr EGLint kConfig[] = {EGL_SURFACE_TYPE,
                                EGL_PBUFFER_BIT,
                                EGL_RENDERABLE_TYPE,
                                EGL_OPENGL_BIT,
                                EGL_RED_SIZE,
                                8,
                                EGL_GREEN_SIZE,
                                8,
                                EGL_BLUE_SIZE,
                                8,
                                EGL_DEPTH_SIZE,
                                24,
                                EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(s.display, kConfig, &config, 1, &count) || count < 1) fail("finding a pixel format");
  constexpr EGLint kSurface[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
  s.surface = eglCreatePbufferSurface(s.display, config, kSurface);
  if (s.surface == EGL_NO_SURFACE) fail("making a surface");
  constexpr EGLint kContext[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
  s.context = eglCreateContext(s.display, config, EGL_NO_CONTEXT, kContext);
  if (s.context == EGL_NO_CONTEXT) {
    eglDestroySurface(s.display, s.surface);
    fail("making an OpenGL 3.3 context");
  }
  if (!eglMakeCurrent(s.display, s.surface, s.surface, s.context)) {
    eglDestroyContext(s.display, s.context);
    eglDestroySurface(s.display, s.surface);
    fail("making the context current");
  }
}

OffscreenContext::~OffscreenContext() {
  const State& s = *state_;
  eglMakeCurrent(s.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(s.display, s.context);
  eglDestroySurface(s.display, s.surface);
  // The display is shared by the process and stays open: another thread may be drawing on it.
  if (s.previous_api != EGL_NONE) eglBindAPI(s.previous_api);
  if (s.previous_context != EGL_NO_CONTEXT)
    eglMakeCurrent(s.previous_display, s.previous_draw, s.previous_read, s.previous_context);
}

void OffscreenContext::make_current() const {
  eglMakeCurrent(state_->display, state_->surface, state_->surface, state_->context);
}

}  // namespace arthronaut::scene
