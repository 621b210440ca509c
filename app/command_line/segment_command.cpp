#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "app/command_line/command.h"
#include "app/command_line/option_checks.h"
#include "app/report/segmentation_sheet.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "planning/images/volume_writer.h"
#include "planning/import/bone_import.h"
#include "planning/painting/label_edits.h"
#include "planning/segmentation/dark_rim.h"
#include "planning/segmentation/seed_growth.h"

namespace arthronaut::command_line {

namespace {

struct SegmentArguments {
  std::string volume, seeds, output, series, bones, side, report;
  double smoothing_mm = 0;
  bool keeps_largest = false;
  std::optional<double> closing_mm;
};

images::Volume read(const std::string& file, const std::string& series, const char* what) {
  Progress progress(what, 100);
  images::VolumeFileOptions options;
  options.series = series;
  options.on_progress = [&](double fraction) { progress.advance_to(static_cast<long>(100 * fraction)); };
  return images::read_volume(file, options);
}

segmentation::Labels labels_from(const std::string& file, const images::Volume& seeds,
                                 const images::Volume& volume) {
  if (seeds.size != volume.size) {
    throw InvalidInput(
        file, "",
        files::format("is a grid of %d x %d x %d voxels, the volume one of %d x %d x %d", seeds.size.x(),
                      seeds.size.y(), seeds.size.z(), volume.size.x(), volume.size.y(), volume.size.z()));
  }
  // A tenth of a voxel: what headers round.
  const Eigen::Vector3d last = (volume.size.array() - 1).cast<double>();
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(0, 0, 0), last, Eigen::Vector3d(last.x(), 0, last.z())}) {
    const double off = (seeds.lps_from_index * corner - volume.lps_from_index * corner).norm();
    if (off > 0.1 * volume.spacing_mm().minCoeff())
      throw InvalidInput(file, "",
                         files::format("lies %.2f mm beside the volume: paint in its own grid", off));
  }
  segmentation::Labels labels(seeds.values.size());
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const float value = seeds.values[v];
    if (value < 0 || value > 255 || value != std::floor(value))
      throw InvalidInput(file, "", files::format("holds %g: labels are whole numbers of 0 to 255", value));
    labels[v] = static_cast<std::uint8_t>(value);
  }
  return labels;
}

segmentation::Labels grow(const images::Volume& volume, const segmentation::Labels& painted,
                          const std::string& seeds) {
  Progress progress("Growing", 100);
  segmentation::SeedGrowthOptions options;
  options.on_progress = [&](double fraction) { progress.advance_to(static_cast<long>(100 * fraction)); };
  try {
    return segmentation::grow_from_seeds(volume, painted, options);
  } catch (const InvalidInput& error) {
    throw InvalidInput(seeds, "", error.what());
  }
}

using Counts = std::array<std::size_t, 256>;
Counts counts_of(const segmentation::Labels& labels) {
  Counts counts{};
  for (const std::uint8_t label : labels) ++counts[label];
  return counts;
}

// Which labels are bones: those that were named, else all.
std::vector<std::uint8_t> bone_labels(const SegmentArguments& arguments,
                                      const std::map<bones::BoneKind, int>& named,
                                      const segmentation::Labels& painted) {
  const Counts counts = counts_of(painted);
  std::vector<std::uint8_t> labels;
  for (const auto& [kind, label] : named) {
    if (label < 1 || label > 255 || counts[static_cast<std::size_t>(label)] == 0)
      throw InvalidInput(arguments.seeds, "",
                         files::format("holds no stroke of the label %d that --label names", label));
    labels.push_back(static_cast<std::uint8_t>(label));
  }
  for (std::size_t label = 1; label < counts.size() && named.empty(); ++label)
    if (counts[label] > 0) labels.push_back(static_cast<std::uint8_t>(label));
  return labels;
}

bool is_in(const std::vector<std::uint8_t>& labels, std::uint8_t label) {
  return std::ranges::find(labels, label) != labels.end();
}

