#pragma once
/// Small sets of hexahedra with one material, evaluated by the element kernels: what the tests of the kernels share.
#include <Eigen/Dense>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "fem/kernel/element_kernels.hpp"

namespace muldi::test {

inline constexpr double eps0_si = 8.8542e-12;  ///< the same number in mm, g, ms, A

/// Elements and reference positions (3 a node).
struct FemPatch {
  std::vector<std::array<int, 8>> elements;
  Eigen::VectorXd X;

  int n_nodes() const { return static_cast<int>(X.size()) / 3; }
  int n_elements() const { return static_cast<int>(elements.size()); }
  Eigen::Vector3d node(int n) const { return X.segment<3>(3 * n); }
};

/// One cube of side 1 with a corner at the origin.
inline FemPatch unit_cube() {
  FemPatch patch{.elements = {{0, 1, 2, 3, 4, 5, 6, 7}}, .X = Eigen::VectorXd(24)};
  patch.X << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1;
  return patch;
}

/// The unit cube cut into seven distorted elements about an inner one (the patch of MacNeal and Harder, Finite Elem.
/// Anal. Des. 1, 1985); inner nodes 8 to 15.
inline FemPatch seven_elements() {
  FemPatch patch = unit_cube();
  patch.X.conservativeResize(48);
  patch.X.tail(24) << .249, .342, .192, .826, .288, .288, .850, .649, .263, .273, .750, .230, .320, .186, .643, .677,
      .305, .683, .788, .693, .644, .165, .745, .702;
  patch.elements = {{8, 9, 10, 11, 12, 13, 14, 15}, {0, 1, 2, 3, 8, 9, 10, 11},  {12, 13, 14, 15, 4, 5, 6, 7},
                    {0, 1, 9, 8, 4, 5, 13, 12},     {1, 2, 10, 9, 5, 6, 14, 13}, {3, 11, 10, 2, 7, 15, 14, 6},
                    {0, 8, 11, 3, 4, 12, 15, 7}};
  return patch;
}

/// n^3 elements of the unit cube, inner nodes moved by up to a fifth of a side.
inline FemPatch cube_of(int n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.2 / n, 0.2 / n);
  const int line = n + 1;
  FemPatch patch{.elements = {}, .X = Eigen::VectorXd(3 * line * line * line)};
  for (int k = 0; k < patch.n_nodes(); ++k) {
    const int at[3] = {k % line, k / line % line, k / line / line};
    for (int i = 0; i < 3; ++i) {
      const bool inner = at[i] > 0 && at[i] < n;
      patch.X[3 * k + i] = static_cast<double>(at[i]) / n + (inner ? noise(random) : 0.0);
    }
  }
  for (int e = 0; e < n * n * n; ++e) {
    const int a = e % n + line * (e / n % n + line * (e / n / n));
    const int above = a + line * line;
    patch.elements.push_back({a, a + 1, a + 1 + line, a + line, above, above + 1, above + 1 + line, above + line});
  }
  return patch;
}

/// A state of a patch; empty vectors are absent.
struct FemState {
  Eigen::VectorXd x, v, phi, pressure;

  fem::ElementFields fields(const FemPatch& patch) const {
    const auto pointer = [](const Eigen::VectorXd& of) { return of.size() == 0 ? nullptr : of.data(); };
    return {.X = patch.X.data(), .x = x.data(), .v = pointer(v), .phi = pointer(phi), .pressure = pointer(pressure)};
  }
  fem::FieldDirections directions() const {
    const auto pointer = [](const Eigen::VectorXd& of) { return of.size() == 0 ? nullptr : of.data(); };
    return {.x = pointer(x), .v = pointer(v), .phi = pointer(phi), .pressure = pointer(pressure)};
  }
};

inline Eigen::VectorXd random_values(std::mt19937& random, Eigen::Index n, double size) {
  std::uniform_real_distribution<double> in(-size, size);
  return Eigen::VectorXd::NullaryExpr(n, [&] { return in(random); });
}

/// Positions strained by some per cent, velocities, potentials of 20 kV a unit of length, pressures.
inline FemState random_state(const FemPatch& patch, std::mt19937& random) {
  const int n = patch.n_nodes();
  FemState state{.x = 1.05 * patch.X + random_values(random, 3 * n, 0.03),
                 .v = random_values(random, 3 * n, 0.1),
                 .phi = random_values(random, n, 1e3),
                 .pressure = random_values(random, patch.n_elements(), 0.1)};
  for (int k = 0; k < n; ++k) state.phi[k] -= 2e4 * patch.X[3 * k + 2];
  return state;
}

/// Forces of a patch as vectors.
struct FemForces {
  Eigen::VectorXd force, charge, momentum, least_J;
  double least = 0.0;
};

