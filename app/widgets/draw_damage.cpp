#include "app/widgets/draw_damage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace arthronaut::widgets {

namespace {

void set_up_nothing(const ImDrawList*, const ImDrawCmd*) {}

// Callbacks of pictures carry their version; they are known by a mark that no address has.
constexpr std::uint64_t kMark = 1, kOpaque = 2;
void* marked(std::uint64_t version, std::uint64_t mark) {
  return reinterpret_cast<void*>(version << 2 | mark);
}
bool is_of_picture(const ImDrawCmd& command) {
  return (reinterpret_cast<std::uintptr_t>(command.UserCallbackData) & kMark) != 0;
}
bool is_reset(const ImDrawCmd& command) { return command.UserCallback == ImDrawCallback_ResetRenderState; }

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  a = (a ^ b) * 0x9e3779b97f4a7c15ULL;
  return a ^ a >> 29;
}
template <typename T>
std::uint64_t bits_of(const T& value) {
  std::uint64_t bits = 0;
  static_assert(sizeof(T) <= sizeof(bits));
  std::memcpy(&bits, &value, sizeof(T));
  return bits;
}
std::uint64_t look_of(const ImDrawVert& vertex) {
  return mixed(mixed(bits_of(vertex.pos), bits_of(vertex.uv)), vertex.col);
}

// A margin of a pixel: which side of an edge a pixel falls on is the renderer's to say.
PixelArea around(const ImVec2& a, const ImVec2& b, const ImVec2& c) {
  // Far out of any screen is as good as just outside, and does not overflow.
  const auto whole = [](float value) { return static_cast<int>(std::clamp(value, -1e6F, 1e6F)); };
  return {whole(std::floor(std::min({a.x, b.x, c.x}))) - 1, whole(std::floor(std::min({a.y, b.y, c.y}))) - 1,
          whole(std::ceil(std::max({a.x, b.x, c.x}))) + 1, whole(std::ceil(std::max({a.y, b.y, c.y}))) + 1};
}
PixelArea common_of(const PixelArea& a, const PixelArea& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
          std::min(a.bottom, b.bottom)};
}
bool is_empty(const PixelArea& area) { return area.left >= area.right || area.top >= area.bottom; }

const ImDrawVert& vertex_of(const ImDrawList& list, const ImDrawCmd& command, unsigned index) {
  return list.VtxBuffer[static_cast<int>(command.VtxOffset) +
                        list.IdxBuffer[static_cast<int>(command.IdxOffset + index)]];
}

}  // namespace

void shows_version(ImDrawList& draw, std::uint64_t version) {
  draw.AddCallback(set_up_nothing, marked(version, kMark));
}
void shows_opaque(ImDrawList& draw, std::uint64_t version, PictureSetUp set_up) {
  draw.AddCallback(set_up, marked(version, kMark | kOpaque));
}

