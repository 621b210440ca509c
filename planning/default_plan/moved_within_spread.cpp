#include <utility>

#include "planning/default_plan/default_plan.h"
#include "planning/files/format.h"

namespace arthronaut::default_plan {

DefaultTunnel moved_within_spread(DefaultTunnel made) {
  if (!made.is_usable() || !made.other_entry) return made;
  const OtherEntry there = *std::exchange(made.other_entry, std::nullopt);
  made.off_norm_mm = (there.entry_mm - made.tunnel.entry_mm).norm();
  made.tunnel.entry_mm = there.entry_mm;
  made.place = files::format("%.1f mm off the norm's place, within its spread, where it %s", made.off_norm_mm,
                             there.passes() ? "passes" : "can be drilled");
  for (const tunnels::PlanCheck& check : std::exchange(made.failed, there.failed))
    made.place += files::format("; at the norm's place %s: %s", check.name.c_str(), check.text.c_str());
  return made;
}

}  // namespace arthronaut::default_plan