/// A patch with a material and the kernels of one instruction set.
class FemSystem {
 public:
  FemSystem(FemPatch patch, const fem::Material& material, fem::Isa isa = fem::best_isa())
      : patch_(std::move(patch)),
        material_(material),
        kernels_(fem::element_kernels(isa)),
        order_(patch_.elements, std::vector<int>(patch_.elements.size(), 0), kernels_.lanes, 4) {}

  const FemPatch& patch() const { return patch_; }
  const fem::ElementOrder& order() const { return order_; }
  const fem::ElementKernels& kernels() const { return kernels_; }
  fem::MaterialLaws laws() const { return fem::laws_of(material_); }

  template <class Work>
  void each(const Work& work) const {
    fem::for_each_chunk(order_, fem::one_after_the_other,
                        [&](const fem::ElementOrder::Chunk& chunk, int) { work(order_.range(chunk)); });
  }

  FemForces forces(const FemState& at) const {
    FemForces out = zeros();
    out.least = 1e300;
    each([&](const auto& range) {
      out.least = std::min(out.least, kernels_.forces(laws(), range, at.fields(patch_), targets(out)));
    });
    return out;
  }
  FemForces action(const FemState& at, const FemState& along) const {
    FemForces out = zeros();
    each([&](const auto& range) {
      kernels_.action(laws(), range, at.fields(patch_), along.directions(), targets(out));
    });
    return out;
  }
  fem::ElementEnergies energies(const FemState& at) const {
    fem::ElementEnergies sum;
    each([&](const auto& range) { sum += kernels_.energies(laws(), range, at.fields(patch_)); });
    return sum;
  }
  /// Unknown 4 k + i of node k.
  Eigen::MatrixXd tangent(const FemState& at, const fem::ElementTangentWeights& weights) const {
    std::vector<double> matrices(1024 * patch_.elements.size());
    each([&](const auto& range) { kernels_.dense(laws(), range, at.fields(patch_), weights, matrices.data()); });
    return assembled(matrices);
  }
  Eigen::MatrixXd viscous_by_position(const FemState& at) const {
    std::vector<double> matrices(1024 * patch_.elements.size());
    each([&](const auto& range) {
      kernels_.viscous_by_position(laws(), range, at.fields(patch_), 1.0, matrices.data());
    });
    return assembled(matrices);
  }

 private:
  Eigen::MatrixXd assembled(const std::vector<double>& matrices) const {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(4 * patch_.n_nodes(), 4 * patch_.n_nodes());
    for (std::size_t e = 0; e < patch_.elements.size(); ++e) {
      for (int row = 0; row < 32; ++row) {
        for (int column = 0; column < 32; ++column) {
          K(unknown(e, row), unknown(e, column)) += matrices[1024 * e + static_cast<std::size_t>(32 * row + column)];
        }
      }
    }
    return K;
  }
  int unknown(std::size_t e, int local) const {
    return 4 * patch_.elements[e][static_cast<std::size_t>(local / 4)] + local % 4;
  }
  FemForces zeros() const {
    const int n = patch_.n_nodes();
    return {.force = Eigen::VectorXd::Zero(3 * n),
            .charge = Eigen::VectorXd::Zero(n),
            .momentum = Eigen::VectorXd::Zero(3 * n),
            .least_J = Eigen::VectorXd::Zero(patch_.n_elements())};
  }
  static fem::ForceTargets targets(FemForces& out) {
    return {.force = out.force.data(),
            .charge = out.charge.data(),
            .momentum = out.momentum.data(),
            .least_J = out.least_J.data()};
  }

  FemPatch patch_;
  fem::Material material_;
  const fem::ElementKernels& kernels_;
  fem::ElementOrder order_;
};

/// Forces and charges as one vector of unknowns 4 k + i.
inline Eigen::VectorXd joined(const Eigen::VectorXd& of_x, const Eigen::VectorXd& of_phi) {
  Eigen::VectorXd all(of_x.size() + of_phi.size());
  for (Eigen::Index k = 0; k < of_phi.size(); ++k) {
    all.segment<3>(4 * k) = of_x.segment<3>(3 * k);
    all[4 * k + 3] = of_phi[k];
  }
  return all;
}

/// The instruction sets of this processor.
inline std::vector<fem::Isa> isas() {
  std::vector<fem::Isa> all;
  for (const fem::Isa isa : {fem::Isa::v1, fem::Isa::v3, fem::Isa::v4}) {
    if (fem::runs(isa)) all.push_back(isa);
  }
  return all;
}

/// A material with every kind of law.
inline fem::Material full_material() {
  return {.density = 1e-3,
          .elastic = fem::NeoHookean{.mu = 0.233},
          .volumetric = fem::Logarithmic{.kappa = 10.0},
          .electric = fem::Vu{.c1 = -1e-11, .c2 = 1e-10, .eps0 = eps0_si},
          .viscous = fem::KelvinVoigt{.viscosity = 0.4}};
}

}  // namespace muldi::test
