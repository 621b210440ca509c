// The tibia's landmarks from its shape. Inner header of landmarks; see propose.h for the way.
#pragma once

#include "planning/landmarks/propose.h"

namespace arthronaut::landmarks {

[[nodiscard]] Proposal propose_tibia(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                                     const ProposalOptions& options);

}  // namespace arthronaut::landmarks
