#include "navigation/registration/bone/surface_index.h"

#include "navigation/registration/bone/byte_stream.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::registration {

namespace {

// To be raised whenever the same mesh would be made ready otherwise than before, or laid out otherwise in the
// file.
constexpr std::uint64_t kVersion = 1;

std::uint64_t key_of(const geometry::TriangleMesh& mesh) {
  ByteWriter contents;
  contents.write(kVersion);
  contents.write(DistanceFieldOptions{});
  contents.write(PairTableOptions{});
  for (const Eigen::Vector3d& vertex : mesh.vertices_mm) {
    for (int axis = 0; axis < 3; ++axis) contents.write(vertex[axis]);
  }
  contents.write(mesh.triangles);
  return hash_of(contents.bytes());
}

// Key, checksum of what follows, field, pairs.
std::unique_ptr<const SurfaceIndex::Data> read_cache(const std::filesystem::path& file,
                                                     const geometry::TriangleMesh& mesh, std::uint64_t key) {
  if (std::error_code ignored; !std::filesystem::exists(file, ignored)) return nullptr;
  try {
    const std::string contents = files::read_text(file);
    ByteReader bytes(contents);
    if (bytes.read<std::uint64_t>() != key) return nullptr;
    const auto checksum = bytes.read<std::uint64_t>();
    if (hash_of(bytes.rest()) != checksum) return nullptr;
    DistanceField field(bytes);
    PairTable pairs(bytes);
    return std::make_unique<const SurfaceIndex::Data>(mesh, std::move(field), std::move(pairs));
  } catch (const IoError&) {
    return nullptr;
  } catch (const InvalidInput&) {
    return nullptr;
  }
}

void write_cache(const std::filesystem::path& file, const SurfaceIndex::Data& data, std::uint64_t key) {
  ByteWriter payload;
  data.field.write_to(payload);
  data.pairs.write_to(payload);
  ByteWriter head;
  head.write(key);
  head.write(hash_of(payload.bytes()));
  std::error_code ignored;  // what cannot be made shows when the file is written
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    files::write_atomically(file, head.bytes() + payload.bytes());
  } catch (const IoError&) {
    // A case on a medium that can only be read is prepared each time.
  }
}

}  // namespace

SurfaceIndex::SurfaceIndex(const geometry::TriangleMesh& mesh) : data_(std::make_unique<const Data>(mesh)) {}

SurfaceIndex::SurfaceIndex(const geometry::TriangleMesh& mesh, const std::filesystem::path& cache_file) {
  const std::uint64_t key = key_of(mesh);
  data_ = read_cache(cache_file, mesh, key);
  if (data_ != nullptr) return;
  data_ = std::make_unique<const Data>(mesh);
  write_cache(cache_file, *data_, key);
}

SurfaceIndex::~SurfaceIndex() = default;
SurfaceIndex::SurfaceIndex(SurfaceIndex&&) noexcept = default;
SurfaceIndex& SurfaceIndex::operator=(SurfaceIndex&&) noexcept = default;

}  // namespace arthronaut::registration
