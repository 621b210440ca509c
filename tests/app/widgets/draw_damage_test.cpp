// What of the screen is drawn anew, held against a drawing of all of it: ImGui's lists are drawn here by a
// rasterizer of the test's own, in which order, place and clipping of every triangle can be told from the
// pixel.
#include "app/widgets/draw_damage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace arthronaut::widgets {
namespace {

constexpr int kWidth = 450, kHeight = 330;
const auto kPicture = reinterpret_cast<ImTextureID>(7);

using Screen = std::vector<std::uint64_t>;

double side(const ImVec2& a, const ImVec2& b, double x, double y) {
  return (static_cast<double>(b.x) - a.x) * (y - a.y) - (static_cast<double>(b.y) - a.y) * (x - a.x);
}

// As OpenGL does it: pixels whose middle lies in the triangle, within the scissors.
void draw_on(Screen& screen, const ImDrawData& data) {
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) {
        if (command.UserCallback != ImDrawCallback_ResetRenderState) command.UserCallback(&list, &command);
        continue;
      }
      const PixelArea clip = clip_of(command, kHeight);
      for (unsigned i = 0; i < command.ElemCount; i += 3) {
        const auto corner = [&](unsigned k) -> const ImDrawVert& {
          return list.VtxBuffer[static_cast<int>(command.VtxOffset) +
                                list.IdxBuffer[static_cast<int>(command.IdxOffset + i + k)]];
        };
        const ImVec2 a = corner(0).pos, b = corner(1).pos, c = corner(2).pos;
        const int left = static_cast<int>(std::min({a.x, b.x, c.x})) - 1,
                  right = static_cast<int>(std::max({a.x, b.x, c.x})) + 2,
                  top = static_cast<int>(std::min({a.y, b.y, c.y})) - 1,
                  bottom = static_cast<int>(std::max({a.y, b.y, c.y})) + 2;
        for (int y = std::max({clip.top, top, 0}); y < std::min({clip.bottom, bottom, kHeight}); ++y)
          for (int x = std::max({clip.left, left, 0}); x < std::min({clip.right, right, kWidth}); ++x) {
            const double p = side(a, b, x + 0.5, y + 0.5), q = side(b, c, x + 0.5, y + 0.5),
                         r = side(c, a, x + 0.5, y + 0.5);
            if (!((p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0))) continue;
            std::uint64_t& pixel = screen[static_cast<std::size_t>(y * kWidth + x)];
            pixel = pixel * 1099511628211ULL + corner(0).col + corner(1).col + corner(2).col;
          }
      }
    }
  }
}

class DrawDamageTest : public ::testing::Test {
 protected:
  DrawDamageTest() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {kWidth, kHeight};
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    io.Fonts->SetTexID(letters_);
  }
  ~DrawDamageTest() override { ImGui::DestroyContext(); }

  static ImDrawData& frame_of(const std::function<void(ImDrawList&)>& draw) {
    ImGui::NewFrame();
    draw(*ImGui::GetBackgroundDrawList());
    ImGui::Render();
    return *ImGui::GetDrawData();
  }
  // Without the row that is drawn in every frame.
  std::vector<PixelArea> changed(const std::function<void(ImDrawList&)>& draw) {
    std::vector<PixelArea> areas;
    for (const PixelArea& area : damage_.changed(frame_of(draw), letters_))
      if (area.right - area.left < kWidth || area.bottom - area.top > DrawDamage::kTile_px)
        areas.push_back(area);
    return areas;
  }

  const ImTextureID letters_ = reinterpret_cast<ImTextureID>(3);
  DrawDamage damage_;
};

TEST_F(DrawDamageTest, DrawsAllOfAScreenThatIsNotKnown) {
  const auto draw = [](ImDrawList& list) { list.AddRectFilled({10, 10}, {40, 40}, IM_COL32_WHITE); };
  const std::vector<PixelArea> all{{0, 0, kWidth, kHeight}};
  EXPECT_EQ(changed(draw), all);
  EXPECT_TRUE(changed(draw).empty());
  damage_.forget();
  EXPECT_EQ(changed(draw), all);
  ImGui::GetIO().DisplaySize.x = kWidth - 50;
  EXPECT_FALSE(changed(draw).empty());
}

