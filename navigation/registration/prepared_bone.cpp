#include "navigation/registration/prepared_bone.h"

namespace arthronaut::registration {

PreparedBone::PreparedBone(const geometry::TriangleMesh& mesh) : data_(std::make_unique<const Data>(mesh)) {}
PreparedBone::~PreparedBone() = default;
PreparedBone::PreparedBone(PreparedBone&&) noexcept = default;
PreparedBone& PreparedBone::operator=(PreparedBone&&) noexcept = default;

}  // namespace arthronaut::registration
