#include "tests/fuzzing/reader.h"
#include "tests/navigation/openigtlink/igtl_promises.h"

namespace arthronaut::fuzzing {

// What comes over the network names no file and throws nothing: what is wrong goes to its listener.
std::vector<Reader> wire_readers() {
  return {{"igtl", "OpenIGTLink",
           [](const std::filesystem::path&) {
             std::map<std::string, std::string> seeds;
             for (const auto& [name, message] : test::igtl_examples())
               seeds.emplace(name, std::string(message.begin(), message.end()));
             return seeds;
           },
           [](const std::filesystem::path&, std::string_view bytes) {
             test::Bytes stream(bytes.begin(), bytes.end());
             std::string broken = test::broken_promise(stream);
             test::seal_all(stream);
             return broken.empty() ? test::broken_promise(stream) : broken;
           }}};
}

}  // namespace arthronaut::fuzzing
