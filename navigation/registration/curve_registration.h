// The parts of register_curves that registering on the fly needs too.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "navigation/registration/bone/surface_index.h"
#include "navigation/registration/search/cartilage_offset.h"

namespace arthronaut::registration {

// Whose side's bone was touched, judged by how well its mirror image fits beside it.
enum class SideVerdict { Own, Unclear, Other };
[[nodiscard]] std::string_view reason_against(SideVerdict verdict);  // empty for Own

// What all searches with the same options share, made once.
struct SearchSetting {
  SearchSetting(const SurfaceIndex::Data& searched_bone, const RegistrationOptions& registration_options);

  // The noise model while the thickness of declared cartilage is not known yet.
  [[nodiscard]] NoiseModel start_noise() const;

  const SurfaceIndex::Data& bone;
  RegistrationOptions options;
  std::vector<bool>
      reachable;  // samples of the bone, by the planned entry; empty without one that is on the bone
  std::optional<CartilageMap> cartilage;  // of options.cartilage
};

struct SearchOutcome {
  RegistrationSummary summary;
  bool fits = false;        // the shape does, however well it is held
  bool fits_amply = false;  // by so much that no other shape could
  double cost = 1e9;        // of the pose, see RefinedPose
  double measurements = 0;  // independent ones that the points make
};

// Global search, refinement and verdict. max_rounds bounds the search where no pose leads clearly.
[[nodiscard]] SearchOutcome search_and_summarise(const SearchSetting& setting, const strokes::Curves& curves,
                                                 int max_rounds);

struct SideJudgement {
  SideVerdict verdict = SideVerdict::Own;
  double lead = 0;  // of the own side, in independent measurements' log likelihood
};
// found: on the bone itself. While more may be drawn the own side has to lead by more: it is asked again and
// again, and waiting costs little.
[[nodiscard]] SideJudgement judge_side(const SearchSetting& setting, const strokes::Curves& curves,
                                       const SearchOutcome& found, bool more_may_come = false);

}  // namespace arthronaut::registration
