#include "planning/import/shared_voxels.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "planning/geometry/error.h"

namespace arthronaut::importing {

namespace {

// The count stands before the voxels, on a page of its own: what is mapped begins at a page.
constexpr std::uint64_t kFirstByte = 4096;

std::uint64_t size_of(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size < 0) return 0;
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

int create_shared_memory(std::uint64_t most_bytes) {
  const int descriptor = ::memfd_create("arthronaut-import", MFD_CLOEXEC);
  if (descriptor >= 0 && ::ftruncate(descriptor, static_cast<off_t>(kFirstByte + most_bytes)) == 0)
    return descriptor;
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) ::close(descriptor);
  throw IoError("no memory for the import to hand over its images: " + reason);
}

bool put_voxels(int descriptor, std::string_view voxels) {
  if (size_of(descriptor) < kFirstByte + voxels.size()) return false;
  const std::uint64_t count = voxels.size();
  void* memory = ::mmap(nullptr, kFirstByte + voxels.size(), PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) return false;
  std::memcpy(memory, &count, sizeof(count));
  if (!voxels.empty()) std::memcpy(static_cast<char*>(memory) + kFirstByte, voxels.data(), voxels.size());
  ::munmap(memory, kFirstByte + voxels.size());
  return true;
}

images::EncodedVolume taken_voxels(int descriptor) {
  images::EncodedVolume taken;
  std::uint64_t count = 0;
  const std::uint64_t size = size_of(descriptor);
  if (::pread(descriptor, &count, sizeof(count), 0) != sizeof(count) || count == 0 || size < kFirstByte ||
      count > size - kFirstByte)
    return taken;
  const std::uint64_t length = kFirstByte + count;
  void* memory = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) return taken;
  taken.owner = std::shared_ptr<const void>(
      memory, [length](const void* held) { ::munmap(const_cast<void*>(held), length); });
  taken.voxels = {static_cast<const char*>(memory) + kFirstByte, count};
  return taken;
}

}  // namespace arthronaut::importing
