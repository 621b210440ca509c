// The smallest program that an ImportProcess can start.
#include <cstring>

#include "planning/import/import_child.h"

int main(int argc, char** argv) {
  using namespace arthronaut::importing;
  return argc == 2 && std::strcmp(argv[1], kImportChildWord) == 0 ? run_import_child() : 2;
}
