#include <utility>

#include "planning/default_plan/default_plan.h"
#include "planning/files/format.h"

namespace arthronaut::default_plan {

DefaultTunnel moved_to_passing(DefaultTunnel made) {
  if (!made.is_usable() || !made.passing_entry_mm) return made;
  made.off_norm_mm = (*made.passing_entry_mm - made.tunnel.entry_mm).norm();
  made.tunnel.entry_mm = *std::exchange(made.passing_entry_mm, std::nullopt);
  made.place =
      files::format("%.1f mm off the norm's place, within its spread, where it passes", made.off_norm_mm);
  for (const tunnels::PlanCheck& check : std::exchange(made.failed, {}))
    made.place += files::format("; at the norm's place %s: %s", check.name.c_str(), check.text.c_str());
  return made;
}

}  // namespace arthronaut::default_plan
