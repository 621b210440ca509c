// QIDO-RS, and what the others ask by it. Inner header of pacs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "planning/pacs/http.h"
#include "planning/pacs/series_images.h"

namespace arthronaut::pacs {

// The objects of an answer in DICOM's JSON model; empty for 204. Throws DeviceError for anything else.
[[nodiscard]] nlohmann::json web_objects(HttpClient& client, const std::string& path, bool& was_stopped);
// First value as text, whatever its type; a person's name's alphabetic part. Empty when absent.
[[nodiscard]] std::string web_text(const nlohmann::json& object, const char* tag);
// What the server lists of a series. Throws as ask_series_images().
[[nodiscard]] SeriesImages ask_web_series_images(HttpClient& client, const std::string& series_uid,
                                                 const std::string& study_uid);

}  // namespace arthronaut::pacs
