#include "app/widgets/screen_picture.h"

#include <GL/glew.h>
#include <imgui.h>

namespace arthronaut::widgets {

namespace {

// Called by ImGui's renderer, after all else of the frame was drawn and before it is shown.
void read_screen(const ImDrawList*, const ImDrawCmd* command) {
  ScreenPicture& picture = *static_cast<ScreenPicture*>(command->UserCallbackData);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, picture.width, picture.height, GL_BGRA, GL_UNSIGNED_BYTE, picture.bgra.data());
}

}  // namespace

void copy_screen_into(ScreenPicture& picture, double now_s) {
  const ImGuiIO& io = ImGui::GetIO();
  picture.width = static_cast<int>(io.DisplaySize.x * io.DisplayFramebufferScale.x);
  picture.height = static_cast<int>(io.DisplaySize.y * io.DisplayFramebufferScale.y);
  picture.time_s = now_s;
  picture.bgra.resize(4 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  ImGui::GetForegroundDrawList()->AddCallback(read_screen, &picture);
}

}  // namespace arthronaut::widgets