TEST_F(DrawDamageTest, DrawsWhatMovesWhereItWasAndWhereItIs) {
  const auto at = [](float x) {
    return [x](ImDrawList& list) { list.AddRectFilled({x, 170}, {x + 20, 190}, IM_COL32_WHITE); };
  };
  (void)changed(at(50));
  const auto areas = changed(at(300));
  const auto holds = [&](int x, int y) {
    return std::any_of(areas.begin(), areas.end(), [&](const PixelArea& area) {
      return area.meets({x, y, x + 1, y + 1});
    });
  };
  EXPECT_TRUE(holds(50, 170) && holds(69, 189));
  EXPECT_TRUE(holds(300, 170) && holds(319, 189));
  EXPECT_FALSE(holds(180, 180));
  EXPECT_FALSE(holds(310, 60));
}

// A colour alone, and the order alone.
TEST_F(DrawDamageTest, SeesColourAndOrder) {
  const auto draw = [](ImU32 color, bool swaps) {
    return [color, swaps](ImDrawList& list) {
      const auto first = [&] { list.AddRectFilled({100, 170}, {140, 190}, IM_COL32(9, 9, 9, 255)); };
      if (!swaps) first();
      list.AddRectFilled({110, 170}, {130, 190}, color);
      if (swaps) first();
    };
  };
  (void)changed(draw(IM_COL32_WHITE, false));
  EXPECT_FALSE(changed(draw(IM_COL32(255, 255, 254, 255), false)).empty());
  EXPECT_TRUE(changed(draw(IM_COL32(255, 255, 254, 255), false)).empty());
  EXPECT_FALSE(changed(draw(IM_COL32(255, 255, 254, 255), true)).empty());
}

// What a texture holds cannot be seen: a picture that does not say so is drawn in every frame.
TEST_F(DrawDamageTest, Hazard3APictureStandsStillOnlyWhereItSaysSo) {
  const auto picture = [](std::uint64_t version) {
    return [version](ImDrawList& list) {
      if (version != 0) shows_version(list, version);
      list.AddImage(kPicture, {100, 100}, {200, 200});
      list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
    };
  };
  (void)changed(picture(0));
  EXPECT_FALSE(changed(picture(0)).empty());
  EXPECT_FALSE(changed(picture(0)).empty());
  (void)changed(picture(1));
  EXPECT_TRUE(changed(picture(1)).empty());
  EXPECT_FALSE(changed(picture(2)).empty());
  // The version is of the picture that follows and of no other.
  const auto two = [](ImDrawList& list) {
    shows_version(list, 2);
    list.AddImage(kPicture, {100, 100}, {200, 200});
    list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
    list.AddImage(kPicture, {300, 200}, {350, 250});
  };
  (void)changed(two);
  EXPECT_FALSE(changed(two).empty());
}

// Every tile is drawn within as many frames as there are rows, whatever is known of it.
TEST_F(DrawDamageTest, DrawsEveryRowAfterAWhile) {
  const auto draw = [](ImDrawList& list) { list.AddRectFilled({10, 10}, {40, 40}, IM_COL32_WHITE); };
  (void)changed(draw);
  std::vector<bool> rows(kHeight, false);
  for (int i = 0; i < (kHeight + DrawDamage::kTile_px - 1) / DrawDamage::kTile_px; ++i)
    for (const PixelArea& area : damage_.changed(frame_of(draw), letters_))
      if (area.left == 0 && area.right == kWidth)
        std::fill(rows.begin() + area.top, rows.begin() + area.bottom, true);
  EXPECT_TRUE(std::all_of(rows.begin(), rows.end(), [](bool is_drawn) { return is_drawn; }));
}

