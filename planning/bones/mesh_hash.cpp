#include "planning/bones/mesh_hash.h"

#include <bit>
#include <span>

#include "planning/files/sha256.h"

namespace arthronaut::bones {

static_assert(std::endian::native == std::endian::little, "the hash is over little-endian numbers");

std::string mesh_sha256(const geometry::TriangleMesh& mesh) {
  files::Sha256 hash;
  hash.add(std::as_bytes(std::span(mesh.vertices_mm)));
  hash.add(std::as_bytes(std::span(mesh.triangles)));
  return hash.hex();
}

}  // namespace arthronaut::bones
