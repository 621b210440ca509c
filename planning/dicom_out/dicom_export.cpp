#include "planning/dicom_out/dicom_export.h"

#include <algorithm>
#include <system_error>
#include <tuple>

#include "planning/bones/mesh_file.h"
#include "planning/cases/plan_file.h"
#include "planning/dicom_out/dicom_object.h"
#include "planning/dicom_out/lawful.h"
#include "planning/dicom_out/object_bytes.h"
#include "planning/dicom_out/uid.h"
#include "planning/files/atomic_file.h"
#include "planning/files/format.h"
#include "planning/files/whole_folder.h"
#include "planning/geometry/error.h"
#include "planning/geometry/surface.h"
#include "planning/plan_export/drilled_bone.h"

namespace arthronaut::dicom_out {

namespace {

namespace fs = std::filesystem;
using Belongings = std::map<bones::BoneKind, Belonging>;

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

void add_bones(const ExportContents& contents, const ObjectSetting& setting, const Belongings& belongings,
               std::vector<Object>& objects) {
  for (const auto& [kind, bone] : contents.knee.bones) {
    const std::string name(bones::to_text(kind));
    objects.push_back(
        model_object(belongings.at(kind), setting,
                     capitalised(name) + " of a " + std::string(bones::to_text(setting.side)) + " knee",
                     bones::mesh_as_stl(name, bone.mesh), false));
    objects.back().file_name = name + ".dcm";
  }
}

// A tunnel of another surface would lie somewhere else in this one: such a bone is not drilled.
void add_drilled_bones(const ExportContents& contents, const ObjectSetting& setting,
                       const Belongings& belongings, std::vector<Object>& objects, ExportSummary& summary) {
  for (const auto kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const std::string name(bones::to_text(kind));
    std::vector<tunnels::Tunnel> tunnels;
    std::string widths, reason;
    for (const tunnels::TunnelKey& key : contents.knee.plan.of(kind)) {
      const tunnels::Tunnel& tunnel = contents.knee.plan.tunnels.at(key);
      widths += files::format(tunnels.empty() ? "%.1f" : " and %.1f", tunnel.diameter_mm);
      tunnels.push_back(tunnel);
      if (const auto fit = cases::plan_fit(contents.knee, key); !fit.is_valid()) reason = fit.reason;
    }
    if (tunnels.empty()) continue;
    plan_export::DrilledBone drilled;
    if (reason.empty()) {
      drilled = plan_export::drill(contents.knee.bones.at(kind).mesh, tunnels);
      reason = drilled.reason;
    }
    if (!drilled.is_usable()) {
      summary.doubts.push_back("the " + name + " is not there drilled: " + reason);
      continue;
    }
    const std::string title =
        files::format("%s of a %s knee, with its planned tunnel%s of %s mm drilled out, plan %s",
                      capitalised(name).c_str(), std::string(bones::to_text(setting.side)).c_str(),
                      tunnels.size() == 1 ? "" : "s", widths.c_str(), setting.plan_hash.c_str());
    objects.push_back(model_object(belongings.at(kind), setting, title,
                                   bones::mesh_as_stl(name + ", drilled", drilled.mesh), true));
    objects.back().file_name = name + "_drilled.dcm";
  }
}

// Of the tunnels that are of the case's surfaces and enter them; that others are left out was said already.
void add_plan(const ExportContents& contents, const ObjectSetting& setting, const Belongings& belongings,
              std::vector<Object>& objects) {
  std::vector<PlannedTunnel> planned;
  for (const auto& [key, tunnel] : contents.knee.plan.tunnels) {
    if (!cases::plan_fits(contents.knee, key)) continue;
    const auto measured = tunnels::measure(tunnel, geometry::Surface(contents.knee.bones.at(key.bone).mesh));
    if (measured.enters_bone)
      planned.push_back({tunnel, measured.exit_mm, belongings.at(key.bone).study.frame_of_reference_uid});
  }
  if (planned.empty()) return;
  objects.push_back(plan_object(belongings.begin()->second, setting, planned));
  objects.back().file_name = "plan.dcm";
}

void add_pictures(const ExportContents& contents, const ObjectSetting& setting, const Belonging& belonging,
                  std::vector<Object>& objects, ExportSummary& summary) {
  if (contents.is_deidentified) {
    if (!contents.pictures.empty())
      summary.notes.push_back("Pictures are left out: a name may be drawn into them.");
    return;
  }
  constexpr int kLargest_px = 65535;  // what a number of rows has room for
  int count = 0;
  for (const KeyPicture& picture : contents.pictures) {
    const auto bytes = 3 * static_cast<std::size_t>(std::max(picture.width, 0)) *
                       static_cast<std::size_t>(std::max(picture.height, 0));
    if (bytes == 0 || picture.width > kLargest_px || picture.height > kLargest_px ||
        picture.rgb.size() != bytes)
      throw InvalidInput("picture " + picture.title + ": its bytes do not fit its size");
    objects.push_back(picture_object(belonging, setting, picture));
    objects.back().file_name = files::format("image_%03d.dcm", ++count);
  }
}

// A series is of one study, one kind and one frame; its identifier follows from all that is in it.
void form_series(std::vector<Object>& objects) {
  using Key = std::tuple<std::string, std::string, std::string>;
  std::map<Key, std::vector<Object*>> series;
  for (Object& object : objects) {
    const images::DicomOrigin& study = object.belonging.study;
    series[{study.study_uid, object.kind.modality, study.frame_of_reference_uid}].push_back(&object);
  }
  for (const auto& [key, members] : series) {
    std::string contents;
    for (Object* object : members) contents += uid_of("contents", bytes_of(*object->dataset)) + "\n";
    const std::string uid = uid_of("series", contents);
    int instance_number = 0;
    for (Object* object : members) number(*object, uid, ++instance_number);
  }
}

void say_of_which_study(const ExportContents& contents, const Belongings& belongings,
                        ExportSummary& summary) {
  if (contents.is_deidentified) {
    summary.notes.push_back("Without patient, study and dates, in a new study.");
    return;
  }
  bool is_of_images = false, is_of_meshes = false;
  for (const auto& [kind, belonging] : belongings) {
    is_of_images = is_of_images || belonging.is_of_images;
    is_of_meshes = is_of_meshes || !contents.studies.contains(kind);
  }
  if (!is_of_images) {
    summary.notes.push_back("The case knows of no study that its bones are of: a new one was made.");
  } else if (is_of_meshes) {
    summary.notes.push_back("A bone that was no DICOM image lies in a frame of reference of its own.");
  }
  if (!contents.identity) summary.notes.push_back("The case knows no patient: none is named.");
}

// Bones are of one patient, and mostly of one study: what is said of it is said once.
void make_lawful(Belongings& belongings, ExportSummary& summary) {
  for (auto& [kind, belonging] : belongings)
    for (std::string& note : dicom_out::make_lawful(belonging))
      if (std::ranges::find(summary.notes, note) == summary.notes.end())
        summary.notes.push_back(std::move(note));
}

void write_all(const fs::path& folder, std::vector<Object>& objects, ExportSummary& summary) {
  files::make_whole_folder(folder, [&](const fs::path& unfinished) {
    for (Object& object : objects) {
      DcmFileFormat file(object.dataset.release(), OFFalse);  // which deletes it
      files::write_atomically(unfinished / object.file_name, bytes_of(file));
      summary.files.push_back(folder / object.file_name);
    }
  });
}

}  // namespace

ExportSummary export_dicom(const ExportContents& contents, const fs::path& folder) {
  files::refuse_taken(folder);
  if (contents.knee.bones.empty()) throw InvalidInput("dicom: the case holds no bone");
  Belongings belongings = belongings_of(contents);
  const Belonging& of_case = belongings.begin()->second;
  const cases::Plan plan = cases::with_named_meshes(contents.knee);
  const ObjectSetting setting{.side = contents.knee.side,
                              .moment_utc = contents.moment_utc,
                              .plan_hash = plan.tunnels.empty() ? "" : cases::short_plan_hash(plan)};
  ExportSummary summary;
  say_of_which_study(contents, belongings, summary);
  make_lawful(belongings, summary);
  if (!setting.plan_hash.empty()) summary.notes.push_back("Of the plan " + setting.plan_hash + ".");
  std::vector<Object> objects;
  add_bones(contents, setting, belongings, objects);
  add_drilled_bones(contents, setting, belongings, objects, summary);
  add_plan(contents, setting, belongings, objects);
  if (!contents.report_pdf.empty()) {
    objects.push_back(report_object(of_case, setting, contents.report_pdf));
    objects.back().file_name = "report.dcm";
  }
  add_pictures(contents, setting, of_case, objects, summary);
  form_series(objects);
  write_all(folder, objects, summary);
  return summary;
}

}  // namespace arthronaut::dicom_out