// Frames with shapes that come, go, move and change, some of them far over the edge, clipped anywhere.
TEST_F(DrawDamageTest, Hazard34DrawnInPartIsTheSameAsDrawnWhole) {
  std::mt19937 random(34);
  const auto number = [&](float from, float to) {
    return std::uniform_real_distribution<float>(from, to)(random);
  };
  struct Shape {
    int kind;
    ImVec2 at, size;
    ImU32 color;
    ImVec2 clip_from, clip_to;
  };
  const auto any_shape = [&] {
    return Shape{static_cast<int>(random() % 4),
                 {number(-60, kWidth), number(-60, kHeight)},
                 {number(1, 160), number(1, 160)},
                 static_cast<ImU32>(random()) | IM_COL32_A_MASK,
                 {number(-20, kWidth / 2), number(-20, kHeight / 2)},
                 {number(kWidth / 2, kWidth + 20), number(kHeight / 2, kHeight + 20)}};
  };
  std::vector<Shape> shapes(40);
  std::generate(shapes.begin(), shapes.end(), any_shape);
  const auto draw = [&](ImDrawList& list) {
    for (const Shape& s : shapes) {
      list.PushClipRect(s.clip_from, s.clip_to);
      const ImVec2 end{s.at.x + s.size.x, s.at.y + s.size.y};
      if (s.kind == 0) list.AddRectFilled(s.at, end, s.color, 6);
      if (s.kind == 1) list.AddCircle(s.at, s.size.x, s.color, 0, 3);
      if (s.kind == 2) list.AddLine(s.at, end, s.color, 2);
      if (s.kind == 3) list.AddText(s.at, s.color, "Offset 3.1 mm");
      list.PopClipRect();
    }
  };
  Screen kept(static_cast<std::size_t>(kWidth) * kHeight, 1);
  long drawn_px = 0;
  constexpr int kFrames = 60;
  for (int frame = 0; frame < kFrames; ++frame) {
    // From none to many at once: more areas than are allowed, too.
    for (unsigned i = 0, count = frame % 10 == 9 ? 30 : static_cast<unsigned>(frame) % 3; i < count; ++i)
      shapes[random() % shapes.size()] = any_shape();
    ImDrawData& data = frame_of(draw);
    Screen whole(kept.size(), 1);
    draw_on(whole, data);
    const auto areas = damage_.changed(data, letters_);
    ASSERT_LE(areas.size(), static_cast<std::size_t>(DrawDamage::kMostAreas));
    for (std::size_t i = 0; i < areas.size(); ++i) {
      drawn_px += areas[i].size();
      for (std::size_t j = i + 1; j < areas.size(); ++j) ASSERT_FALSE(areas[i].meets(areas[j])) << frame;
      for (int y = areas[i].top; y < areas[i].bottom; ++y)
        for (int x = areas[i].left; x < areas[i].right; ++x)
          kept[static_cast<std::size_t>(y * kWidth + x)] = 1;
    }
    keep_only(data, areas);
    draw_on(kept, data);
    ASSERT_EQ(std::mismatch(kept.begin(), kept.end(), whole.begin()).first - kept.begin(),
              static_cast<std::ptrdiff_t>(kept.size()))
        << "frame " << frame;
  }
  EXPECT_LT(drawn_px, kFrames * static_cast<long>(kWidth) * kHeight * 3 / 4);
}

// What an opaque picture covers needs no background, and nothing else of an area goes without.
TEST_F(DrawDamageTest, KnowsWhatAPictureCovers) {
  const auto draw = [](ImDrawList& list) {
    list.PushClipRect({50, 50}, {400, 200});
    shows_opaque(list, 4, [](const ImDrawList*, const ImDrawCmd*) {});
    list.AddImage(kPicture, {40.5F, 60.2F}, {300.7F, 210});
    list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
    list.AddImage(kPicture, {0, 0}, {400, 300});
    list.PopClipRect();
  };
  const PixelArea covered = opaque_area(frame_of(draw));
  EXPECT_EQ(covered, (PixelArea{50, 61, 300, 200}));
  const PixelArea area{32, 32, 320, 128};
  std::vector<PixelArea> rest = without(area, covered);
  long size = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    size += rest[i].size();
    EXPECT_FALSE(rest[i].meets(covered));
    for (std::size_t j = i + 1; j < rest.size(); ++j) EXPECT_FALSE(rest[i].meets(rest[j]));
  }
  EXPECT_EQ(size, area.size() - 250 * 67);
  EXPECT_EQ(without(area, {}), std::vector<PixelArea>{area});
  EXPECT_TRUE(without(covered, covered).empty());
  EXPECT_EQ(opaque_area(frame_of([](ImDrawList&) {})), PixelArea{});
}

// The screen is copied by a callback after all else was drawn: once, also where nothing changed.
TEST_F(DrawDamageTest, CallsACallbackThatIsNoPicturesOnce) {
  static int calls = 0;
  calls = 0;
  int content = 0;
  const auto draw = [&](ImDrawList& list) {
    list.AddRectFilled({10, 10}, {40, 40}, IM_COL32_WHITE);
    list.AddRectFilled({300, 200}, {340, 240}, IM_COL32_WHITE);
    list.AddCallback([](const ImDrawList*, const ImDrawCmd*) { ++calls; }, &content);
  };
  ImDrawData& data = frame_of(draw);
  const std::vector<PixelArea> two{{0, 0, 64, 64}, {288, 192, 352, 256}};
  keep_only(data, two);
  Screen screen(static_cast<std::size_t>(kWidth) * kHeight);
  draw_on(screen, data);
  EXPECT_EQ(calls, 1);
  ImDrawData& same = frame_of(draw);
  keep_only(same, {});
  draw_on(screen, same);
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace arthronaut::widgets
