#include "navigation/simulator/bone_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/picture_kernel.h"
#include "navigation/simulator/random.h"

namespace arthronaut::simulator {
namespace {

constexpr float kGrainMm = 0.45f, kMottleMm = 2.3f;  // spacing of the fine and the middle noise
constexpr float kRednessMm = 5.5f;

std::vector<float> drawn_lattice(std::uint64_t seed) {
  std::vector<float> lattice;
  lattice.reserve(kLatticeFloats);
  Random random(seed);
  for (int row = 0; row < kLattice * kLattice; ++row) {
    const std::size_t begin = lattice.size();
    for (int i = 0; i < 4 * kLattice; ++i) lattice.push_back(static_cast<float>(random.between(-1, 1)));
    for (std::size_t channel = 0; channel < 4; ++channel) lattice.push_back(lattice[begin + channel]);
  }
  return lattice;
}

// Where a triangle stands in the picture. A pixel's shares of its second and third corner are linear in
// column and row.
struct PictureTriangle {
  PictureTriangle(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c)
      : corner(a), ab(b - a), ac(c - a), inverse(1 / (ab.x() * ac.y() - ab.y() * ac.x())) {}
  [[nodiscard]] float share_b_step() const { return ac.y() * inverse; }
  [[nodiscard]] float share_c_step() const { return -ab.y() * inverse; }
  [[nodiscard]] float share_b(float x, float y) const {
    return ((x - corner.x()) * ac.y() - (y - corner.y()) * ac.x()) * inverse;
  }
  [[nodiscard]] float share_c(float x, float y) const {
    return (ab.x() * (y - corner.y()) - ab.y() * (x - corner.x())) * inverse;
  }
  Eigen::Vector2f corner, ab, ac;
  float inverse;
};

// Columns of a row in which a share that is linear along it is not below 0, with one to spare: they narrow
// what was known.
class ShareSpan {
 public:
  explicit ShareSpan(float step) : inverse_(1 / step), grows_(step > 0), is_even_(step == 0) {}
  void narrow(float share_at_0, float& first, float& last) const {
    if (is_even_) return;
    const float column = -share_at_0 * inverse_;
    if (grows_) {
      first = std::max(first, column - 1);
    } else {
      last = std::min(last, column + 1);
    }
  }

 private:
  float inverse_;
  bool grows_, is_even_;
};

}  // namespace

void BoneRows::clear(int first_row, int count, int width) {
  first_row_ = first_row;
  count_ = count;
  // A packet of pairs of columns may read as far beyond the row.
  stride_ = padded(width + 1) + kTogether;
  const auto size = static_cast<std::size_t>(count) * static_cast<std::size_t>(stride_);
  depth_mm_.assign(size, kNothing_mm);
  triangles_.assign(size, -1);
}

void BoneRows::repeat_last_pixels(int width) {
  for (int row = first_row_; row < end_row(); ++row) {
    depth_mm(row)[width] = depth_mm(row)[width - 1];
    triangles(row)[width] = triangles(row)[width - 1];
  }
}

BoneView::BoneView(const geometry::TriangleMesh& mesh, std::uint64_t seed)
    : lattice_(drawn_lattice(seed)), triangles_(mesh.triangles) {
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh);
  const auto noise_at = [this](const Eigen::Vector3f& at_mm, float nodes_per_mm, std::size_t channel) {
    std::array<std::array<float, kTogether>, 3> at{};
    std::array<std::array<float, kTogether>, 4> values{};
    for (std::size_t i = 0; i < 3; ++i) at[i].fill(at_mm[static_cast<int>(i)]);
    picture_kernel().noise_at(lattice_.data(), {at[0].data(), at[1].data(), at[2].data()}, nodes_per_mm,
                              kTogether,
                              {values[0].data(), values[1].data(), values[2].data(), values[3].data()});
    return values[channel][0];
  };
  attributes_.resize(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    const Eigen::Vector3f at = mesh.vertices_mm[i].cast<float>();
    vertices_.push_back(at);
    normals_.push_back(normals[i].cast<float>());
    const float patches = noise_at(at, 1 / kRednessMm, 0) + 0.5f * noise_at(at, 2.7f / kRednessMm, 1);
    Attributes& attributes = attributes_[i];
    attributes.fill(0);
    std::copy_n(at.data(), 3, attributes.begin() + BoneAttributes::kBone);
    attributes[BoneAttributes::kRedness] = std::clamp(1.1f * patches - 0.15f, 0.0f, 0.8f);
  }
  pixels_.resize(vertices_.size());
}

