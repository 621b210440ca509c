// Case folders as small as they can be: case.json and what is asked for, without meshes.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "planning/files/private_folder.h"

namespace arthronaut::test {

struct MadeCase {
  std::string name = "Knee 1", side = "left", created_utc = "2026-01-31T12:00:00Z";
  bool is_planned = true;
};

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline void make_case(const std::filesystem::path& folder, const MadeCase& made = {}) {
  files::create_private_folder(folder);
  write_text(folder / "case.json",
             R"({"format": "arthronaut.case", "version": 1, "name": ")" + made.name + R"(", "side": ")" +
                 made.side + R"(", "created_utc": ")" + made.created_utc +
                 R"(", "bones": [{"kind": "femur", "source": ""}, {"kind": "tibia", "source": ""}]})");
  if (made.is_planned)
    write_text(
        folder / "plan.json",
        R"({"format": "arthronaut.plan", "version": 1, "tunnels": [{"bone": "femur", "entry_mm": [0, 0, 0],
                   "direction": [0, 0, 1], "diameter_mm": 9}]})");
}

}  // namespace arthronaut::test
