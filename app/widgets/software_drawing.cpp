#include "app/widgets/software_drawing.h"

#include <GL/glew.h>

#include <array>
#include <string_view>

namespace arthronaut::widgets {

bool draws_by_processor() {
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = name != nullptr ? name : "";
  constexpr std::array<std::string_view, 3> kByProcessor{"llvmpipe", "softpipe", "SWR"};
  for (const std::string_view one : kByProcessor)
    if (renderer.find(one) != std::string_view::npos) return true;
  return false;
}

}  // namespace arthronaut::widgets
