#include <array>
#include <cmath>
#include <memory>

#include "app/command_line/command.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_file.h"
#include "planning/images/volume_writer.h"
#include "planning/segmentation/seed_growth.h"

namespace arthronaut::command_line {

namespace {

struct SegmentArguments {
  std::string volume, seeds, output, series;
  double smoothing_mm = 0;
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

void segment(const Context& context, const SegmentArguments& arguments) {
  const images::Volume seeds = read(arguments.seeds, "", "Reading the seeds");
  images::Volume volume = read(arguments.volume, arguments.series, "Reading");
  const segmentation::Labels painted = labels_from(arguments.seeds, seeds, volume);
  segmentation::Labels labels;
  {
    Progress progress("Growing", 100);
    segmentation::SeedGrowthOptions options;
    options.on_progress = [&](double fraction) { progress.advance_to(static_cast<long>(100 * fraction)); };
    try {
      labels = segmentation::grow_from_seeds(volume, painted, options);
    } catch (const InvalidInput& error) {
      throw InvalidInput(arguments.seeds, "", error.what());
    }
  }
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t label : labels) ++counts[label];
  for (std::size_t label = 1; label < counts.size() && arguments.smoothing_mm > 0; ++label) {
    if (counts[label] > 0)
      segmentation::smooth_label(labels, volume, static_cast<std::uint8_t>(label), arguments.smoothing_mm);
  }
  const double voxel_ml = std::abs(volume.lps_from_index.linear().determinant()) / 1000;
  volume.values.assign(labels.begin(), labels.end());
  volume.modality.clear();
  volume.segments = seeds.segments;
  images::write_volume(arguments.output, volume);
  for (std::size_t label = 1; label < counts.size(); ++label) {
    if (counts[label] > 0)
      context.say(files::format("label %zu: %.1f ml", label, voxel_ml * static_cast<double>(counts[label])));
  }
  context.say("Wrote " + arguments.output + ".");
}

}  // namespace

void add_segment_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<SegmentArguments>();
  CLI::App* sub = add_subcommand(
      app, context, "segment", "Grow bones from a few painted strokes, in an MR or any other volume",
      "arthronaut segment knee_mr.nrrd --seeds seeds.nrrd -o labels.nrrd\n"
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
  sub->add_option("--smooth-mm", arguments->smoothing_mm, "Round borders off at this radius; default: not")
      ->check(CLI::Range(0.0, 5.0));
  sub->callback([&context, arguments] { segment(context, *arguments); });
}

}  // namespace arthronaut::command_line
