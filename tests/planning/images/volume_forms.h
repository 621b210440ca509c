// The same volume in every format that is read, written here by hand: the readers are not tested with writers
// of their own.
#pragma once

#include <zlib.h>

#include <bit>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "planning/images/volume.h"
#include "tests/planning/bones/mesh_text_forms.h"

namespace arthronaut::test {

// Oblique in all axes, another spacing along each, values that tell every voxel from every other.
inline images::Volume oblique_volume() {
  images::Volume volume;
  volume.size = {7, 5, 4};
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-0.7, Eigen::Vector3d(1, 2, 3).normalized()))
                                     .toRotationMatrix();
  volume.lps_from_index.linear() = turned * Eigen::Vector3d(0.5, 0.75, 3.25).asDiagonal();
  volume.lps_from_index.translation() = Eigen::Vector3d(-61.5, 22.25, -130.5);
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 7; ++i) volume.values.push_back(static_cast<float>(-1000 + 100 * k + 10 * j + i));
    }
  }
  return volume;
}

inline std::string deflated(const std::string& bytes, bool gzip) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string result(compressBound(bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  ::deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

inline std::string shorts(const images::Volume& volume, std::endian order) {
  std::string bytes;
  for (const float v : volume.values) bytes += bytes_of(static_cast<std::int16_t>(v), order);
  return bytes;
}

// With an sform, or with a qform instead.
inline std::string nifti(const images::Volume& volume, std::endian order, bool as_qform = false) {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    const std::string bytes = bytes_of(value, order);
    header.replace(at, bytes.size(), bytes);
  };
  put(0, std::int32_t{348});
  const Eigen::Affine3d ras = Eigen::Scaling(-1.0, -1.0, 1.0) * volume.lps_from_index;
  put(40, std::int16_t{3});
  for (int i = 0; i < 3; ++i) {
    put(42 + 2 * static_cast<std::size_t>(i), static_cast<std::int16_t>(volume.size[i]));
    put(80 + 4 * static_cast<std::size_t>(i), static_cast<float>(volume.spacing_mm()[i]));
  }
  put(70, std::int16_t{4});
  put(72, std::int16_t{16});
  put(108, 352.0F);
  put(112, 1.0F);
  header[123] = 2;
  if (as_qform) {
    put(252, std::int16_t{1});
    put(76, 1.0F);
    const Eigen::Matrix3d rotation = ras.linear() * volume.spacing_mm().cwiseInverse().asDiagonal();
    Eigen::Quaterniond q(rotation);
    if (q.w() < 0) q.coeffs() *= -1;
    put(256, static_cast<float>(q.x()));
    put(260, static_cast<float>(q.y()));
    put(264, static_cast<float>(q.z()));
    for (int i = 0; i < 3; ++i)
      put(268 + 4 * static_cast<std::size_t>(i), static_cast<float>(ras.translation()[i]));
  } else {
    put(254, std::int16_t{1});
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        put(280 + static_cast<std::size_t>(16 * row + 4 * column), static_cast<float>(ras(row, column)));
      }
    }
  }
  header.replace(344, 4, std::string("n+1\0", 4));
  return header + shorts(volume, order);
}

inline std::string joined(const Eigen::Vector3d& v, const char* separator) {
  return number(v.x()) + separator + number(v.y()) + separator + number(v.z());
}

inline std::string nrrd(const images::Volume& volume, bool ras, bool gzip) {
  const Eigen::Vector3d sign = ras ? Eigen::Vector3d(-1, -1, 1) : Eigen::Vector3d(1, 1, 1);
  std::string header = "NRRD0004\n# by hand\ntype: short\ndimension: 3\nspace: " +
                       std::string(ras ? "right-anterior-superior" : "left-posterior-superior") +
                       "\nsizes: 7 5 4\nspace directions:";
  for (int axis = 0; axis < 3; ++axis) {
    header += " (" + joined(volume.lps_from_index.linear().col(axis).cwiseProduct(sign), ",") + ")";
  }
  header += "\nkinds: domain domain domain\nendian: little\nencoding: " + std::string(gzip ? "gzip" : "raw") +
            "\nspace origin: (" + joined(volume.lps_from_index.translation().cwiseProduct(sign), ",") +
            ")\nkey:=value\n\n";
  const std::string data = shorts(volume, std::endian::little);
  return header + (gzip ? deflated(data, true) : data);
}

inline std::string metaimage(const images::Volume& volume, bool compressed) {
  std::string header =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\nCompressedData = " +
      std::string(compressed ? "True" : "False") + "\nTransformMatrix =";
  const Eigen::Vector3d spacing = volume.spacing_mm();
  for (int axis = 0; axis < 3; ++axis) {
    header += " " + joined(volume.lps_from_index.linear().col(axis) / spacing[axis], " ");
  }
  header += "\nOffset = " + joined(volume.lps_from_index.translation(), " ") +
            "\nElementSpacing = " + joined(spacing, " ") +
            "\nDimSize = 7 5 4\nElementType = MET_SHORT\nElementDataFile = LOCAL\n";
  const std::string data = shorts(volume, std::endian::big);
  return header + (compressed ? deflated(data, false) : data);
}