void BoneView::look(const geometry::RigidTransform& camera_from_bone, const RayTable& rays,
                    const PixelArea& area) {
  area_ = area;
  const Eigen::Matrix3d rotation = camera_from_bone.matrix();
  const Eigen::Matrix3f turn = rotation.cast<float>();
  parallel_rows(static_cast<int>(vertices_.size()), [&](int first, int end) {
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
      const Eigen::Vector3d in_camera =
          rotation * vertices_[i].cast<double>() + camera_from_bone.translation_mm;
      Attributes& attributes = attributes_[i];
      Eigen::Map<Eigen::Vector3f>(attributes.data() + BoneAttributes::kCamera) = in_camera.cast<float>();
      Eigen::Map<Eigen::Vector3f>(attributes.data() + BoneAttributes::kNormal) = turn * normals_[i];
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

void BoneView::draw(BoneRows& rows) const {
  const int last_band = (rows.end_row() - 1) / kBandRows;
  for (int band = rows.first_row() / kBandRows; band <= last_band; ++band) {
    for (const Facing& facing : bands_[static_cast<std::size_t>(band)]) {
      // What goes on from the band before was drawn with it.
      const bool is_drawn = facing.first_row < band * kBandRows && band * kBandRows > rows.first_row();
      if (!is_drawn) draw_triangle(facing, rows);
    }
  }
  rows.repeat_last_pixels(area_.width);
}

void BoneView::draw_triangle(const Facing& facing, BoneRows& rows) const {
  const int first_row = std::max(rows.first_row(), facing.first_row);
  const int last_row = std::min(rows.end_row() - 1, facing.last_row);
  if (first_row > last_row) return;
  const auto& [ia, ib, ic] = triangles_[static_cast<std::size_t>(facing.triangle)];
  const Eigen::Vector2f a = pixels_[static_cast<std::size_t>(ia)], b = pixels_[static_cast<std::size_t>(ib)],
                        c = pixels_[static_cast<std::size_t>(ic)];
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()}))) - area_.left);
  const int x1 =
      std::min(area_.width - 1, static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()}))) - area_.left);
  const PictureTriangle triangle(a, b, c);
  constexpr auto kDepth = static_cast<std::size_t>(BoneAttributes::kCamera) + 2;
  const auto depth = [&](std::int32_t vertex) {
    return attributes_[static_cast<std::size_t>(vertex)][kDepth];
  };
  TriangleRow in_row;
  in_row.triangle = facing.triangle;
  in_row.share_b_step = triangle.share_b_step();
  in_row.share_c_step = triangle.share_c_step();
  in_row.depth_mm = depth(ia);
  in_row.depth_b_mm = depth(ib) - in_row.depth_mm;
  in_row.depth_c_mm = depth(ic) - in_row.depth_mm;
  const ShareSpan of_b(in_row.share_b_step), of_c(in_row.share_c_step),
      of_a(-in_row.share_b_step - in_row.share_c_step);
  const PictureKernel& kernel = picture_kernel();
  for (int row = first_row; row <= last_row; ++row) {
    const auto x = static_cast<float>(area_.left), y = static_cast<float>(row + area_.top);
    in_row.share_b = triangle.share_b(x, y);
    in_row.share_c = triangle.share_c(x, y);
    auto first = static_cast<float>(x0), last = static_cast<float>(x1);
    of_b.narrow(in_row.share_b, first, last);
    of_c.narrow(in_row.share_c, first, last);
    of_a.narrow(1 - in_row.share_b - in_row.share_c, first, last);
    if (first > last) continue;
    kernel.draw_triangle(in_row, static_cast<int>(first), static_cast<int>(last) + 1, rows.depth_mm(row),
                         rows.triangles(row));
  }
}

void BoneView::shade(int row, const int* columns, const std::int32_t* triangles, int count, float exposure,
                     Shading& memory, float* bgr) const {
  if (count == 0) return;
  constexpr int kAttributes = BoneAttributes::kCount, kNoise = 8;
  const int room = padded(count);
  memory.values_.resize(static_cast<std::size_t>((kAttributes + kNoise) * room));
  memory.columns_.resize(static_cast<std::size_t>(room));
  float* const at_columns = memory.columns_.data();
  for (int i = 0; i < room; ++i) at_columns[i] = static_cast<float>(columns[std::min(i, count - 1)]);
  const auto values = [&](int k) { return memory.values_.data() + static_cast<std::ptrdiff_t>(k) * room; };

  // All attributes are linear along a run of pixels on one triangle.
  for (int first = 0, end = 0; first < room; first = end) {
    const std::int32_t on = triangles[std::min(first, count - 1)];
    while (end < room && triangles[std::min(end, count - 1)] == on) ++end;
    const auto& [ia, ib, ic] = triangles_[static_cast<std::size_t>(on)];
    const auto va = static_cast<std::size_t>(ia), vb = static_cast<std::size_t>(ib),
               vc = static_cast<std::size_t>(ic);
    const PictureTriangle triangle(pixels_[va], pixels_[vb], pixels_[vc]);
    const auto x = static_cast<float>(area_.left), y = static_cast<float>(row + area_.top);
    const float b = triangle.share_b(x, y), c = triangle.share_c(x, y);
    const float b_step = triangle.share_b_step(), c_step = triangle.share_c_step();
    Attributes start, step;
    for (std::size_t k = 0; k < start.size(); ++k) {
      const float to_b = attributes_[vb][k] - attributes_[va][k];
      const float to_c = attributes_[vc][k] - attributes_[va][k];
      start[k] = attributes_[va][k] + b * to_b + c * to_c;
      step[k] = b_step * to_b + c_step * to_c;
    }
    for (int k = 0; k < kAttributes; ++k) {
      float* const out = values(k);
      const float from = start[static_cast<std::size_t>(k)], by = step[static_cast<std::size_t>(k)];
      for (int i = first; i < end; ++i) out[i] = from + at_columns[i] * by;
    }
  }

  BoneAttributes attributes;
  for (int k = 0; k < kAttributes; ++k) attributes.at[k] = values(k);
  const float* const* const bone = attributes.at + BoneAttributes::kBone;
  const PictureKernel& kernel = picture_kernel();
  const auto noise = [&](int first, float spacing_mm) {
    kernel.noise_at(lattice_.data(), {bone[0], bone[1], bone[2]}, 1 / spacing_mm, room,
                    {values(first), values(first + 1), values(first + 2), values(first + 3)});
  };
  constexpr int kGrain = kAttributes, kMottle = kAttributes + 4;
  noise(kGrain, kGrainMm);
  noise(kMottle, kMottleMm);
  kernel.light_bone(attributes, {values(kGrain), values(kGrain + 1), values(kGrain + 2), values(kGrain + 3)},
                    {values(kMottle), values(kMottle + 1), values(kMottle + 2), values(kMottle + 3)}, room,
                    exposure, bgr);
}

}  // namespace arthronaut::simulator
