#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include "core/geometry/simplex.h"

namespace lamella::test {

/// What another solver may write on a box: hexahedra, in units of its own, numbers of 32 bits.
struct ForeignBox {
  std::array<int, 3> cells{5, 5, 5};
  Vec<3> low = Vec<3>::Zero(), high = Vec<3>::Ones();  ///< mm
  double unit = 1;                                     ///< mm in the unit of the file
  std::function<double(const Vec<3>&)> number = [](const Vec<3>& x) { return x[0]; };
  std::function<double(const Vec<3>&)> speed = [](const Vec<3>& x) { return x[1] * (1 - x[1]); };
  bool at_points = false;  ///< else at the cells
};

/// "T", the number, and "U", the speed along x, in text: as VTU or, by the ending .vtk, in VTK's
/// legacy format.
inline void write_result(const std::filesystem::path& file, const ForeignBox& box) {
  const auto [nx, ny, nz] = box.cells;
  const std::array<int, 3>& n = box.cells;
  std::ostringstream points, connectivity, numbers, speeds;
  std::size_t values = 0;
  const auto place = [&](double i, double j, double k) -> Vec<3> {
    const Vec<3> t(i / n[0], j / n[1], k / n[2]);
    return box.low + t.cwiseProduct(box.high - box.low);
  };
  const auto value = [&](const Vec<3>& x) {
    numbers << box.number(x) << ' ';
    speeds << box.speed(x) << " 0 0 ";
    ++values;
  };
  for (int i = 0; i <= n[0]; ++i)
    for (int j = 0; j <= n[1]; ++j)
      for (int k = 0; k <= n[2]; ++k) {
        const Vec<3> x = place(i, j, k);
        points << (box.unit * x).transpose() << '\n';
        if (box.at_points) value(x);
      }
  const auto at = [&](int i, int j, int k) { return (i * (n[1] + 1) + j) * (n[2] + 1) + k; };
  const bool legacy = file.extension() == ".vtk";
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k) {
        if (legacy) connectivity << "8 ";
        for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 0, 0},
                                                                     {1, 0, 0},
                                                                     {1, 1, 0},
                                                                     {0, 1, 0},
                                                                     {0, 0, 1},
                                                                     {1, 0, 1},
                                                                     {1, 1, 1},
                                                                     {0, 1, 1}})
          connectivity << at(i + a, j + b, k + c) << ' ';
        if (!box.at_points) value(place(i + 0.5, j + 0.5, k + 0.5));
      }
  const int count = nx * ny * nz, nodes = (nx + 1) * (ny + 1) * (nz + 1);
  const auto repeated = [&](const std::string& what) {
    std::string all;
    for (int c = 0; c < count; ++c) all += what;
    return all;
  };
  std::ofstream to(file);
  if (legacy) {
    to << "# vtk DataFile Version 2.0\nby another solver\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS "
       << nodes << " float\n"
       << points.str() << "CELLS " << count << ' ' << 9 * count << '\n'
       << connectivity.str() << "\nCELL_TYPES " << count << '\n'
       << repeated("12 ") << '\n'
       << (box.at_points ? "POINT_DATA " : "CELL_DATA ") << values << "\nFIELD attributes 2\nT 1 "
       << values << " float\n"
       << numbers.str() << "\nU 3 " << values << " float\n"
       << speeds.str() << '\n';
    return;
  }
  std::string offsets;
  for (int c = 1; c <= count; ++c) offsets += std::to_string(8 * c) + ' ';
  const std::string data = box.at_points ? "PointData" : "CellData";
  to << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">"
     << "<UnstructuredGrid><Piece NumberOfPoints=\"" << nodes << "\" NumberOfCells=\"" << count
     << "\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">" << points.str()
     << "</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\">"
     << connectivity.str() << "</DataArray><DataArray type=\"Int32\" Name=\"offsets\">" << offsets
     << "</DataArray><DataArray type=\"UInt8\" Name=\"types\">" << repeated("12 ")
     << "</DataArray></Cells><" << data << "><DataArray type=\"Float32\" Name=\"T\">"
     << numbers.str()
     << "</DataArray><DataArray type=\"Float32\" Name=\"U\" NumberOfComponents=\"3\">"
     << speeds.str() << "</DataArray></" << data << "></Piece></UnstructuredGrid></VTKFile>\n";
}

}  // namespace lamella::test
