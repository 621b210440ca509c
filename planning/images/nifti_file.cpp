#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/error.h"
#include "planning/images/volume_bytes.h"

namespace arthronaut::images {

namespace {

// Where the fields of the two versions of the header are: nifti1.h and nifti2.h of the NIfTI data format
// working group.
struct Layout {
  std::size_t header_bytes, dim, dim_bytes, datatype, pixdim, vox_offset, slope, intercept, units, qform,
      sform, quaternion, q_offset, srow, real_bytes;
};
constexpr Layout kNifti1{348, 40, 2, 70, 76, 108, 112, 116, 123, 252, 254, 256, 268, 280, 4};
constexpr Layout kNifti2{540, 16, 8, 12, 104, 168, 176, 184, 500, 344, 348, 352, 376, 400, 8};

class Header {
 public:
  Header(const std::filesystem::path& file, std::string_view text) : text_(text) {
    for (const Layout& layout : {kNifti1, kNifti2}) {
      for (const std::endian order : {std::endian::little, std::endian::big}) {
        if (text.size() >= 4 &&
            decoded(Scalar::Int32, order, text.data()) == static_cast<double>(layout.header_bytes)) {
          layout_ = layout;
          order_ = order;
        }
      }
    }
    if (layout_.header_bytes == 0) throw InvalidInput(file, "byte 0", "is not a NIfTI file");
    if (text.size() < layout_.header_bytes) throw InvalidInput(file, "", "ends within its header");
  }

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] std::endian order() const { return order_; }
  [[nodiscard]] double dim(std::size_t i) const {
    return decoded(is_2() ? Scalar::Int64 : Scalar::Int16, order_,
                   text_.data() + layout_.dim + i * layout_.dim_bytes);
  }
  [[nodiscard]] double real(std::size_t offset, std::size_t i = 0) const {
    return decoded(is_2() ? Scalar::Float64 : Scalar::Float32, order_,
                   text_.data() + offset + i * layout_.real_bytes);
  }
  [[nodiscard]] double code(std::size_t offset) const {
    return decoded(is_2() ? Scalar::Int32 : Scalar::Int16, order_, text_.data() + offset);
  }
  [[nodiscard]] int datatype() const {
    return static_cast<int>(decoded(Scalar::Int16, order_, text_.data() + layout_.datatype));
  }
  [[nodiscard]] double vox_offset() const {
    return is_2() ? decoded(Scalar::Int64, order_, text_.data() + layout_.vox_offset)
                  : real(layout_.vox_offset);
  }
  [[nodiscard]] int units() const {
    return is_2() ? static_cast<int>(code(layout_.units)) : static_cast<unsigned char>(text_[layout_.units]);
  }

 private:
  [[nodiscard]] bool is_2() const { return layout_.header_bytes == kNifti2.header_bytes; }

  std::string_view text_;
  Layout layout_{};
  std::endian order_ = std::endian::little;
};

Scalar scalar_of(const std::filesystem::path& file, int datatype) {
  switch (datatype) {
    case 2:
      return Scalar::UInt8;
    case 4:
      return Scalar::Int16;
    case 8:
      return Scalar::Int32;
    case 16:
      return Scalar::Float32;
    case 64:
      return Scalar::Float64;
    case 256:
      return Scalar::Int8;
    case 512:
      return Scalar::UInt16;
    case 768:
      return Scalar::UInt32;
    case 1024:
      return Scalar::Int64;
    case 1280:
      return Scalar::UInt64;
    default:
      throw InvalidInput(file, "datatype",
                         "is " + std::to_string(datatype) + ", which holds no single numbers");
  }
}

// The rotation of the quaternion (a, b, c, d), of which a is implied, and the handedness in pixdim[0].
Eigen::Affine3d from_qform(const Header& header) {
  const Layout& at = header.layout();
  const double b = header.real(at.quaternion, 0), c = header.real(at.quaternion, 1),
               d = header.real(at.quaternion, 2);
  const Eigen::Quaterniond q(std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d)), b, c, d);
  const double handedness = header.real(at.pixdim, 0) < 0 ? -1 : 1;
  Eigen::Affine3d ras_from_index = Eigen::Affine3d::Identity();
  ras_from_index.linear() = q.normalized().toRotationMatrix();
  for (int i = 0; i < 3; ++i)
    ras_from_index.linear().col(i) *= header.real(at.pixdim, static_cast<std::size_t>(i) + 1);
  ras_from_index.linear().col(2) *= handedness;
  for (int i = 0; i < 3; ++i)
    ras_from_index.translation()[i] = header.real(at.q_offset, static_cast<std::size_t>(i));
  return ras_from_index;
}

Eigen::Affine3d from_sform(const Header& header) {
  Eigen::Affine3d ras_from_index = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      ras_from_index(row, column) =
          header.real(header.layout().srow, static_cast<std::size_t>(4 * row + column));
    }
  }
  return ras_from_index;
}

