#include "app/widgets/screen_drawing.h"

#include <GL/glew.h>
// GLEW stands before GLFW: both declare OpenGL.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>

#include <array>

#include "app/widgets/theme.h"

namespace arthronaut::widgets {

namespace {

void clear(const PixelArea& area, int height_px) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(area.left, height_px - area.bottom, area.right - area.left, area.bottom - area.top);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

ScreenDrawing::ScreenDrawing(GLFWwindow* window, bool by_processor) : window_(window) {
  if (!by_processor || glfwExtensionSupported("GLX_MESA_copy_sub_buffer") == GLFW_FALSE) return;
  const auto display = reinterpret_cast<void* (*)()>(glfwGetProcAddress("glXGetCurrentDisplay"));
  const auto drawable = reinterpret_cast<unsigned long (*)()>(glfwGetProcAddress("glXGetCurrentDrawable"));
  const auto copy_part = reinterpret_cast<CopyPart>(glfwGetProcAddress("glXCopySubBufferMESA"));
  if (display == nullptr || drawable == nullptr || copy_part == nullptr) return;
  display_ = display();
  drawable_ = drawable();
  if (display_ != nullptr && drawable_ != 0) copy_part_ = copy_part;
}

void ScreenDrawing::draw() {
  ImDrawData& data = *ImGui::GetDrawData();
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  // VTK leaves a framebuffer of its own bound.
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  const ImVec4 background = ImGui::ColorConvertU32ToFloat4(kBackground);
  glClearColor(background.x, background.y, background.z, 1);
  const PixelArea whole{0, 0, width, height};
  std::array<PixelArea, 1> all{whole};
  std::span<const PixelArea> areas = all;
  PixelArea covered;
  if (copy_part_ != nullptr && data.FramebufferScale.x == 1 && data.FramebufferScale.y == 1) {
    if (!(whole == known_)) forget();
    known_ = whole;
    if (frames_to_draw_whole_ > 0) {
      --frames_to_draw_whole_;
      damage_.forget();
    }
    areas = damage_.changed(data, ImGui::GetIO().Fonts->TexID);
    covered = opaque_area(data);
    keep_only(data, areas);
  }
  shown_ = areas.empty() ? PixelArea{} : areas.front();
  drawn_px_ = 0;
  glDisable(GL_SCISSOR_TEST);
  // All at once costs nothing, each part costs its pixels: where a picture will cover it there is no need.
  const bool is_whole = areas.size() == 1 && areas.front() == whole;
  if (is_whole) glClear(GL_COLOR_BUFFER_BIT);
  for (const PixelArea& area : areas) {
    shown_ = both_of(shown_, area);
    drawn_px_ += area.size();
    if (!is_whole)
      for (const PixelArea& part : without(area, covered)) clear(part, height);
  }
  glDisable(GL_SCISSOR_TEST);
  ImGui_ImplOpenGL3_RenderDrawData(&data);
}

void ScreenDrawing::show() {
  // Mesa looks for the window's size where buffers are swapped, and nowhere else: before, parts would be
  // copied from where they lay in a buffer of another height, which is nowhere on the screen.
  if (copy_part_ == nullptr || frames_to_draw_whole_ > 0) return glfwSwapBuffers(window_);
  if (shown_.size() == 0) return;
  // In one piece: what belongs together is seen together.
  copy_part_(display_, drawable_, shown_.left, known_.bottom - shown_.bottom, shown_.right - shown_.left,
             shown_.bottom - shown_.top);
}

}  // namespace arthronaut::widgets
