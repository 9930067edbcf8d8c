#pragma once
/// Where the plane faces of one mesh lie on those of another: points for integrals over what two meshes share.
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace muldi::fem {

/// Nodes of a face, going round.
using FaceNodes = std::array<int, 4>;

/// A point of a face or an edge that lies on a face of the other mesh.
struct OverlapPoint {
  double weight = 0.0;                ///< area or length that it stands for
  std::array<double, 4> own = {};     ///< shape functions of the face, or of the edge in the first two
  int other = 0;                      ///< index of the other face
  std::array<double, 4> others = {};  ///< shape functions of its nodes
};

/// Faces of another mesh, on which faces and edges are laid. Integrals of products of two shape functions are exact on
/// parallelograms.
class FaceOverlap {
 public:
  /// `X` (3 a node): positions of both meshes; `others`: faces of the other mesh; `tolerance`: how far apart what lies
  /// on one another may be. X and others must outlive the object.
  FaceOverlap(const Eigen::VectorXd& X, const std::vector<FaceNodes>& others, double tolerance);

  /// Points of a face; none if it is not plane and convex, or not wholly on others that are.
  std::optional<std::vector<OverlapPoint>> on_face(const FaceNodes& face) const;
  /// Points of the edge from a to b, which belongs to `face`; none as for faces.
  std::optional<std::vector<OverlapPoint>> on_edge(int a, int b, const FaceNodes& face) const;
  /// Whether one of the others holds the face whole.
  bool one_holds(const FaceNodes& face) const;

 private:
  using Corners = Eigen::Matrix<double, 3, 4>;
  using Polygon = std::vector<Eigen::Vector2d>;
  struct Plane;

  Eigen::Vector3d at(int node) const { return X_.segment<3>(3 * static_cast<Eigen::Index>(node)); }
  Corners corners(const FaceNodes& face) const;
  /// Indices of the others that may touch the face.
  std::vector<int> near(const Corners& face) const;
  std::optional<Plane> plane_of(const Corners& face) const;
  /// The other face in the plane of a face, counter-clockwise; none if it does not lie in it.
  std::optional<Polygon> outline(const Plane& plane, const Corners& face) const;
  void add_points(const Polygon& polygon, const Plane& plane, const Corners& face, int other,
                  std::vector<OverlapPoint>& points) const;

  const Eigen::VectorXd& X_;
  const std::vector<FaceNodes>& others_;
  double tolerance_;
};

}  // namespace muldi::fem
