// The same mesh in every format and encoding that is read, written here by hand: the readers are not tested
// with writers of their own.
#pragma once

#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::test {

template <typename T>
std::string bytes_of(T value, std::endian order) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (order != std::endian::native) bytes.assign(bytes.rbegin(), bytes.rend());
  return bytes;
}

inline std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}
inline std::string numbers(const Eigen::Vector3d& v) {
  return number(v.x()) + " " + number(v.y()) + " " + number(v.z());
}

inline std::string text_stl(const geometry::TriangleMesh& mesh, const std::string& title = "bone") {
  std::string text = "solid " + title + "\n";
  for (const auto& t : mesh.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const auto v : t) text += "   vertex " + numbers(mesh.vertices_mm[v]) + "\n";
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid " + title + "\n";
}

inline std::string binary_stl(const geometry::TriangleMesh& mesh, std::string header = "made by hand") {
  header.resize(80, ' ');
  std::string bytes =
      header + bytes_of(static_cast<std::uint32_t>(mesh.triangles.size()), std::endian::little);
  for (const auto& t : mesh.triangles) {
    bytes += std::string(12, '\0');
    for (const auto v : t) {
      for (int i = 0; i < 3; ++i)
        bytes += bytes_of(static_cast<float>(mesh.vertices_mm[v][i]), std::endian::little);
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline std::string ply_header(const geometry::TriangleMesh& mesh, const std::string& format,
                              const std::string& comment) {
  return "ply\nformat " + format + " 1.0\n" + (comment.empty() ? "" : "comment " + comment + "\n") +
         "element vertex " + std::to_string(mesh.vertices_mm.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar quality\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string text_ply(const geometry::TriangleMesh& mesh, const std::string& comment = "") {
  std::string text = ply_header(mesh, "ascii", comment);
  for (const auto& v : mesh.vertices_mm) text += numbers(v) + " 255\n";
  for (const auto& t : mesh.triangles) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

inline std::string binary_ply(const geometry::TriangleMesh& mesh, std::endian order,
                              const std::string& comment = "") {
  std::string bytes =
      ply_header(mesh, order == std::endian::little ? "binary_little_endian" : "binary_big_endian", comment);
  for (const auto& v : mesh.vertices_mm) {
    for (int i = 0; i < 3; ++i) bytes += bytes_of(static_cast<float>(v[i]), order);
    bytes += '\xff';
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    for (const auto v : t) bytes += bytes_of(v, order);
  }
  return bytes;
}

inline std::string obj(const geometry::TriangleMesh& mesh, const std::string& comment = "") {
  std::string text = "# " + comment + "\no bone\n";
  for (const auto& v : mesh.vertices_mm) text += "v " + numbers(v) + "\n";
  text += "vn 0 0 1\n";
  for (const auto& t : mesh.triangles) {
    text += "f";
    for (const auto v : t) text += " " + std::to_string(v + 1) + "//1";
    text += "\n";
  }
  return text;
}

// Version 4: one list of counts and corners. Version 5: offsets and connectivity.
inline std::string legacy_vtk(const geometry::TriangleMesh& mesh, bool binary, int version,
                              const std::string& title = "bone") {
  const auto list = [&](const auto& values, auto example) {
    std::string text;
    for (const auto value : values) {
      text += binary ? bytes_of(static_cast<decltype(example)>(value), std::endian::big)
                     : number(static_cast<double>(value)) + " ";
    }
    return text + "\n";
  };
  std::vector<double> coordinates;
  for (const auto& v : mesh.vertices_mm) coordinates.insert(coordinates.end(), v.data(), v.data() + 3);
  std::string text = "# vtk DataFile Version " + std::to_string(version) + (version >= 5 ? ".1" : ".2") +
                     "\n" + title + "\n" + (binary ? "BINARY" : "ASCII") + "\nDATASET POLYDATA\nPOINTS " +
                     std::to_string(mesh.vertices_mm.size()) + " float\n" + list(coordinates, 0.0F);
  const std::size_t count = mesh.triangles.size();
  if (version >= 5) {
    std::vector<std::int64_t> offsets{0}, indices;
    for (const auto& t : mesh.triangles) {
      indices.insert(indices.end(), t.begin(), t.end());
      offsets.push_back(static_cast<std::int64_t>(indices.size()));
    }
    text += "METADATA\nINFORMATION 0\n\nPOLYGONS " + std::to_string(offsets.size()) + " " +
            std::to_string(indices.size()) + "\nOFFSETS vtktypeint64\n" + list(offsets, std::int64_t{0}) +
            "CONNECTIVITY vtktypeint64\n" + list(indices, std::int64_t{0});
  } else {
    std::vector<std::int32_t> cells;
    for (const auto& t : mesh.triangles) cells.insert(cells.end(), {3, t[0], t[1], t[2]});
    text += "POLYGONS " + std::to_string(count) + " " + std::to_string(4 * count) + "\n" +
            list(cells, std::int32_t{0});
  }
  return text + "POINT_DATA " + std::to_string(mesh.vertices_mm.size()) + "\n";
}

inline std::string vtp(const geometry::TriangleMesh& mesh, const std::string& comment = "") {
  std::string points, indices, offsets;
  for (const auto& v : mesh.vertices_mm) points += numbers(v) + " ";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const auto v : mesh.triangles[t]) indices += std::to_string(v) + " ";
    offsets += std::to_string(3 * (t + 1)) + " ";
  }
  return "<?xml version=\"1.0\"?>\n" + (comment.empty() ? "" : "<!-- " + comment + " -->\n") +
         "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n<Piece "
         "NumberOfPoints=\"" +
         std::to_string(mesh.vertices_mm.size()) + "\" NumberOfPolys=\"" +
         std::to_string(mesh.triangles.size()) +
         "\">\n<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
         "</DataArray></Points>\n<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
         indices + "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" + offsets +
         "</DataArray></Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

// File name -> contents. `note` goes where the format has room for a comment.
inline std::map<std::string, std::string> all_forms(const geometry::TriangleMesh& mesh,
                                                    const std::string& note = "") {
  return {{"text.stl", text_stl(mesh, "bone " + note)},
          {"binary.stl", binary_stl(mesh, "made by hand " + note)},
          {"text.ply", text_ply(mesh, note)},
          {"little.ply", binary_ply(mesh, std::endian::little, note)},
          {"big.ply", binary_ply(mesh, std::endian::big, note)},
          {"bone.obj", obj(mesh, note)},
          {"text4.vtk", legacy_vtk(mesh, false, 4, "bone " + note)},
          {"binary4.vtk", legacy_vtk(mesh, true, 4, "bone " + note)},
          {"text5.vtk", legacy_vtk(mesh, false, 5, "bone " + note)},
          {"binary5.vtk", legacy_vtk(mesh, true, 5, "bone " + note)},
          {"bone.vtp", vtp(mesh, note)}};
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace arthronaut::test
