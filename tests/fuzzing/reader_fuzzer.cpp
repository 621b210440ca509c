// One reader under libFuzzer: whatever bytes it is given, it reads them or throws InvalidInput or IoError
// with one line that names the file. Anything else ends the program, and the bytes are kept.
//   reader_fuzzer --list
//   reader_fuzzer --reader=stl --seeds=FOLDER      writes what the mutations start from, and ends
//   reader_fuzzer --reader=stl -max_total_time=60 CORPUS SEEDS      libFuzzer's own options
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>

#include "planning/geometry/error.h"
#include "tests/fuzzing/reader.h"
#include "tests/temporary_folder.h"

namespace arthronaut::fuzzing {
namespace {

std::vector<Reader> all_readers() {
  std::vector<Reader> all;
  for (const auto& family :
       {mesh_readers(), volume_readers(), case_readers(), navigation_readers(), wire_readers()}) {
    all.insert(all.end(), family.begin(), family.end());
  }
  return all;
}

struct Chosen {
  Reader reader;
  test::TemporaryFolder folder;
};
std::optional<Chosen> chosen;  // libFuzzer calls functions, and gives them nothing to keep a state in

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", chosen ? chosen->reader.name.c_str() : "reader_fuzzer", what.c_str());
  std::abort();
}

void check_message(const std::string& message) {
  if (message.empty()) fail("refused without a word");
  if (message.find('\n') != std::string::npos) fail("a message of several lines: " + message);
  if (message.find(chosen->reader.file) == std::string::npos) {
    fail("a message that does not name " + chosen->reader.file + ": " + message);
  }
}

int write_seeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const test::TemporaryFolder workshop;
  for (const auto& [name, bytes] : chosen->reader.seeds(workshop.path())) {
    (void)put(folder, name, bytes);
    // A seed that is refused would let the fuzzer begin at the refusal.
    if (const std::string broken = chosen->reader.read(chosen->folder.path(), bytes); !broken.empty()) {
      fail(name + ": " + broken);
    }
  }
  return 0;
}

}  // namespace
}  // namespace arthronaut::fuzzing

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  using namespace arthronaut::fuzzing;
  std::string reader, seeds;
  for (int i = 1; i < *count; ++i) {
    const std::string argument = (*arguments)[i];
    if (argument == "--list") {
      for (const Reader& each : all_readers()) std::puts(each.name.c_str());
      std::exit(0);
    }
    if (argument.starts_with("--reader=")) reader = argument.substr(9);
    if (argument.starts_with("--seeds=")) seeds = argument.substr(8);
  }
  for (Reader& each : all_readers()) {
    if (each.name == reader) {
      chosen.emplace();
      chosen->reader = std::move(each);
    }
  }
  if (!chosen) fail("there is no reader '" + reader + "': see --list");
  if (!seeds.empty()) std::exit(write_seeds(seeds));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace arthronaut;
  using namespace arthronaut::fuzzing;
  try {
    const std::string broken =
        chosen->reader.read(chosen->folder.path(), {reinterpret_cast<const char*>(data), size});
    if (!broken.empty()) fail("took what breaks its promise: " + broken);
  } catch (const InvalidInput& error) {
    check_message(error.what());
  } catch (const IoError& error) {
    check_message(error.what());
  } catch (const std::exception& error) {
    fail(std::string("threw something else: ") + error.what());
  }
  return 0;
}
