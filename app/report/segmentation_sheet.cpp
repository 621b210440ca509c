#include "app/report/segmentation_sheet.h"

#include <array>

#include "app/report/pdf_document.h"
#include "app/scene/reslice.h"
#include "planning/files/format.h"

namespace arthronaut::report {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLeft_mm = 20, kWidth_mm = 170, kGap_mm = 4, kMargin_mm = 8;
constexpr double kPicture_mm = (kWidth_mm - 2 * kGap_mm) / 3;
constexpr int kPicture_px = 420;
constexpr Ink kOutline{0.98, 0.55, 0.10};
constexpr TextStyle kCaption{.size_pt = 7.5, .bold = false, .ink = kGray};

struct Direction {
  const char* name;
  Vector3d right, down;
};
// As radiologists hang them: the patient's right on the left, anterior on the left or on top.
const std::array<Direction, 3> kDirections{{{"Axial", Vector3d::UnitX(), Vector3d::UnitY()},
                                            {"Coronal", Vector3d::UnitX(), -Vector3d::UnitZ()},
                                            {"Sagittal", Vector3d::UnitY(), -Vector3d::UnitZ()}}};

void draw_plane(PdfDocument& pdf, double x_mm, double y_mm, const Direction& direction,
                const images::Volume& volume, const scene::GreyWindow& window,
                const geometry::TriangleMesh& mesh) {
  const Eigen::Vector2i size_px(kPicture_px, kPicture_px);
  const auto box = geometry::bounds_of(mesh);
  const double shown_mm =
      std::max(std::abs(box.size_mm().dot(direction.right)), std::abs(box.size_mm().dot(direction.down))) +
      2 * kMargin_mm;
  const scene::SlicePlane plane{box.center_mm(), direction.right, direction.down, shown_mm / kPicture_px};
  std::vector<std::uint8_t> grey, rgb;
  scene::reslice(volume, plane, size_px, window, grey);
  rgb.reserve(3 * grey.size());
  for (const std::uint8_t value : grey) rgb.insert(rgb.end(), 3, value);
  pdf.image(x_mm, y_mm, kPicture_mm, rgb, kPicture_px, kPicture_px);
  const auto on_page = [&](const Vector3d& point) -> Vector2d {
    return Vector2d(x_mm, y_mm) +
           (kPicture_mm / kPicture_px) * (plane.pixel_of(point, size_px).array() + 0.5).matrix();
  };
  for (const auto& [from, to] : scene::outline_of(mesh, plane.center_mm, plane.normal())) {
    const Vector2d a = on_page(from), b = on_page(to);
    pdf.line(a.x(), a.y(), b.x(), b.y(), 0.25, kOutline);
  }
  pdf.text(x_mm, y_mm + kPicture_mm + 3.5,
           files::format("%s, %.0f mm; %s on the left, %s on top", direction.name, shown_mm,
                         scene::orientation_letters(-direction.right).c_str(),
                         scene::orientation_letters(-direction.down).c_str()),
           kCaption);
}

}  // namespace

void write_segmentation_sheet(const std::filesystem::path& file, const images::Volume& volume,
                              const std::vector<SegmentedBone>& bones) {
  PdfDocument pdf("Segmentation");
  pdf.add_page();
  double y_mm = 24;
  pdf.text(kLeft_mm, y_mm, "Segmentation", {.size_pt = 16, .bold = true});
  y_mm += 6;
  const Vector3d spacing = volume.spacing_mm();
  pdf.text(
      kLeft_mm, y_mm,
      files::format("%d x %d x %d voxels of %.2f x %.2f x %.2f mm%s%s. Research software.", volume.size.x(),
                    volume.size.y(), volume.size.z(), spacing.x(), spacing.y(), spacing.z(),
                    volume.modality_in_file.empty() ? "" : ", ", volume.modality_in_file.c_str()),
      kCaption);
  const scene::GreyWindow window =
      volume.modality == images::Modality::Ct ? scene::kBoneWindow : scene::automatic_window(volume);
  for (const SegmentedBone& bone : bones) {
    y_mm += 10;
    const bool is_femur = bone.quality.kind == bones::BoneKind::Femur;
    pdf.text(kLeft_mm, y_mm, is_femur ? "Femur" : "Tibia", {.size_pt = 12, .bold = true, .ink = kAccent});
    y_mm += 3;
    for (std::size_t i = 0; i < kDirections.size(); ++i)
      draw_plane(pdf, kLeft_mm + static_cast<double>(i) * (kPicture_mm + kGap_mm), y_mm, kDirections[i],
                 volume, window, bone.mesh);
    y_mm += kPicture_mm + 9;
    for (const importing::QualityLine& line : importing::quality_lines(bone.quality)) {
      const bool is_good = line.verdict == importing::QualityVerdict::Good;
      pdf.text(kLeft_mm, y_mm, line.name,
               {.size_pt = 8.5, .bold = !is_good, .ink = is_good ? kGray : kWarning});
      y_mm = pdf.paragraph(kLeft_mm + 22, y_mm, kWidth_mm - 22, line.text,
                           {.size_pt = 8.5, .bold = false, .ink = is_good ? kBlack : kWarning});
      y_mm += 0.8;
    }
  }
  pdf.save(file);
}

}  // namespace arthronaut::report
