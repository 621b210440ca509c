// The readers of files that others made, and of what comes over the network, one by one, for a fuzzer: what
// each starts from and how it is called.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace arthronaut::fuzzing {

struct Reader {
  std::string name;  // of --reader
  std::string file;  // the name that every refusal must carry
  // Files that it reads without complaint, by name: what the mutations start from. Made in `folder`, which is
  // empty.
  std::function<std::map<std::string, std::string>(const std::filesystem::path& folder)> seeds;
  // Reads one file of these bytes. `folder` is the reader's own and stays from call to call, for those that
  // read from a disk. Returns what the reader promises of what it took and did not keep, empty when all
  // holds. Throws what the reader throws.
  std::function<std::string(const std::filesystem::path& folder, std::string_view bytes)> read;
};

[[nodiscard]] std::vector<Reader> mesh_readers();
[[nodiscard]] std::vector<Reader> volume_readers();
[[nodiscard]] std::vector<Reader> case_readers();
[[nodiscard]] std::vector<Reader> navigation_readers();
[[nodiscard]] std::vector<Reader> wire_readers();

// The file of the folder that holds these bytes now.
[[nodiscard]] std::filesystem::path put(const std::filesystem::path& folder, std::string_view name,
                                        std::string_view bytes);
// The bytes of a file that was just written.
[[nodiscard]] std::string taken(const std::filesystem::path& file);

}  // namespace arthronaut::fuzzing
