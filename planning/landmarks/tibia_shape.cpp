#include "planning/landmarks/tibia_shape.h"
namespace arthronaut::landmarks {
Proposal propose_tibia(const geometry::TriangleMesh&, const ProposalOptions&) { return {}; }
}
