// What somebody wrote about a case: note.json in its folder (format "arthronaut.note"), so that it goes
// wherever the case goes.
//
// Free text; a word that begins with # is a tag that the library's search finds as any other word. No export
// takes it along: what is written about a patient often names him.
#pragma once

#include <filesystem>
#include <string>

namespace arthronaut::cases {

struct CaseNote {
  std::string text;         // UTF-8, of any number of lines; empty: there is none
  std::string changed_utc;  // ISO 8601; empty without one
};

[[nodiscard]] std::filesystem::path note_file(const std::filesystem::path& case_folder);
// An empty one where there is no file. Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] CaseNote load_note(const std::filesystem::path& case_folder);
// Writes the text over the one that it was made from. Throws InvalidInput when the note on disk is another
// one by now (somebody else wrote it) or when the folder is no case; IoError. Nothing is written then.
// Atomic, the file is 0600; without a text it goes.
void save_note_over(const std::filesystem::path& case_folder, const std::string& text,
                    const std::string& made_from);

}  // namespace arthronaut::cases
