// The files of a case that lead to the patient. Inner header of cases.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace arthronaut::cases {

// Atomic; the file is 0600 from its first byte on, whatever the folder is. Bytes that are no UTF-8 (names in
// an old character set) are replaced. Throws IoError; what was there is then as before.
void write_private_json(const std::filesystem::path& file, const nlohmann::ordered_json& document);

}  // namespace arthronaut::cases
