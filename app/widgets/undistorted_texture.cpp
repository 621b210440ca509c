#include "app/widgets/undistorted_texture.h"

#include <GL/glew.h>

#include <array>
#include <optional>

namespace arthronaut::widgets {

namespace {

// One triangle that covers the square; `view` runs from (-1, -1) in the texture's first row.
constexpr const char* kVertexShader = R"(#version 330 core
out vec2 view;
void main() {
  view = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(view, 0.0, 1.0);
})";

// Textures count pixels from the edge of the first one, the camera model from its middle.
constexpr const char* kFragmentShader = R"(#version 330 core
in vec2 view;
out vec4 color;
uniform sampler2D video, table;
uniform vec2 image_size, principal_point, circle_center, held_at, held_size;
uniform float circle_radius;
void main() {
  vec2 nodes = vec2(textureSize(table, 0));
  vec2 raw = principal_point + texture(table, ((0.5 * view + 0.5) * (nodes - 1.0) + 0.5) / nodes).rg;
  bool is_seen = distance(raw, circle_center) <= circle_radius && all(greaterThanEqual(raw, vec2(-0.5))) &&
                 all(lessThanEqual(raw, image_size - 0.5));
  color = is_seen ? vec4(texture(video, (raw + 0.5 - held_at) / held_size).rgb, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
})";

// 0 when the machine does not take it.
GLuint compiled(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint is_good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
  if (is_good == GL_TRUE) return shader;
  glDeleteShader(shader);
  return 0;
}

GLuint linked_program() {
  const GLuint vertex = compiled(GL_VERTEX_SHADER, kVertexShader);
  const GLuint fragment = compiled(GL_FRAGMENT_SHADER, kFragmentShader);
  GLuint program = 0;
  if (vertex != 0 && fragment != 0) {
    program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    GLint is_good = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &is_good);
    if (is_good != GL_TRUE) {
      glDeleteProgram(program);
      program = 0;
    }
  }
  glDeleteShader(vertex);  // the program keeps them; 0 is ignored
  glDeleteShader(fragment);
  return program;
}

GLuint new_texture() {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  return texture;
}

void set_vector(GLuint program, const char* name, const Eigen::Vector2d& value) {
  glUniform2f(glGetUniformLocation(program, name), static_cast<float>(value.x()),
              static_cast<float>(value.y()));
}

// What drawing into a texture changes, put back when it goes out of scope.
class KeptState {
 public:
  KeptState() {
    for (std::size_t i = 0; i < kSwitches.size(); ++i) {
      was_on_[i] = glIsEnabled(kSwitches[i]);
      glDisable(kSwitches[i]);
    }
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_VIEWPORT, viewport_.data());
    glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertices_);
    glGetIntegerv(GL_ACTIVE_TEXTURE, &unit_);
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
      glGetIntegerv(GL_TEXTURE_BINDING_2D, &textures_[i]);
    }
  }
  ~KeptState() {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
      glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(textures_[i]));
    }
    glActiveTexture(static_cast<GLenum>(unit_));
    glBindVertexArray(static_cast<GLuint>(vertices_));
    glUseProgram(static_cast<GLuint>(program_));
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    for (std::size_t i = 0; i < kSwitches.size(); ++i)
      if (was_on_[i] == GL_TRUE) glEnable(kSwitches[i]);
  }
  KeptState(const KeptState&) = delete;
  KeptState& operator=(const KeptState&) = delete;

 private:
  static constexpr std::array<GLenum, 4> kSwitches{GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_CULL_FACE};
  std::array<GLboolean, kSwitches.size()> was_on_{};
  std::array<GLint, 4> viewport_{};
  std::array<GLint, 2> textures_{};
  GLint framebuffer_ = 0, program_ = 0, vertices_ = 0, unit_ = 0;
};

}  // namespace

UndistortedTexture::~UndistortedTexture() {
  // A context that was never used must not be asked: tests have none.
  for (const GLuint texture : {texture_, table_})
    if (texture != 0) glDeleteTextures(1, &texture);
  if (framebuffer_ != 0) glDeleteFramebuffers(1, &framebuffer_);
  if (vertices_ != 0) glDeleteVertexArrays(1, &vertices_);
  if (program_ != 0) glDeleteProgram(program_);
}

void UndistortedTexture::set_up() {
  if (texture_ != 0) return;
  texture_ = new_texture();
  if (!uses_gpu_) return;
  glGenFramebuffers(1, &framebuffer_);
  glGenVertexArrays(1, &vertices_);  // core profiles draw nothing without one
  table_ = new_texture();
  program_ = linked_program();
}

void UndistortedTexture::upload_table() {
  constexpr int kNodes = camera::UndistortedView::kNodes;
  glBindTexture(GL_TEXTURE_2D, table_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, kNodes, kNodes, 0, GL_RG, GL_FLOAT, view_->table_px().data());
}

void UndistortedTexture::resize(int size_px) {
  size_px_ = size_px;
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size_px, size_px, 0, GL_BGR, GL_UNSIGNED_BYTE, nullptr);
  if (program_ == 0) return;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  glDeleteProgram(program_);  // from now on the CPU does it
  program_ = 0;
}

void UndistortedTexture::draw(const camera::FramePtr& frame, const VideoTexture& video,
                              const camera::CameraModel& camera, int size_px) {
  const bool fits = view_ != nullptr && view_->fits(camera);
  if (frame == nullptr || (frame == drawn_ && fits && size_px == size_px_)) return;
  // On the CPU a new frame touches no more than the bound texture, which draw_on_cpu() puts back.
  std::optional<KeptState> kept;
  if (program_ != 0 || texture_ == 0 || size_px != size_px_) kept.emplace();
  set_up();
  if (!fits) {
    view_ = std::make_shared<camera::UndistortedView>(camera);
    if (program_ != 0) upload_table();
  }
  if (size_px != size_px_) resize(size_px);
  drawn_ = frame;
  ++version_;
  if (program_ != 0)
    draw_on_gpu(video, camera);
  else
    draw_on_cpu(*frame, camera);
}

void UndistortedTexture::draw_on_gpu(const VideoTexture& video, const camera::CameraModel& camera) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, size_px_, size_px_);
  glUseProgram(program_);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, video.texture());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, table_);
  glUniform1i(glGetUniformLocation(program_, "video"), 0);
  glUniform1i(glGetUniformLocation(program_, "table"), 1);
  const camera::Boundary& boundary = camera.boundary();
  set_vector(program_, "image_size", {video.width(), video.height()});
  const Rect held = video.held();
  set_vector(program_, "held_at", {held.x, held.y});
  set_vector(program_, "held_size", {held.width, held.height});
  set_vector(program_, "principal_point", camera.principal_point_px());
  set_vector(program_, "circle_center", boundary.center_px);
  glUniform1f(glGetUniformLocation(program_, "circle_radius"),
              boundary.radius_px > 0 ? static_cast<float>(boundary.radius_px) : 1e9F);
  glBindVertexArray(vertices_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void UndistortedTexture::draw_on_cpu(const camera::Frame& frame, const camera::CameraModel& camera) {
  const std::vector<std::uint8_t>& bgr = picture_.draw(frame, camera, view_, size_px_);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_px_, size_px_, GL_BGR, GL_UNSIGNED_BYTE, bgr.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
}

}  // namespace arthronaut::widgets