PixelArea both_of(const PixelArea& a, const PixelArea& b) {
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

PixelArea clip_of(const ImDrawCmd& command, int height_px) {
  const ImVec4& clip = command.ClipRect;
  const int left = static_cast<int>(clip.x), below = static_cast<int>(static_cast<float>(height_px) - clip.w);
  const int bottom = height_px - below;
  return {left, bottom - static_cast<int>(clip.w - clip.y), left + static_cast<int>(clip.z - clip.x), bottom};
}

std::span<const PixelArea> DrawDamage::changed(const ImDrawData& data, ImTextureID letters) {
  const int width = static_cast<int>(data.DisplaySize.x), height = static_cast<int>(data.DisplaySize.y);
  if (width != width_ || height != height_) forget();
  width_ = width;
  height_ = height;
  columns_ = (width + kTile_px - 1) / kTile_px;
  rows_ = (height + kTile_px - 1) / kTile_px;
  ++frame_;
  fold(data, letters);
  areas_.clear();
  if (tiles_.size() != folded_.size())
    areas_.push_back({0, 0, width, height});
  else
    find_areas();
  tiles_.swap(folded_);
  return areas_;
}

void DrawDamage::fold(const ImDrawData& data, ImTextureID letters) {
  folded_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  const PixelArea screen{0, 0, width_, height_};
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    std::uint64_t version = 0, set_up = 0;
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) {
        const bool of_picture = !is_reset(command) && is_of_picture(command);
        version = of_picture ? bits_of(command.UserCallbackData) : 0;
        set_up = of_picture ? bits_of(command.UserCallback) : 0;
        continue;
      }
      const PixelArea clip = common_of(clip_of(command, height_), screen);
      if (is_empty(clip)) continue;
      const bool is_known = command.GetTexID() == letters || version != 0;
      std::uint64_t look = mixed(bits_of(command.GetTexID()), is_known ? version : frame_);
      look = mixed(look, is_known ? set_up : kMark);
      look = mixed(mixed(look, bits_of(ImVec2(command.ClipRect.x, command.ClipRect.y))),
                   bits_of(ImVec2(command.ClipRect.z, command.ClipRect.w)));
      for (unsigned i = 0; i + 2 < command.ElemCount; i += 3)
        fold_triangle({&vertex_of(list, command, i), &vertex_of(list, command, i + 1),
                       &vertex_of(list, command, i + 2)},
                      clip, look);
    }
  }
}

void DrawDamage::fold_triangle(const ImDrawVert* const (&corners)[3], const PixelArea& clip,
                               std::uint64_t look) {
  const PixelArea area = common_of(around(corners[0]->pos, corners[1]->pos, corners[2]->pos), clip);
  if (is_empty(area)) return;
  for (const ImDrawVert* corner : corners) look = mixed(look, look_of(*corner));
  for (int row = area.top / kTile_px; row <= (area.bottom - 1) / kTile_px; ++row)
    for (int column = area.left / kTile_px; column <= (area.right - 1) / kTile_px; ++column) {
      std::uint64_t& tile = folded_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                    static_cast<std::size_t>(column)];
      tile = mixed(tile, look);
    }
}

void DrawDamage::find_areas() {
  row_drawn_anyway_ = (row_drawn_anyway_ + 1) % std::max(rows_, 1);
  for (int row = 0; row < rows_; ++row) {
    const std::size_t of_row = areas_.size();
    const int top = row * kTile_px, bottom = std::min(top + kTile_px, height_);
    for (int column = 0; column < columns_; ++column) {
      const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                            static_cast<std::size_t>(column);
      if (tiles_[i] == folded_[i] && row != row_drawn_anyway_) continue;
      const int left = column * kTile_px, right = std::min(left + kTile_px, width_);
      // A tile between two that change costs less than an area more.
      if (areas_.size() > of_row && left - areas_.back().right <= kTile_px)
        areas_.back().right = right;
      else
        areas_.push_back({left, top, right, bottom});
    }
    // What goes on as the row above is one area with it.
    std::size_t kept = of_row;
    for (std::size_t i = of_row; i < areas_.size(); ++i) {
      const auto end = areas_.begin() + static_cast<std::ptrdiff_t>(of_row);
      const auto above = std::find_if(areas_.begin(), end, [&](const PixelArea& area) {
        return area.bottom == top && area.left == areas_[i].left && area.right == areas_[i].right;
      });
      if (above != end)
        above->bottom = bottom;
      else
        areas_[kept++] = areas_[i];
    }
    areas_.resize(kept);
  }
  limit_areas();
}

// Each area costs, too: those are joined that add the least, until there are few; none may meet another.
void DrawDamage::limit_areas() {
  while (areas_.size() > static_cast<std::size_t>(kMostAreas)) {
    std::size_t first = 0, second = 1;
    long least = std::numeric_limits<long>::max();
    for (std::size_t i = 0; i < areas_.size(); ++i)
      for (std::size_t j = i + 1; j < areas_.size(); ++j) {
        const long added = both_of(areas_[i], areas_[j]).size() - areas_[i].size() - areas_[j].size();
        if (added >= least) continue;
        least = added;
        first = i;
        second = j;
      }
    PixelArea joined = both_of(areas_[first], areas_[second]);
    areas_.erase(areas_.begin() + static_cast<std::ptrdiff_t>(second));
    areas_.erase(areas_.begin() + static_cast<std::ptrdiff_t>(first));
    for (bool grows = true; grows;) {
      const auto met = std::find_if(areas_.begin(), areas_.end(),
                                    [&](const PixelArea& area) { return area.meets(joined); });
      grows = met != areas_.end();
      if (!grows) continue;
      joined = both_of(joined, *met);
      areas_.erase(met);
    }
    areas_.push_back(joined);
  }
}