// Islands go first, so that nothing is filled on their account. What is no bone gives way to a bone that
// encloses it.
void tidy(const Context& context, const SegmentArguments& arguments, const images::Volume& volume,
          const std::vector<std::uint8_t>& bones, segmentation::Labels& labels) {
  const auto is_bone = [&](std::uint8_t label) { return is_in(bones, label); };
  segmentation::Labels tidied = labels;
  for (std::uint8_t& label : tidied)
    if (!is_bone(label)) label = 0;
  for (const std::uint8_t label : bones) {
    if (arguments.keeps_largest) {
      const std::size_t removed = painting::keep_largest(tidied, volume, label);
      if (removed > 0) context.say(files::format("label %d: %zu voxels of islands removed", label, removed));
    }
    if (arguments.closing_mm) painting::fill_holes(tidied, volume, label, *arguments.closing_mm);
    if (arguments.smoothing_mm > 0) segmentation::smooth_label(tidied, volume, label, arguments.smoothing_mm);
  }
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (tidied[v] != 0 || is_bone(labels[v])) labels[v] = tidied[v];
}

// What an import of the label map will say of it, and the sheet. Returns why a person should look.
std::vector<std::string> judge(const Context& context, const SegmentArguments& arguments,
                               const std::map<bones::BoneKind, int>& named, const images::Volume& volume,
                               const segmentation::Labels& labels) {
  Progress progress("Making the surfaces", 0);
  std::vector<report::SegmentedBone> segmented;
  std::vector<std::string> reasons;
  for (const auto& [kind, label] : named) {
    // Each by itself: of which side the knee is, is asked where it becomes a case. What the name of the file
    // says is taken for it there too.
    importing::BoneImportOptions options;
    options.kind = kind;
    if (!arguments.side.empty()) options.side = bones::side_from_text(arguments.side);
    options.labels = {{kind, label}};
    const importing::BoneImport import = importing::import_bones(arguments.output, options);
    const importing::ImportedBone& made = import.bones.front();
    const double labelled_ml = painting::volume_ml(labels, volume, static_cast<std::uint8_t>(label));
    segmented.push_back({importing::quality_of(import, made, labelled_ml, volume), made.bone.mesh});
    for (const importing::QualityLine& line : importing::quality_lines(segmented.back().quality)) {
      const std::string words = std::string(bones::to_text(kind)) + ": " + line.name + ": " + line.text;
      if (line.verdict == importing::QualityVerdict::Good ||
          line.verdict == importing::QualityVerdict::NotChecked)
        context.say(words);
      else
        reasons.push_back(words);
    }
  }
  if (arguments.report.empty()) return reasons;
  report::write_segmentation_sheet(arguments.report, volume, segmented);
  context.say("Wrote " + arguments.report + ".");
  return reasons;
}

// Cortex is bone, and dark in an MR, so that the growth ends at the marrow.
void take_in_cortex(const Context& context, const std::map<bones::BoneKind, int>& named,
                    const images::Volume& volume, const segmentation::Labels& painted,
                    segmentation::Labels& labels) {
  std::vector<std::uint8_t> bones;
  for (const auto& [kind, label] : named) bones.push_back(static_cast<std::uint8_t>(label));
  for (const std::uint8_t bone : bones) {
    std::vector<std::uint8_t> others = bones;
    std::erase(others, bone);
    const auto rim = segmentation::take_in_dark_rim(labels, volume, bone, others, painted);
    if (rim.is_seen())
      context.say(files::format("label %d: %.1f mm of cortex taken in, dark about %.0f %% of it", bone,
                                rim.thickness_mm, 100 * rim.share));
  }
}

// A file of another ending would be no volume to anything that reads it.
void refuse_arguments(const SegmentArguments& arguments) {
  if (!arguments.report.empty() && arguments.bones.empty())
    throw CLI::RequiredError("beside --report, which bones it draws: --label, as in femur=1,tibia=2,");
  if (std::filesystem::path(arguments.output).extension() != ".nrrd")
    throw CLI::ValidationError("--output", arguments.output + " does not end in .nrrd, as what is written");
  refuse_before_the_work(
      {.read = {arguments.volume, arguments.seeds}, .written = {arguments.output, arguments.report}});
}

