#include "navigation/simulator/bone_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/simulator/light.h"
#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/random.h"

namespace arthronaut::simulator {
namespace {

constexpr int kLattice = 32;                         // a power of two
constexpr float kGrainMm = 0.45f, kMottleMm = 2.3f;  // spacing of the fine and the middle noise
constexpr float kRednessMm = 5.5f;

const Eigen::Vector3f kBoneBgr{0.30f, 0.42f, 0.50f}, kRedBgr{0.05f, 0.065f, 0.26f};

}  // namespace

BoneView::Noise::Noise(std::uint64_t seed) : lattice_(kLattice * kLattice * kLattice) {
  Random random(seed);
  for (Eigen::Array4f& node : lattice_) {
    for (int i = 0; i < 4; ++i) node[i] = static_cast<float>(random.between(-1, 1));
  }
}

Eigen::Array4f BoneView::Noise::at(const Eigen::Array3f& position) const {
  const Eigen::Array3f floor = position.floor();
  const Eigen::Array3f linear = position - floor;
  const Eigen::Array3f f = linear * linear * (3.0f - 2.0f * linear);
  const Eigen::Array3i low = floor.cast<int>();
  const auto index = [&](int dx, int dy, int dz) {
    const int mask = kLattice - 1;
    return static_cast<std::size_t>(
        (((low.z() + dz) & mask) * kLattice + ((low.y() + dy) & mask)) * kLattice + ((low.x() + dx) & mask));
  };
  const auto row = [&](int dy, int dz) -> Eigen::Array4f {
    const Eigen::Array4f a = lattice_[index(0, dy, dz)];
    return a + f.x() * (lattice_[index(1, dy, dz)] - a);
  };
  const Eigen::Array4f near0 = row(0, 0), near1 = row(1, 0), far0 = row(0, 1), far1 = row(1, 1);
  const Eigen::Array4f near = near0 + f.y() * (near1 - near0), far = far0 + f.y() * (far1 - far0);
  return near + f.z() * (far - near);
}

BoneView::BoneView(const geometry::TriangleMesh& mesh, std::uint64_t seed)
    : noise_(seed), triangles_(mesh.triangles) {
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh);
  vertices_.reserve(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    vertices_.push_back(mesh.vertices_mm[i].cast<float>());
    normals_.push_back(normals[i].cast<float>());
    const Eigen::Array3f at = vertices_.back().array() / kRednessMm;
    const float patches = noise_.at(at)[0] + 0.5f * noise_.at(2.7f * at)[1];
    redness_.push_back(std::clamp(1.1f * patches - 0.15f, 0.0f, 0.8f));
  }
  camera_vertices_.resize(vertices_.size());
  camera_normals_.resize(vertices_.size());
  pixels_.resize(vertices_.size());
}

void BoneView::look(const geometry::RigidTransform& camera_from_bone, const RayTable& rays,
                    const PixelArea& area) {
  area_ = area;
  const Eigen::Matrix3f rotation = camera_from_bone.matrix().cast<float>();
  parallel_rows(static_cast<int>(vertices_.size()), [&](int first, int end) {
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
      const Eigen::Vector3d in_camera = camera_from_bone * vertices_[i].cast<double>();
      camera_vertices_[i] = in_camera.cast<float>();
      camera_normals_[i] = rotation * normals_[i];
      // Beyond the field stop a place is as good as any other further out: nothing of it is drawn.
      const bool is_before = in_camera.z() > 0.5;
      const Eigen::Vector2d tangent = in_camera.head<2>() / in_camera.z();
      pixels_[i] = is_before && tangent.norm() < 1.5 * rays.widest_tangent()
                       ? Eigen::Vector2f(rays.pixel(tangent).cast<float>())
                       : Eigen::Vector2f::Constant(std::numeric_limits<float>::quiet_NaN());
    }
  });
  bands_.resize(static_cast<std::size_t>((area.height + kBandRows - 1) / kBandRows));
  for (auto& band : bands_) band.clear();
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [ia, ib, ic] = triangles_[t];
    const Eigen::Vector2f a = pixels_[static_cast<std::size_t>(ia)],
                          b = pixels_[static_cast<std::size_t>(ib)],
                          c = pixels_[static_cast<std::size_t>(ic)];
    const Eigen::Vector2f ab = b - a, ac = c - a;
    // Outward triangles turn clockwise on a picture whose y points down, so this is negative for those that
    // face us.
    if (!(ab.x() * ac.y() - ab.y() * ac.x() < -1e-6f)) continue;
    const int first = std::max(0, static_cast<int>(std::ceil(std::min({a.y(), b.y(), c.y()}))) - area.top);
    const int last =
        std::min(area.height - 1, static_cast<int>(std::floor(std::max({a.y(), b.y(), c.y()}))) - area.top);
    for (int band = first / kBandRows; first <= last && band <= last / kBandRows; ++band) {
      bands_[static_cast<std::size_t>(band)].push_back({static_cast<std::int32_t>(t), first, last});
    }
  }
}

