#pragma once
/// Measures of meshes for the tests.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "fem/mesh/check_mesh.hpp"
#include "fem/mesh/mesh.hpp"

namespace muldi::fem {

inline double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (int cell = 0; cell < mesh.n_cells(); ++cell) sum += cell_volume(mesh, cell);
  return sum;
}

inline double area(const Mesh& mesh, const std::string& face_set) {
  const FaceSet* set = mesh.find_faces(face_set);
  if (set == nullptr) return -1;
  double sum = 0.0;
  for (const CellFace& face : set->faces) sum += face_area(mesh, face);
  return sum;
}

inline std::set<std::string> names(const std::vector<std::string>& list) { return {list.begin(), list.end()}; }

inline std::set<std::string> face_set_names(const Mesh& mesh) {
  std::set<std::string> all;
  for (const FaceSet& set : mesh.face_sets) all.insert(set.name);
  return all;
}

/// The mesh is sound, and its face sets are its boundary, each face once.
inline void expect_good(const Mesh& mesh) {
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.errors, std::vector<std::string>{});
  EXPECT_EQ(report.notes, std::vector<std::string>{});
  std::set<std::pair<int, int>> named;
  std::size_t n = 0;
  for (const FaceSet& set : mesh.face_sets) {
    for (const CellFace& face : set.faces) named.insert({face.cell, face.face});
    n += set.faces.size();
  }
  EXPECT_EQ(named.size(), n);
  std::set<std::pair<int, int>> boundary;
  for (const CellFace& face : boundary_faces(mesh)) boundary.insert({face.cell, face.face});
  EXPECT_EQ(named, boundary);
}

}  // namespace muldi::fem
