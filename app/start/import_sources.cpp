#include "app/start/import_sources.h"

#include <algorithm>
#include <cctype>

#include "app/folders/folder_listing.h"
#include "planning/bones/mesh_file.h"
#include "planning/cases/identity.h"
#include "planning/files/format.h"
#include "planning/import/bone_import.h"

namespace arthronaut::start {

namespace {

namespace fs = std::filesystem;

// What of a knee its name says it is that is neither femur nor tibia, though it may lie on one; else empty.
std::string other_part(const fs::path& file) {
  std::string name = file.filename().string();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* part : {"cartilage", "meniscus", "menisci", "patella", "fibula"})
    if (name.find(part) != std::string::npos) return part;
  return "";
}

void add_mesh(ImportSources& found, const fs::path& file) {
  ImportSource mesh;
  mesh.source = file;
  const std::string part = other_part(file);
  if (part.empty()) mesh.bone = importing::bone_kind_in_name(file);
  mesh.title = "Mesh: " + file.filename().string();
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  mesh.detail = error ? "" : files::format("%.1f MB", static_cast<double>(bytes) / 1e6);
  if (!error && bytes == 0)
    mesh.refusal = "the file is empty";
  else if (mesh.bone)
    mesh.detail += ", the " + std::string(bones::to_text(*mesh.bone)) + " by its name";
  else if (!part.empty())
    mesh.refusal = part + " by its name: nothing is planned on it";
  else
    mesh.refusal = "its name says neither femur nor tibia. Select it, and press F or T if it is one";
  found.sources.push_back(std::move(mesh));
}

void add_meshes(ImportSources& found) {
  std::error_code error;
  if (!fs::is_directory(found.root, error)) {
    if (bones::is_mesh_file(found.root)) add_mesh(found, found.root);
    return;
  }
  for (const folders::FolderEntry& entry : folders::list_folder(found.root).entries)
    if (entry.kind == folders::FolderEntry::Kind::Mesh) add_mesh(found, entry.path);
}

}  // namespace

ImportSource source_of(const fs::path& root, const images::ImageSeries& series) {
  ImportSource source;
  source.series = series;
  // A file that is no DICOM is a volume of its own; a DICOM series is read from the folder by its UID.
  source.source = series.uid.empty() && !series.files.empty() ? series.files.front() : root;
  source.title = images::title_of(series);
  source.detail = images::detail_of(series);
  // Of two series that look alike one may be another patient's, or of years ago.
  const cases::Identity whose{series.patient_name, series.patient_id, ""};
  for (const std::string& part : {whose.in_words(), cases::date_in_words(series.study_date)})
    if (!part.empty()) source.detail += "  \u2013  " + part;
  source.refusal = series.refusal;
  source.warnings = series.warnings;
  return source;
}

std::optional<std::size_t> ImportSources::best() const {
  if (!wanted_uid.empty()) {
    for (std::size_t i = 0; i < sources.size(); ++i)
      if (sources[i].series && sources[i].series->uid == wanted_uid && sources[i].can_be_imported()) return i;
    return std::nullopt;  // another one would be taken for what was chosen
  }
  std::optional<std::size_t> best;
  const auto worth = [](const ImportSource& source) {
    if (!source.series) return 1;
    return source.series->modality == "CT" ? 1'000'000 + source.series->image_count
                                           : 2 + source.series->image_count;
  };
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (!sources[i].can_be_imported()) continue;
    if (!best || worth(sources[i]) > worth(sources[*best])) best = i;
  }
  return best;
}

std::string series_of_one_slice(const fs::path& root, const images::SeriesList& list) {
  std::error_code error;
  if (!fs::is_regular_file(root, error) || list.series.size() != 1) return "";
  const images::ImageSeries& series = list.series.front();
  return series.image_count == 1 && !series.is_readable() ? series.uid : "";
}

bool may_hold_series(const fs::path& root) {
  std::error_code error;
  return fs::is_directory(root, error) || !bones::is_mesh_file(root);
}

ImportSources import_sources(const fs::path& root, const images::SeriesList& list) {
  ImportSources found;
  found.root = root;
  for (const auto& series : list.series) found.sources.push_back(source_of(root, series));
  for (const auto& skipped : list.skipped)
    found.left_out.push_back(skipped.file.filename().string() + ": " + skipped.reason);
  add_meshes(found);
  return found;
}

}  // namespace arthronaut::start
