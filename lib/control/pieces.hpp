#pragma once
/// The pieces of a model's terms (model/expansion.hpp) in the coordinates of a chart.
#include <Eigen/Core>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace muldi::control {

/// What one piece depends on.
struct Piece {
  std::vector<model::LinearPoint> points = {};
  std::vector<int> entries = {};
  int rate = -1;
  const model::EndCoordinate* coordinate = nullptr;  ///< see end_pieces.hpp; its unknowns are `entries`
  int size = 0;                                      ///< number m of forms
  std::vector<int> columns = {};                     ///< coordinates theta that they depend on
  std::vector<int> controls = {};                    ///< of the model

  /// True if the forms are linear in q.
  bool is_linear() const { return rate < 0 && coordinate == nullptr; }
  /// Of linear pieces: the forms of a configuration, a velocity or a direction (without the constants of points).
  void apply(const Eigen::VectorXd& q, Eigen::Ref<Eigen::VectorXd> out) const;
  /// f += forms^T local, of linear pieces.
  void add_transposed(const Eigen::Ref<const Eigen::VectorXd>& local, Eigen::VectorXd& f) const;
  /// forms D on the piece's columns (m, columns), of linear pieces and rates.
  void project(const Eigen::MatrixXd& D, Eigen::MatrixXd& out) const;
};

/// A linear point in a chart: the columns that it depends on.
std::vector<int> columns_of(const model::LinearPoint& point, const model::Chart& chart);
/// out = A D of a point on all columns (3, n_v).
void project_point(const model::LinearPoint& point, const Eigen::MatrixXd& D, Eigen::Ref<Eigen::MatrixXd> out);

/// Constant mass between two triples of q.
struct TripleMass {
  int row = 0;
  int column = 0;
  double mass = 0.0;
  const std::vector<int>* columns = nullptr;  ///< coordinates that move the column's triple
};

struct PieceList {
  std::vector<Piece> pieces = {};
  std::vector<TripleMass> mass = {};
  std::vector<std::vector<int>> cliques = {};  ///< sets of coordinates that appear together
  std::vector<std::string> refused = {};       ///< terms without an expansion

  /// out = M x for the constant part of the mass; x, out (n_q, any).
  void multiply_mass(const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> out) const;
  /// The same of a D or A of a chart (n_q, n_v).
  void multiply_mass_of_chart(const Eigen::MatrixXd& D, Eigen::MatrixXd& out) const;
};

/// Finds the pieces by one expansion at `at`. `squared` as ExpansionRequest.
PieceList list_pieces(const model::Model& model, const model::Chart& chart, const model::IntervalPoint& at,
                      std::span<const double> squared);

/// The pieces of one term, without its mass.
PieceList list_pieces_of(const model::IntervalTerm& term, const model::Chart& chart, const model::IntervalPoint& at,
                         std::span<const double> squared);

/// A name for a term in messages.
std::string name_of_term(const model::IntervalTerm& term);

}  // namespace muldi::control