void segment(Context& context, const SegmentArguments& arguments) {
  const auto named = arguments.bones.empty() ? std::map<bones::BoneKind, int>{}
                                             : importing::labels_from_text(arguments.bones);
  refuse_arguments(arguments);
  const images::Volume seeds = read(arguments.seeds, "", "Reading the seeds");
  const images::Volume volume = read(arguments.volume, arguments.series, "Reading");
  const segmentation::Labels painted = labels_from(arguments.seeds, seeds, volume);
  const std::vector<std::uint8_t> bones = bone_labels(arguments, named, painted);
  segmentation::Labels labels = grow(volume, painted, arguments.seeds);
  take_in_cortex(context, named, volume, painted, labels);
  tidy(context, arguments, volume, bones, labels);
  images::Volume map;
  map.size = volume.size;
  map.lps_from_index = volume.lps_from_index;
  map.values.assign(labels.begin(), labels.end());
  map.segments = seeds.segments;
  images::write_volume(arguments.output, map);
  const Counts counts = counts_of(labels);
  for (std::size_t label = 1; label < counts.size(); ++label) {
    if (counts[label] > 0)
      context.say(files::format("label %zu: %.1f ml", label,
                                painting::volume_ml(labels, volume, static_cast<std::uint8_t>(label))));
  }
  context.say("Wrote " + arguments.output + ".");
  if (named.empty()) {
    if (counts[0] == 0) context.say("No voxel is 0: --label says which of the labels are bones.");
    return;
  }
  auto reasons = judge(context, arguments, named, volume, labels);
  if (std::ranges::all_of(painted, [&](std::uint8_t label) { return label == 0 || is_in(bones, label); }))
    reasons.insert(reasons.begin(),
                   "no stroke stands for what surrounds the bones: all of it was given to them");
  if (!reasons.empty()) context.say_unreliable(arguments.output, reasons);
}

}  // namespace

void add_segment_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<SegmentArguments>();
  CLI::App* sub = add_subcommand(
      app, context, "segment", "Grow bones from a few painted strokes, in an MR or any other volume",
      "arthronaut segment knee_mr.nrrd --seeds seeds.nrrd -o labels.nrrd --label femur=1,tibia=2 "
      "--largest --report quality.pdf\n"
      "  arthronaut import labels.nrrd --label femur=1,tibia=2 --side left -o Knee.arthro");
  sub->add_option("VOLUME", arguments->volume, "DICOM (folder, DICOMDIR or file), NIfTI, NRRD or MetaImage")
      ->required();
  sub->add_option("--seeds", arguments->seeds,
                  "Strokes as a label map in the grid of the volume: a number for each bone and one for what "
                  "surrounds them, 0 where nothing is painted")
      ->required();
  sub->add_option("-o,--output", arguments->output, "Label map to write (.nrrd), in the same grid")
      ->required();
  sub->add_option("--series", arguments->series, "Series number or UID, for DICOM with several");
  sub->add_option("--label", arguments->bones,
                  "Which of the numbers are bones, as in femur=1,tibia=2: these alone are tidied, made into "
                  "surfaces and judged (4 when a person should look); default: all are tidied, none judged")
      ->check(read_by([](const std::string& text) { (void)importing::labels_from_text(text); }));
  sub->add_option("--side", arguments->side,
                  "left or right, for the judgement; default: by the name of the label map, else not judged")
      ->check(CLI::IsMember({"left", "right"}))
      ->needs("--label");
  sub->add_flag("--largest", arguments->keeps_largest, "Of each bone's pieces keep the largest, no islands");
  sub->add_option("--fill-holes", arguments->closing_mm,
                  "Fill what a bone encloses, gaps of up to twice so many mm closed before; 0 closes none")
      ->check(between(0, 5));
  sub->add_option("--report", arguments->report,
                  "Page to write (.pdf): each bone's surface over the images, and what speaks against it")
      ->check(a_file());
  sub->add_option("--smooth-mm", arguments->smoothing_mm, "Round borders off at this radius; default: not")
      ->check(between(0, 5));
  sub->callback([&context, arguments] { segment(context, *arguments); });
}

}  // namespace arthronaut::command_line