void BoneView::draw(int first_row, int end_row, std::vector<BonePixel>& pixels) const {
  for (int band = first_row / kBandRows; band * kBandRows < end_row; ++band) {
    const int first = std::max(first_row, band * kBandRows), end = std::min(end_row, (band + 1) * kBandRows);
    for (const Facing& facing : bands_[static_cast<std::size_t>(band)]) {
      draw_triangle(facing, first, end, pixels);
    }
  }
}

void BoneView::draw_triangle(const Facing& facing, int first_row, int end_row,
                             std::vector<BonePixel>& pixels) const {
  const auto& [ia, ib, ic] = triangles_[static_cast<std::size_t>(facing.triangle)];
  const Eigen::Vector2f a = pixels_[static_cast<std::size_t>(ia)], b = pixels_[static_cast<std::size_t>(ib)],
                        c = pixels_[static_cast<std::size_t>(ic)];
  const Eigen::Vector2f ab = b - a, ac = c - a;
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()}))) - area_.left);
  const int x1 =
      std::min(area_.width - 1, static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()}))) - area_.left);
  const float za = camera_vertices_[static_cast<std::size_t>(ia)].z();
  const float zb = camera_vertices_[static_cast<std::size_t>(ib)].z() - za;
  const float zc = camera_vertices_[static_cast<std::size_t>(ic)].z() - za;
  const float inverse = 1 / (ab.x() * ac.y() - ab.y() * ac.x());
  for (int y = std::max(first_row, facing.first_row); y <= std::min(end_row - 1, facing.last_row); ++y) {
    const float py = static_cast<float>(y + area_.top) - a.y();
    BonePixel* row = pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(area_.width);
    // Shares of the corners along the row: both are linear in the column.
    const float b_step = ac.y() * inverse, c_step = -ab.y() * inverse;
    const float px0 = static_cast<float>(area_.left) - a.x();
    const float b_at0 = (px0 * ac.y() - py * ac.x()) * inverse,
                c_at0 = (ab.x() * py - ab.y() * px0) * inverse;
    for (int x = x0; x <= x1; ++x) {
      const float share_b = b_at0 + static_cast<float>(x) * b_step;
      const float share_c = c_at0 + static_cast<float>(x) * c_step;
      if (share_b < 0 || share_c < 0 || share_b + share_c > 1) continue;
      const float depth = za + share_b * zb + share_c * zc;
      if (depth < row[x].depth_mm) row[x] = {facing.triangle, depth, share_b, share_c};
    }
  }
}

Eigen::Vector3f BoneView::shade(const BonePixel& pixel, float exposure) const {
  const auto& corners = triangles_[static_cast<std::size_t>(pixel.triangle)];
  const float sb = pixel.share_b, sc = pixel.share_c, sa = 1 - sb - sc;
  const auto mix = [&](const auto& of) {
    return (sa * of[static_cast<std::size_t>(corners[0])] + sb * of[static_cast<std::size_t>(corners[1])] +
            sc * of[static_cast<std::size_t>(corners[2])])
        .eval();
  };
  const Eigen::Array3f in_bone = mix(vertices_).array();
  const Eigen::Array4f grain = noise_.at(in_bone / kGrainMm), mottle = noise_.at(in_bone / kMottleMm);
  const float redness = sa * redness_[static_cast<std::size_t>(corners[0])] +
                        sb * redness_[static_cast<std::size_t>(corners[1])] +
                        sc * redness_[static_cast<std::size_t>(corners[2])];
  const float red = std::clamp(redness * (1 + 0.9f * mottle[0] + 0.3f * grain[0]), 0.0f, 0.9f);
  Skin skin;
  skin.albedo_bgr = (1 + 0.05f * grain[0] + 0.06f * mottle[1]) * ((1 - red) * kBoneBgr + red * kRedBgr);
  // The film of fluid glitters: its highlights follow a rougher normal than the bone's own.
  const Eigen::Vector3f smooth = unit(mix(camera_normals_));
  const Eigen::Vector3f rough = unit(smooth + (0.10f * grain.tail<3>() + 0.13f * mottle.tail<3>()).matrix());
  skin.specular = 1.4f;
  skin.gloss_doublings = 7;
  return lit(mix(camera_vertices_), rough, skin, exposure);
}

}  // namespace arthronaut::simulator