PixelArea opaque_area(const ImDrawData& data) {
  PixelArea largest;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    bool is_opaque = false;
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) {
        is_opaque = !is_reset(command) && is_of_picture(command) &&
                    (bits_of(command.UserCallbackData) & kOpaque) != 0;
        continue;
      }
      if (!is_opaque || command.ElemCount != 6) continue;
      // ImGui's own order: the first and the third corner lie across from each other.
      const ImVec2 from = vertex_of(list, command, 0).pos, to = vertex_of(list, command, 2).pos;
      const PixelArea inside =
          common_of({static_cast<int>(std::ceil(from.x)), static_cast<int>(std::ceil(from.y)),
                     static_cast<int>(std::floor(to.x)), static_cast<int>(std::floor(to.y))},
                    clip_of(command, static_cast<int>(data.DisplaySize.y)));
      if (!is_empty(inside) && inside.size() > largest.size()) largest = inside;
    }
  }
  return largest;
}

std::vector<PixelArea> without(const PixelArea& area, const PixelArea& hole) {
  const PixelArea cut = common_of(area, hole);
  if (is_empty(cut)) return {area};
  std::vector<PixelArea> rest;
  for (const PixelArea& part : {PixelArea{area.left, area.top, area.right, cut.top},
                                PixelArea{area.left, cut.bottom, area.right, area.bottom},
                                PixelArea{area.left, cut.top, cut.left, cut.bottom},
                                PixelArea{cut.right, cut.top, area.right, cut.bottom}})
    if (!is_empty(part)) rest.push_back(part);
  return rest;
}

void keep_only(ImDrawData& data, std::span<const PixelArea> areas) {
  const int height = static_cast<int>(data.DisplaySize.y);
  // Where nothing changed, a callback that is no picture's is called all the same.
  constexpr PixelArea kNowhere{};
  if (areas.empty()) areas = {&kNowhere, 1};
  ImVector<ImDrawCmd> commands;
  ImVector<ImDrawIdx> indices;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    ImDrawList& list = *data.CmdLists[n];
    commands.resize(0);
    indices.resize(0);
    for (const PixelArea& area : areas) {
      const bool is_last = &area == &areas.back();
      for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback != nullptr) {
          if (is_last || is_reset(command) || is_of_picture(command)) commands.push_back(command);
          continue;
        }
        const PixelArea clip = common_of(clip_of(command, height), area);
        if (is_empty(clip)) continue;
        ImDrawCmd kept = command;
        kept.ClipRect = {static_cast<float>(clip.left), static_cast<float>(clip.top),
                         static_cast<float>(clip.right), static_cast<float>(clip.bottom)};
        kept.IdxOffset = static_cast<unsigned>(indices.Size);
        for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
          const PixelArea at = around(vertex_of(list, command, i).pos, vertex_of(list, command, i + 1).pos,
                                      vertex_of(list, command, i + 2).pos);
          if (!at.meets(clip)) continue;
          for (unsigned k = 0; k < 3; ++k)
            indices.push_back(list.IdxBuffer[static_cast<int>(command.IdxOffset + i + k)]);
        }
        kept.ElemCount = static_cast<unsigned>(indices.Size) - kept.IdxOffset;
        if (kept.ElemCount > 0) commands.push_back(kept);
      }
    }
    list.CmdBuffer.swap(commands);
    list.IdxBuffer.swap(indices);
  }
}

}  // namespace arthronaut::widgets
