#include "app/navigate/shown_scene.h"

#include <utility>

namespace arthronaut::navigate {

namespace {

// Strokes have become longer and what runs along with them has followed: no other registration, nothing taken
// back.
bool has_only_grown(const operation::RegistrationState& now, const operation::RegistrationState& before) {
  if (now.point_count < before.point_count || now.excluded != before.excluded) return false;
  if (now.change_count != before.change_count || now.history != before.history ||
      now.entry_in_force != before.entry_in_force || now.in_force.standing != before.in_force.standing)
    return false;
  if (now.online == nullptr || before.online == nullptr) return now.online == before.online;
  return now.online->state == before.online->state &&
         now.online->registration.has_pose == before.online->registration.has_pose;
}

bool has_only_moved(const ShownScene& now, const ShownScene& before) {
  if ((now.tip_frame >= 0) != (before.tip_frame >= 0) || (now.guide_frame >= 0) != (before.guide_frame >= 0))
    return false;
  ShownScene elsewhere = now;
  elsewhere.tip_frame = before.tip_frame;
  elsewhere.guide_frame = before.guide_frame;
  if (now.registration != nullptr && before.registration != nullptr &&
      has_only_grown(*now.registration, *before.registration))
    elsewhere.registration = before.registration;
  return elsewhere == before;
}

}  // namespace

bool SceneRenewal::is_due(ShownScene wanted, double now_s, bool by_processor) {
  if (wanted == shown_) return false;
  if (!has_only_moved(wanted, shown_))
    pace_.drawn(now_s);
  else if (!pace_.is_due(now_s, by_processor))
    return false;
  shown_ = std::move(wanted);
  return true;
}

}  // namespace arthronaut::navigate
