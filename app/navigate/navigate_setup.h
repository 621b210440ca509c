// From a case to a source of an operation: which camera, which tools, which pictures.
#pragma once

#include <filesystem>
#include <string>

#include "app/case/plan_model.h"
#include "app/navigate/camera_choice.h"
#include "navigation/sources/device_turns.h"
#include "navigation/theatre/operation_run.h"

namespace arthronaut::navigate {

// Touch: the probe rests at the places that verify, without the strokes before.
enum class SimulatedPart { Scratch, Touch, Drill };

// Why the simulated operation can't aim at this tunnel of the case: no plan, no landmarks. Empty when it can.
[[nodiscard]] std::string missing_for_simulation(const open_case::PlanModel& model,
                                                 const tunnels::TunnelKey& key);
// Precondition: missing_for_simulation() is empty. The standard scope and the standard tools in saline,
// tracked with what Set up has adopted of them for this case. Throws IoError or InvalidInput when that is
// broken.
[[nodiscard]] theatre::TheatreSource simulated_setup(const open_case::PlanModel& model,
                                                     const tunnels::TunnelKey& key,
                                                     const std::filesystem::path& case_folder,
                                                     SimulatedPart part);

// A recorded video with the case's camera.json and tools.json. Throws IoError or InvalidInput when those are
// missing or broken: the message says which.
[[nodiscard]] theatre::TheatreSource video_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                                                 const std::filesystem::path& case_folder,
                                                 const std::filesystem::path& video, double refractive_index);

// The same with live pictures: a camera that is connected, or a stream. Opened on the worker, a camera in its
// turn. `tracker_address`: of the outside tracker that sees bones and tools, before the one that tools.json
// names; its error is that of tools.json, and without one it guides nothing. Throws InvalidInput, too, when
// camera.json or tools.json may not be used live.
[[nodiscard]] theatre::TheatreSource camera_setup(const open_case::PlanModel& model, bones::BoneKind bone,
                                                  const std::filesystem::path& case_folder,
                                                  const LivePictures& pictures,
                                                  const sources::DeviceTurns& turns, double refractive_index,
                                                  const std::string& tracker_address = "");

// Whether the case is of a real arthroscope: it has a calibration that is not the simulated one's.
[[nodiscard]] bool has_real_scope(const std::filesystem::path& case_folder);

}  // namespace arthronaut::navigate
