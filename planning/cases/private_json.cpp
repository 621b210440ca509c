#include "planning/cases/private_json.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace fs = std::filesystem;

void write_private_json(const fs::path& file, const nlohmann::ordered_json& document) {
  // What is no UTF-8 must not stop the import.
  const std::string text =
      document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  files::write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    // Before the first byte is in it.
    std::error_code error;
    fs::permissions(temporary, fs::perms::owner_read | fs::perms::owner_write, error);
    if (!stream || error) throw IoError(temporary, "cannot create");
    stream << text << std::flush;
    if (!stream) throw IoError(temporary, "cannot write");
  });
}

}  // namespace arthronaut::cases