inline std::map<std::string, std::string> all_volume_forms(const images::Volume& volume) {
  return {{"sform.nii", nifti(volume, std::endian::little)},
          {"big.nii", nifti(volume, std::endian::big)},
          {"qform.nii", nifti(volume, std::endian::little, true)},
          {"packed.nii.gz", deflated(nifti(volume, std::endian::little), true)},
          {"lps.nrrd", nrrd(volume, false, false)},
          {"ras.nrrd", nrrd(volume, true, true)},
          {"plain.mha", metaimage(volume, false)},
          {"packed.mha", metaimage(volume, true)}};
}

// One slice as an explicit little-endian DICOM file with what a CT of the knee says, and nothing more.
struct DicomSliceForm {
  std::string series_uid = "1.2.3.4", modality = "CT", echo_time, gantry_tilt, instance_number;
  Eigen::Vector3d position_mm, along_columns{1, 0, 0}, along_rows{0, 1, 0};
  double column_spacing_mm = 0.5, row_spacing_mm = 0.75;
  int columns = 7, rows = 5;
  double slope = 1, intercept = -1024;
  std::vector<std::int16_t> stored;
};

inline std::string dicom(const DicomSliceForm& slice) {
  const auto element = [](std::uint16_t group, std::uint16_t number_in_group, const std::string& type,
                          std::string value) {
    if (value.size() % 2 != 0) value += type == "UI" ? '\0' : ' ';
    std::string bytes =
        bytes_of(group, std::endian::little) + bytes_of(number_in_group, std::endian::little) + type;
    if (type == "OW" || type == "OB") {
      bytes += std::string(2, '\0') + bytes_of(static_cast<std::uint32_t>(value.size()), std::endian::little);
    } else {
      bytes += bytes_of(static_cast<std::uint16_t>(value.size()), std::endian::little);
    }
    return bytes + value;
  };
  const auto short_value = [](int value) {
    return bytes_of(static_cast<std::uint16_t>(value), std::endian::little);
  };
  std::string pixels;
  for (const auto v : slice.stored) pixels += bytes_of(v, std::endian::little);
  const std::string ct_storage = "1.2.840.10008.5.1.4.1.1.2";
  const std::string meta = element(2, 1, "OB", std::string("\0\1", 2)) + element(2, 2, "UI", ct_storage) +
                           element(2, 3, "UI", "1.2.3.9") + element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  std::string data = element(8, 0x16, "UI", ct_storage) + element(8, 0x60, "CS", slice.modality) +
                     element(0x18, 0x50, "DS", "99");  // a slice thickness that must not be believed
  if (!slice.echo_time.empty()) data += element(0x18, 0x81, "DS", slice.echo_time);
  if (!slice.gantry_tilt.empty()) data += element(0x18, 0x1120, "DS", slice.gantry_tilt);
  data +=
      element(0x20, 0x0e, "UI", slice.series_uid) + element(0x20, 0x11, "IS", "3") +
      (slice.instance_number.empty() ? "" : element(0x20, 0x13, "IS", slice.instance_number)) +
      element(0x20, 0x32, "DS", joined(slice.position_mm, "\\")) +
      element(0x20, 0x37, "DS", joined(slice.along_columns, "\\") + "\\" + joined(slice.along_rows, "\\")) +
      element(0x28, 2, "US", short_value(1)) + element(0x28, 4, "CS", "MONOCHROME2") +
      element(0x28, 0x10, "US", short_value(slice.rows)) +
      element(0x28, 0x11, "US", short_value(slice.columns)) +
      element(0x28, 0x30, "DS", number(slice.row_spacing_mm) + "\\" + number(slice.column_spacing_mm)) +
      element(0x28, 0x100, "US", short_value(16)) + element(0x28, 0x101, "US", short_value(16)) +
      element(0x28, 0x102, "US", short_value(15)) + element(0x28, 0x103, "US", short_value(1)) +
      element(0x28, 0x1052, "DS", number(slice.intercept)) +
      element(0x28, 0x1053, "DS", number(slice.slope)) + element(0x7fe0, 0x10, "OW", pixels);
  return std::string(128, '\0') + "DICM" +
         element(2, 0, "UL", bytes_of(static_cast<std::uint32_t>(meta.size()), std::endian::little)) + meta +
         data;
}

// The slices of the volume, in file names that do not tell their order.
inline std::map<std::string, DicomSliceForm> dicom_slices(const images::Volume& volume) {
  std::map<std::string, DicomSliceForm> slices;
  const Eigen::Vector3d spacing = volume.spacing_mm();
  for (int k = 0; k < volume.size.z(); ++k) {
    DicomSliceForm slice;
    slice.position_mm = volume.lps_from_index * Eigen::Vector3d(0, 0, k);
    slice.along_columns = volume.lps_from_index.linear().col(0) / spacing.x();
    slice.along_rows = volume.lps_from_index.linear().col(1) / spacing.y();
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 7; ++i)
        slice.stored.push_back(static_cast<std::int16_t>((volume.at(i, j, k) + 1024) / 2));
    }
    slice.slope = 2;
    slices["image" + std::to_string((k * 7 + 3) % 5) + ".dcm"] = slice;
  }
  return slices;
}

}  // namespace arthronaut::test
