#include "app/widgets/heartbeat.h"

#include <cmath>

namespace arthronaut::widgets {

void Heartbeat::beat(double now_s, bool matters) {
  place_ = (place_ + 1) % kPlaces;
  const double gap_s = last_s_ < 0 ? 0 : now_s - last_s_;
  // Starting an operation may take its time: what counts is whether one ran when the screen stopped.
  if (matters_ && gap_s > kStandstill_s) {
    stood_still_s_ = gap_s;
    told_until_s_ = now_s + kTold_s;
  } else if (now_s >= told_until_s_) {
    stood_still_s_ = 0;
  }
  last_s_ = now_s;
  matters_ = matters;
}

std::string Heartbeat::words() const {
  return stood_still_s_ > 0 ? "The screen stood still for " + fixed(stood_still_s_, 1) + " s" : "";
}

void draw_heartbeat(const Ui& ui, const Rect& area, const Heartbeat& heartbeat) {
  constexpr float kTurn = 6.2831853F;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ui.log.note("app.heartbeat", area.min(), area.max());
  const ImVec2 center = area.center();
  const float radius = area.height * 0.38F,
              angle = kTurn * static_cast<float>(heartbeat.place()) / Heartbeat::kPlaces;
  draw.AddCircle(center, radius, kPanelEdge, 32, ui.theme.px(4));
  draw.AddCircleFilled({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)},
                       area.height * 0.12F, heartbeat.stood_still_s() > 0 ? kBad : kText, 16);
}

}  // namespace arthronaut::widgets
