// What a CT after the operation says of a tunnel that navigation measured: beside navigation's own numbers,
// which alone say what was followed and not what was drilled.
#pragma once

#include <string>

#include "app/widgets/controls.h"
#include "planning/postop/comparison.h"

namespace arthronaut::review {

struct CtWords {
  widgets::Severity severity = widgets::Severity::Quiet;  // Caution: not to be relied on
  std::string text;
};
// planned: what the tunnel was drilled by. What else of it is not known is no matter here: these words are of
// entry and direction.
[[nodiscard]] CtWords ct_in_words(const postop::Comparison& comparison, const tunnels::Tunnel& planned);

}  // namespace arthronaut::review
