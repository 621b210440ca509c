// The parts that screens are built of. A state is always said three times: by shape, by word and by colour.
#pragma once

#include <string>
#include <string_view>

#include "app/widgets/actions.h"
#include "app/widgets/layout.h"
#include "app/widgets/theme.h"
#include "app/widgets/widget_log.h"

namespace arthronaut::widgets {

// What every panel gets.
struct Ui {
  const Theme& theme;
  Actions& actions;
  WidgetLog& log;
  double now_s = 0;
  bool by_processor = false;  // the processor draws: what moves is drawn less often (MotionPace)
};

enum class Severity {
  Good,     // disc with a tick
  Caution,  // triangle with an exclamation mark
  Bad,      // square with a cross
  Quiet,    // hollow circle: nothing to say
};
[[nodiscard]] ImU32 color_of(Severity severity);

// A panel at a fixed place, with an optional title. Between begin and end the ImGui cursor is inside it.
void begin_panel(const Ui& ui, const char* name, const Rect& rect, std::string_view title = {});
void end_panel();

// A button for an action: its label, its key, greyed while it is not possible. Width 0: as wide as the label
// needs. What must be held fills while it is held, by the key or by the mouse.
void action_button(const Ui& ui, std::string_view action_id, float width = 0, float height = 0);
// How wide its label and key need it; 0 of no action.
[[nodiscard]] float action_button_width(const Ui& ui, std::string_view action_id);

void draw_sign(ImDrawList& draw, const ImVec2& center, float radius, Severity severity);
// Severity, name, and what there is to say; wraps.
void status_row(const Ui& ui, Severity severity, std::string_view name, std::string_view text);

// Text with digits of one width, so that a number that changes does not jitter. Returns the width drawn.
float draw_number(ImDrawList& draw, ImFont* font, const ImVec2& at, ImU32 color, std::string_view text);
[[nodiscard]] float number_width(ImFont* font, std::string_view text);

// A large number under its name: "Angle", "1.2", "° ± 0.4".
void number_block(const Ui& ui, const Rect& rect, std::string_view name, std::string_view value,
                  std::string_view unit, Severity severity);

void text_in(ImFont* font, ImU32 color, std::string_view text);  // wraps in the panel
void text_centered(const Ui& ui, const Rect& rect, ImFont* font, ImU32 color,
                   std::string_view text);  // wraps

// What a picture shows, in its upper left corner.
void caption(const Ui& ui, const Rect& picture, ImU32 color, std::string_view text);

// "1.2", "-0.4"; a minus sign of the width of the plus sign; never "-0.0".
[[nodiscard]] std::string fixed(double value, int decimals);
// "± 0.4" of a predicted error; never less than "± 0.1": nobody should read a nought there.
[[nodiscard]] std::string plus_minus(double sigma);

}  // namespace arthronaut::widgets
