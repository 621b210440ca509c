#include "app/widgets/theme.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace arthronaut::widgets {

namespace {

using Paths = std::array<const char*, 4>;
constexpr Paths kRegular{
    "/usr/share/fonts/opentype/inter/Inter-Regular.otf", "/usr/share/fonts/truetype/inter/Inter-Regular.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};
constexpr Paths kSemiBold{"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                          "/usr/share/fonts/truetype/inter/Inter-SemiBold.ttf",
                          "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf",
                          "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf"};

// Latin with accents; dashes and the ellipsis; Greek sigma; arrows; the minus sign.
constexpr std::array<ImWchar, 11> kGlyphs{0x20,   0x17F,  0x2010, 0x2026, 0x3C3, 0x3C3,
                                          0x2190, 0x2193, 0x2212, 0x2212, 0};

// ImGui keeps the pointer to the glyphs until the atlas is built.
ImFont* add_font(ImFontAtlas& fonts, const Paths& paths, float size_px,
                 const ImWchar* glyphs = kGlyphs.data()) {
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  for (const char* path : paths)
    if (std::filesystem::exists(path)) return fonts.AddFontFromFileTTF(path, size_px, &config, glyphs);
  config.SizePixels = size_px;
  return fonts.AddFontDefault(&config);
}

constexpr double kArcminPerRad = 180 * 60 / 3.14159265358979323846;

ImVec4 rgba(ImU32 color) { return ImGui::ColorConvertU32ToFloat4(color); }

}  // namespace

ImU32 color_of(const scene::Color& color, float opacity) {
  return ImGui::ColorConvertFloat4ToU32({color.red, color.green, color.blue, opacity});
}

float scale_for(int width_px, int height_px) {
  const float fit = std::min(static_cast<float>(height_px) / 1080.F, static_cast<float>(width_px) / 1920.F);
  // In steps of a twelfth: a window dragged larger does not build fonts for every pixel.
  return std::clamp(std::round(fit * 12) / 12, 0.5F, 4.0F);
}

float afar_needed_px(const Screen& screen) {
  const double diagonal_px = std::hypot(screen.width_px, screen.height_px);
  const double diagonal_mm = screen.diagonal_mm > 0 ? screen.diagonal_mm : kUsualDiagonal_mm;
  const double capitals_mm = kAfarDistance_mm * std::tan(kAfar_arcmin / kArcminPerRad);
  return static_cast<float>(capitals_mm * diagonal_px / diagonal_mm) / kCapitalsOfSize;
}

float afar_px(const Screen& screen, float scale) {
  const float usual = kAfar_px * scale;
  return std::ceil(std::clamp(afar_needed_px(screen), 0.8F * usual, 1.2F * usual));
}

void build_style(float scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 0;
  style.ChildRounding = style.FrameRounding = style.PopupRounding = style.GrabRounding = 6;
  style.WindowPadding = {16, 14};
  style.FramePadding = {14, 9};
  style.ItemSpacing = {12, 10};
  style.ItemInnerSpacing = {8, 6};
  style.ScrollbarSize = 16;
  style.GrabMinSize = 20;
  style.WindowBorderSize = style.ChildBorderSize = style.PopupBorderSize = 1;
  style.ScaleAllSizes(scale);
  ImVec4* colors = style.Colors;
  colors[ImGuiCol_WindowBg] = rgba(kBackground);
  colors[ImGuiCol_ChildBg] = rgba(kPanel);
  colors[ImGuiCol_PopupBg] = rgba(kPanel);
  colors[ImGuiCol_Border] = rgba(kPanelEdge);
  colors[ImGuiCol_Text] = rgba(kText);
  colors[ImGuiCol_TextDisabled] = rgba(kQuietText);
  colors[ImGuiCol_Button] = rgba(IM_COL32(38, 47, 57, 255));
  colors[ImGuiCol_ButtonHovered] = rgba(IM_COL32(52, 66, 80, 255));
  colors[ImGuiCol_ButtonActive] = rgba(IM_COL32(66, 92, 116, 255));
  colors[ImGuiCol_FrameBg] = rgba(IM_COL32(32, 39, 47, 255));
  colors[ImGuiCol_FrameBgHovered] = colors[ImGuiCol_FrameBgActive] = rgba(IM_COL32(46, 57, 69, 255));
  colors[ImGuiCol_SliderGrab] = colors[ImGuiCol_SliderGrabActive] = colors[ImGuiCol_PlotHistogram] =
      rgba(kAccent);
  colors[ImGuiCol_Header] = rgba(IM_COL32(40, 66, 88, 255));
  colors[ImGuiCol_HeaderHovered] = colors[ImGuiCol_HeaderActive] = rgba(IM_COL32(50, 82, 108, 255));
  ImGui::GetStyle() = style;
}

Theme build_theme(ImFontAtlas& fonts, float scale, float afar_px) {
  fonts.Clear();
  Theme theme;
  theme.scale = scale;
  theme.body = add_font(fonts, kRegular, std::round(24 * scale));
  theme.strong = add_font(fonts, kSemiBold, std::round(24 * scale));
  theme.title = add_font(fonts, kSemiBold, std::round(34 * scale));
  static constexpr std::array<ImWchar, 9> kLetters{0x20,   0xFF,   0x2010, 0x2026, 0x2190,
                                                   0x2193, 0x2212, 0x2212, 0};
  theme.number = add_font(fonts, kSemiBold, std::round(64 * scale), kLetters.data());
  theme.afar = add_font(fonts, kSemiBold, afar_px, kLetters.data());
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
  return theme;
}

}  // namespace arthronaut::widgets
