// Files as an interrupted copy leaves them.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace arthronaut::sources {

// The first `share` of a file.
inline void copy_beginning(const std::filesystem::path& from, const std::filesystem::path& to, double share) {
  std::ifstream in(from, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::ofstream out(to, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(share * static_cast<double>(bytes.size())));
}

}  // namespace arthronaut::sources