// The codes that say what a form's axes are (NIFTI_XFORM_*): those of the scanner and of another picture of
// the same patient lie in the patient, those of an atlas (Talairach, MNI, another template) do not: what was
// brought into one of them was stretched to fit.
constexpr double kScanner = 1, kAligned = 2;
bool is_of_patient(double code) { return code == kScanner || code == kAligned; }

// A form that scales otherwise than the voxels' own size has stretched the patient, or one of the two is
// wrong. A size of 0 says nothing.
void refuse_other_scale(const std::filesystem::path& file, const Header& header,
                        const Eigen::Affine3d& ras_from_index) {
  constexpr double kRounding = 0.01;
  for (int i = 0; i < 3; ++i) {
    const double said = std::abs(header.real(header.layout().pixdim, static_cast<std::size_t>(i) + 1)),
                 formed = ras_from_index.linear().col(i).norm();
    if (!(said > 0) || std::abs(formed - said) <= kRounding * said) continue;
    throw InvalidInput(file, "sform",
                       files::format("makes voxels of %.4g along axis %d, pixdim of %.4g: one of them would "
                                     "give a bone of the wrong size",
                                     formed, i + 1, said));
  }
}

// The sform before the qform, as the format has it, but for one that is not the patient's.
Eigen::Affine3d ras_from_index_of(const std::filesystem::path& file, const Header& header) {
  const double sform = header.code(header.layout().sform), qform = header.code(header.layout().qform);
  if (is_of_patient(sform)) {
    const Eigen::Affine3d ras_from_index = from_sform(header);
    refuse_other_scale(file, header, ras_from_index);
    return ras_from_index;
  }
  if (is_of_patient(qform)) return from_qform(header);
  if (sform > 0 || qform > 0)
    throw InvalidInput(
        file, sform > 0 ? "sform_code" : "qform_code",
        files::format("is %g: its axes are those of an atlas or template, not of the patient, whose "
                      "bones they stretch; export the volume in the scanner's own space",
                      sform > 0 ? sform : qform));
  throw InvalidInput(file, "", "does not say how it lies in the patient (no sform, no qform)");
}

double mm_per_unit(const std::filesystem::path& file, const Header& header) {
  switch (header.units() & 7) {
    case 0:  // not said: mm in practice
    case 2:
      return 1;
    case 1:
      return 1000;
    case 3:
      return 0.001;
    default:
      throw InvalidInput(file, "xyzt_units", "is no unit of length");
  }
}

}  // namespace

Volume parse_nifti(const std::filesystem::path& file, std::string_view text, std::size_t most_bytes) {
  const bool is_packed = text.starts_with("\x1f\x8b");
  // The header is judged before the rest is unpacked.
  const std::string start = is_packed ? inflated_start(file, text, kNifti2.header_bytes) : "";
  const Header header(file, is_packed ? std::string_view(start) : text);
  Volume volume;
  volume.format = "NIfTI";
  const double dimension = header.dim(0);
  if (!(dimension >= 3 && dimension <= 7))
    throw InvalidInput(file, "dim[0]", "is not a volume of three dimensions");
  for (int i = 1; i <= static_cast<int>(dimension); ++i) {
    const double n = header.dim(static_cast<std::size_t>(i));
    if (!(n >= 1 && n <= 65536))
      throw InvalidInput(file, "dim[" + std::to_string(i) + "]", "is out of range");
    if (i > 3 && n != 1) throw InvalidInput(file, "", "holds several volumes: export the one that is meant");
    if (i <= 3) volume.size[i - 1] = static_cast<int>(n);
  }
  Eigen::Affine3d ras_from_index = ras_from_index_of(file, header);
  ras_from_index = Eigen::Scaling(mm_per_unit(file, header)) * ras_from_index;
  volume.lps_from_index = Eigen::Scaling(-1.0, -1.0, 1.0) * ras_from_index;

  Samples samples;
  samples.type = scalar_of(file, header.datatype());
  samples.order = header.order();
  const double slope = header.real(header.layout().slope), intercept = header.real(header.layout().intercept);
  // A slope of 0 says that there is none.
  if (std::isfinite(slope) && std::isfinite(intercept) && slope != 0) {
    samples.slope = slope;
    samples.intercept = intercept;
  }
  const std::size_t width = bytes_per(samples.type);
  const std::size_t bytes = width * checked_voxel_count(file, volume.size, width, most_bytes);
  const double offset = header.vox_offset();
  // What lies before the voxels, extensions of the header, is never large.
  constexpr double kMostBeforeVoxels_bytes = 1 << 24;
  if (!(offset >= static_cast<double>(header.layout().header_bytes)) || offset > kMostBeforeVoxels_bytes)
    throw InvalidInput(file, "vox_offset", "lies outside of the file (a pair of .hdr and .img is not read)");
  const auto first = static_cast<std::size_t>(offset);
  std::string whole;
  if (is_packed) {
    whole = inflated(file, text, most_stored_bytes(first + bytes));
    text = whole;
  }
  if (first > text.size())
    throw InvalidInput(file, "vox_offset", "lies outside of the file (a pair of .hdr and .img is not read)");
  set_values(volume, file, text.substr(first), samples);
  finish(volume, file);
  return volume;
}

}  // namespace arthronaut::images
