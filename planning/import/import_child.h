// The import's own process, from inside. It reads files from anywhere, and whatever they make of it is no
// harm to the workstation: it may take so much memory, write no file, and leaves no dump.
#pragma once

namespace arthronaut::importing {

// The word on the command line that makes a program such a process. A program that starts an ImportProcess or
// a SeriesProcess answers it with run_import_child(), before it does anything else.
inline constexpr const char* kImportChildWord = "import-child";

// Takes one request from `socket`, which ChildProcess has put on standard input, and answers it there. Ends
// the process at once when the other end is gone. Returns the exit code: 0 when it has answered, whatever the
// answer; 2 when nobody asked, as by a person who types the word.
[[nodiscard]] int run_import_child(int socket = 0);

}  // namespace arthronaut::importing
