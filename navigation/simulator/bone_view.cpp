#include "navigation/simulator/bone_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/simulator/light.h"
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

void BoneView::look(const geometry::RigidTransform& camera_from_bone, const camera::CameraModel& camera) {
  const Eigen::Matrix3f rotation = camera_from_bone.matrix().cast<float>();
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Eigen::Vector3d in_camera = camera_from_bone * vertices_[i].cast<double>();
    camera_vertices_[i] = in_camera.cast<float>();
    camera_normals_[i] = rotation * normals_[i];
    const auto pixel = in_camera.z() > 0.5 ? camera.project(in_camera) : std::nullopt;
    pixels_[i] = pixel ? Eigen::Vector2f(pixel->cast<float>())
                       : Eigen::Vector2f::Constant(std::numeric_limits<float>::quiet_NaN());
  }
}

void BoneView::draw(const PixelArea& area, int first_row, int end_row, std::vector<BonePixel>& pixels) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [ia, ib, ic] = triangles_[t];
    const Eigen::Vector2f a = pixels_[static_cast<std::size_t>(ia)],
                          b = pixels_[static_cast<std::size_t>(ib)],
                          c = pixels_[static_cast<std::size_t>(ic)];
    const Eigen::Vector2f ab = b - a, ac = c - a;
    // Outward triangles turn clockwise on a picture whose y points down, so this is negative for those that
    // face us.
    const float twice_area = ab.x() * ac.y() - ab.y() * ac.x();
    if (!(twice_area < -1e-6f)) continue;
    const float top = std::min({a.y(), b.y(), c.y()}), bottom = std::max({a.y(), b.y(), c.y()});
    const int y0 = std::max(first_row, static_cast<int>(std::ceil(top)) - area.top);
    const int y1 = std::min(end_row - 1, static_cast<int>(std::floor(bottom)) - area.top);
    if (y0 > y1) continue;
    const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()}))) - area.left);
    const int x1 =
        std::min(area.width - 1, static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()}))) - area.left);
    if (x0 > x1) continue;
    const float za = camera_vertices_[static_cast<std::size_t>(ia)].z();
    const float zb = camera_vertices_[static_cast<std::size_t>(ib)].z() - za;
    const float zc = camera_vertices_[static_cast<std::size_t>(ic)].z() - za;
    const float inverse = 1 / twice_area;
    for (int y = y0; y <= y1; ++y) {
      const float py = static_cast<float>(y + area.top) - a.y();
      BonePixel* row = pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(area.width);
      for (int x = x0; x <= x1; ++x) {
        const float px = static_cast<float>(x + area.left) - a.x();
        const float share_b = (px * ac.y() - py * ac.x()) * inverse;
        const float share_c = (ab.x() * py - ab.y() * px) * inverse;
        if (share_b < 0 || share_c < 0 || share_b + share_c > 1) continue;
        const float depth = za + share_b * zb + share_c * zc;
        if (depth < row[x].depth_mm) row[x] = {static_cast<std::int32_t>(t), depth, share_b, share_c};
      }
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
