#include <algorithm>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/library/plan_verdict.h"
#include "app/report/report.h"
#include "app/scene/plan_picture.h"
#include "app/screen_copy/screen_copies.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/sources/frame_source.h"
#include "planning/cases/bone_doubts.h"
#include "planning/dicom_out/dicom_export.h"
#include "planning/files/whole_folder.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;

struct DicomArguments {
  std::string case_folder, output;
  bool is_deidentified = false;
};

// Of the newest operation, by its folder (0007-20260131-120000), else of the case: what is exported was true
// then, and a clock would make the same case another one each time.
std::string moment_of(const fs::path& case_folder, const cases::Case& knee) {
  const auto sessions = recording::operation_folders(case_folder);
  if (sessions.empty()) return knee.created_utc;
  constexpr std::size_t kMomentLength = 15;
  const std::string name = sessions.back().filename().string();
  if (name.size() < kMomentLength) return knee.created_utc;
  const std::string digits = name.substr(name.size() - kMomentLength);
  const auto part = [&](std::size_t at, std::size_t count) { return digits.substr(at, count); };
  return part(0, 4) + "-" + part(4, 2) + "-" + part(6, 2) + "T" + part(9, 2) + ":" + part(11, 2) + ":" +
         part(13, 2) + "Z";
}

// Each bone from the joint's side, with its planned tunnels.
void add_plan_pictures(const cases::Case& knee, std::vector<dicom_out::KeyPicture>& pictures) {
  for (const bones::BoneKind kind : {bones::BoneKind::Femur, bones::BoneKind::Tibia}) {
    const auto bone = knee.bones.find(kind);
    if (bone == knee.bones.end() || bone->second.mesh.empty()) continue;
    scene::PictureRequest request;
    request.knee = &knee;
    request.view =
        kind == bones::BoneKind::Femur ? scene::ViewDirection::Notch : scene::ViewDirection::Plateau;
    request.width = 1024;
    request.height = 768;
    scene::Image image = scene::render_plan_picture(request);
    pictures.push_back({.title = "Plan of the " + std::string(bones::to_text(kind)) + ", from the " +
                                 (kind == bones::BoneKind::Femur ? "notch" : "joint"),
                        .width = image.width,
                        .height = image.height,
                        .rgb = std::move(image.rgb)});
  }
}

// In an archive nothing else tells a simulator's picture from a patient's.
std::string title_of_pictures(const fs::path& case_folder) {
  switch (recording::pictured_knee(case_folder)) {
    case recording::PicturedKnee::Patient:
      return "Picture of the operation";
    case recording::PicturedKnee::Nobody:
      return "SIMULATION, nobody's knee: picture";
    case recording::PicturedKnee::Either:
      return "Picture of the operation or of a SIMULATION";
  }
  return "Picture";
}

// Screenshots (F12), by their time, and those in the case's own folder of pictures, by name.
void add_pictures_of_operation(const fs::path& case_folder, std::vector<dicom_out::KeyPicture>& pictures) {
  std::vector<fs::path> files;
  for (const fs::path& folder : {screen_copy::screens_folder(case_folder), case_folder / "pictures"}) {
    if (!fs::is_directory(folder)) continue;
    const auto first = static_cast<std::ptrdiff_t>(files.size());
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (entry.is_regular_file() && (extension == ".png" || extension == ".jpg"))
        files.push_back(entry.path());
    }
    std::sort(files.begin() + first, files.end());
  }
  int number = 0;
  const std::string title = title_of_pictures(case_folder);
  for (const fs::path& file : files) {
    camera::Frame frame = sources::read_picture(file);
    for (std::size_t at = 0; at + 2 < frame.bgr.size(); at += 3) std::swap(frame.bgr[at], frame.bgr[at + 2]);
    // Not by the file's name: it may be the patient's.
    pictures.push_back({.title = title + " " + std::to_string(++number),
                        .width = frame.width,
                        .height = frame.height,
                        .rgb = std::move(frame.bgr)});
  }
}

void export_dicom(Context& context, const DicomArguments& arguments) {
  files::refuse_taken(arguments.output);  // before the work
  files::refuse_unwritable(arguments.output);
  dicom_out::ExportContents contents{.knee = cases::load_case(arguments.case_folder),
                                     .identity = std::nullopt,
                                     .studies = {},
                                     .moment_utc = {},
                                     .report_pdf = {},
                                     .pictures = {},
                                     .is_deidentified = arguments.is_deidentified};
  if (contents.knee.bones.empty())
    throw InvalidInput(arguments.case_folder, "case.json", "holds no bone to export");
  const cases::BoneDoubts bone_doubts = cases::load_bone_doubts(arguments.case_folder);
  auto verdict = workstation_library::plan_verdict(arguments.case_folder);
  if (!verdict) verdict = workstation_library::judge_plan(contents.knee, bone_doubts);
  contents.moment_utc = moment_of(arguments.case_folder, contents.knee);
  contents.studies = cases::load_studies(arguments.case_folder);
  if (!arguments.is_deidentified) contents.identity = cases::load_identity(arguments.case_folder);
  contents.report_pdf = report::make_report(
      arguments.case_folder, {.with_identity = true, .is_deidentified = arguments.is_deidentified});
  if (!arguments.is_deidentified) add_plan_pictures(contents.knee, contents.pictures);
  add_pictures_of_operation(arguments.case_folder, contents.pictures);
  const auto summary = dicom_out::export_dicom(contents, arguments.output);
  for (const std::string& note : summary.notes) context.say(note);
  for (const fs::path& file : summary.files) context.say("Wrote " + file.string());
  if (contents.identity) context.say("They name the patient, as the images do; --deidentified names nobody");
  // As `plan --export` has it: what speaks against the plan is told and no doubt about what was written,
  // unless it is of the other knee.
  for (const std::string& wrong : verdict->wrong) context.say("Wrong, and written all the same: " + wrong);
  std::vector<std::string> doubts = summary.doubts;
  if (const std::string side = plan_review::side_doubt(bone_doubts); !side.empty())
    doubts.insert(doubts.begin(), side);
  if (!doubts.empty()) context.say_unreliable(arguments.output, doubts);
}

}  // namespace

void add_dicom_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<DicomArguments>();
  CLI::App* sub = add_subcommand(
      app, context, "dicom",
      "Write bones, drilled bones, plan, report and pictures (the plan's, the screenshots of F12) as DICOM, "
      "beside the images' study",
      "arthronaut dicom Knee.arthro -o for_the_archive");
  sub->add_option("case", arguments->case_folder, "Case folder")->required();
  sub->add_option("-o,--output", arguments->output, "Folder to write: absent, or empty")
      ->required()
      ->check(a_file());
  sub->add_flag(
      "--deidentified", arguments->is_deidentified,
      "Without patient, study, dates and pictures; else the patient and the study of the images are named");
  sub->callback([&context, arguments] { export_dicom(context, *arguments); });
}

}  // namespace arthronaut::command_line
