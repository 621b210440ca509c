// Where exercises may be done: never in a case that is somebody's.
#pragma once

#include <filesystem>
#include <string>

namespace arthronaut::open_case {

// Why no exercise may be done in this case, by what it holds: a session that is no simulation (or of which
// nobody can tell), or the camera.json of a real scope. A sentence for the user. Empty: one may. An operation
// on the simulator that was left in the middle does not stand against it: exercises are passed over where
// something is resumed. A folder that is empty or not there holds nothing. Throws IoError.
[[nodiscard]] std::string refusal_to_train(const std::filesystem::path& case_folder);

}  // namespace arthronaut::open_case
