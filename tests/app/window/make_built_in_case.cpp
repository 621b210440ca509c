// Makes the built-in knee as a case whose bones are ready to be registered, once for all tests of the window:
// what each of them would compute for three seconds.
//   make_built_in_case FOLDER
#include <filesystem>
#include <iostream>

#include "navigation/registration/registration.h"
#include "planning/cases/case.h"
#include "planning/phantom/phantom_case.h"

int main(int count, char** arguments) {
  using namespace arthronaut;
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  try {
    std::filesystem::remove_all(folder);
    cases::save_case(folder, phantom::case_of(phantom::make_phantom_knee(), "Phantom knee"));
    for (const auto& [kind, bone] : cases::load_case(folder).bones)
      const registration::SurfaceIndex index(bone.mesh, cases::surface_index_file(folder, kind));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
