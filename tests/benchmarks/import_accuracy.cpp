// Prints how near the surfaces of a CT's bones come to the bones that the CT was made from, and what it took:
//   import_accuracy [FEMUR TIBIA]    meshes in one frame, LPS, mm; default: the built-in knee
#include <cstdio>
#include <ctime>
#include <exception>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_repair.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/segmentation/ct_bones.h"
#include "tests/planning/segmentation/known_ct.h"

namespace arthronaut {
namespace {

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void print_row(const std::vector<geometry::TriangleMesh>& truth, const test::KnownCtOptions& options) {
  const images::Volume volume = test::known_ct(truth, options);
  const double start = processor_seconds();
  const auto found = segmentation::bones_of_ct(volume);
  const double took = processor_seconds() - start;
  for (const auto& bone : found.bones) {
    const auto mended = bones::mend_mesh(bone.mesh);
    const auto& exact = truth[bone.kind == bones::BoneKind::Femur ? 0 : 1];
    const auto out = test::distances_to(exact, mended.mesh, 0);
    std::printf("| %s | %.1f | %.0f | %.0f | %.2f | %.3f | %.3f | %s | %.1f |\n",
                std::string(bones::to_text(bone.kind)).c_str(), options.cortex_mm, options.cortex_hu,
                options.marrow_hu, options.blur_mm, out[out.size() / 2], out[out.size() * 95 / 100],
                mended.report.is_closed ? "yes" : "no", took);
  }
}

int run(int argc, char** argv) {
  std::vector<geometry::TriangleMesh> truth;
  if (argc == 3) {
    for (int i = 1; i < 3; ++i) truth.push_back(bones::mend_mesh(bones::read_mesh(argv[i], {})).mesh);
  } else {
    const auto knee = phantom::make_phantom_knee();
    truth = {knee.femur.mesh, knee.tibia.mesh};
  }
  std::printf(
      "| bone | cortex mm | cortex HU | marrow HU | blur mm | median mm | 95 %% mm | closed | s for both |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  struct Row {
    double cortex_mm, cortex_hu, marrow_hu, blur_mm;
  };
  for (const Row& row : {Row{1.5, 1200, 150, 0}, Row{1.0, 1200, 150, 0}, Row{1.5, 1200, 150, 0.35},
                         Row{1.5, 1200, 150, 0.5}, Row{1.0, 1200, 150, 0.5}, Row{1.5, 1200, 150, 0.7},
                         Row{1.5, 800, 300, 0.5}, Row{1.0, 1600, 0, 0.5}, Row{3.0, 1200, 150, 0.5}}) {
    test::KnownCtOptions options;
    options.cortex_mm = row.cortex_mm;
    options.cortex_hu = row.cortex_hu;
    options.marrow_hu = row.marrow_hu;
    options.blur_mm = row.blur_mm;
    print_row(truth, options);
  }
  return 0;
}

}  // namespace
}  // namespace arthronaut

int main(int argc, char** argv) {
  try {
    return arthronaut::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "import_accuracy: %s\n", error.what());
    return 1;
  }
}
