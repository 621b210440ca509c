#include "planning/cases/case_note.h"

#include <nlohmann/json.hpp>

#include "planning/cases/private_json.h"
#include "planning/files/json_document.h"
#include "planning/files/remove_file.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"

namespace arthronaut::cases {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view kNoteFormat = "arthronaut.note";
constexpr int kNoteVersion = 1;

}  // namespace

fs::path note_file(const fs::path& case_folder) { return case_folder / "note.json"; }

CaseNote load_note(const fs::path& case_folder) {
  const fs::path file = note_file(case_folder);
  if (!fs::exists(file)) return {};
  const auto root = files::read_json(file, kNoteFormat, kNoteVersion);
  return {root.text("text"), root.text("changed_utc")};
}

void save_note_over(const fs::path& case_folder, const std::string& text, const std::string& made_from) {
  if (!fs::exists(case_folder / "case.json")) throw InvalidInput(case_folder, "", "is not a case");
  const fs::path file = note_file(case_folder);
  if (load_note(case_folder).text != made_from)
    throw InvalidInput(file, "", "was changed meanwhile by another program; nothing was written");
  if (text == made_from) return;
  if (text.empty()) return files::remove_file(file);
  write_private_json(file, {{"format", kNoteFormat},
                            {"version", kNoteVersion},
                            {"text", text},
                            {"changed_utc", files::utc_now()}});
}

}  // namespace arthronaut::cases
