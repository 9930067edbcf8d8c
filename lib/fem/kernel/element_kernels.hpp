#pragma once
/// The element kernels: forces, tangents and their kin of trilinear hexahedra, by batches of SIMD lanes.
///
/// One table of functions an instruction set; all compute the same to round-off. A call works on a range of batches of
/// one material (a chunk of ElementOrder), reads nodal arrays, and adds to nodal arrays or matrix blocks; chunks that
/// share no node may run at the same time. Eight Gauss points. Nothing is allocated. Nodal arrays: positions,
/// velocities and forces three a node, potentials and charges one a node. Element arrays are indexed by the element's
/// number in the mesh, local nodes and element matrices in the mesh's corner order (VTK).
#include <cstdint>
#include <span>

#include "fem/kernel/element_order.hpp"
#include "fem/material.hpp"

namespace muldi::fem {

/// Instruction sets of x86-64: level 1 (SSE2), level 3 (AVX2, FMA), level 4 (AVX-512).
enum class Isa { v1, v3, v4 };

/// Where the kernels evaluate. Null pointers: absent (no velocity, no field, no element pressure).
struct ElementFields {
  const double* X = nullptr;         ///< reference positions
  const double* x = nullptr;         ///< current positions (the middle of an interval in dynamics)
  const double* v = nullptr;         ///< velocities (the mean ones of an interval)
  const double* phi = nullptr;       ///< potentials
  const double* pressure = nullptr;  ///< p_e, one an element: adds the force p_e V_e dJ_e/dx (positive: tension)
};

/// A direction in the space of the fields; null pointers: zero.
struct FieldDirections {
  const double* x = nullptr;
  const double* v = nullptr;
  const double* phi = nullptr;
  const double* pressure = nullptr;
};

/// What `forces` adds to; null pointers are skipped.
struct ForceTargets {
  double* force = nullptr;   ///< int dN:(P + P_vis) dV + p_e V_e dJ_e/dx: the gradient of the energy by x, and damping
  double* charge = nullptr;  ///< int gradN.D dV: the gradient of the electric enthalpy by phi (minus the charge there)
  double* momentum = nullptr;  ///< M v, consistent mass
  /// One an element, overwritten: the smallest det F of its Gauss points, or a law's own margin (Gent's locking) once
  /// that is used up. Not positive, or NaN: the state is inadmissible and the forces mean nothing.
  double* least_J = nullptr;
};

/// K = mass M + stiffness K_xx + rate dF_vis/dv + x_phi (K_xphi and its transpose) + phi_phi K_phiphi
///     + sum_e rank_one_e g_e g_e^T + sum_e curvature_e V_e H_e,
/// K_xx, K_xphi, K_phiphi the second derivatives of the energy by x and phi: symmetric, and so is dF_vis/dv. The
/// derivative of the viscous force by x at fixed v is not: it is in `action`, and in `viscous_by_position` for
/// referees.
struct ElementTangentWeights {
  double mass = 0.0;
  double stiffness = 1.0;
  double rate = 0.0;
  double x_phi = 1.0;
  double phi_phi = 1.0;
  const double* rank_one = nullptr;          ///< one an element
  const double* volume_gradients = nullptr;  ///< g_e = dJ_e/dx, [element][8][3], with rank_one
  const double* curvature = nullptr;         ///< one an element: the pressure on H_e = d2J_e/dx2
};

/// Node-blocked symmetric matrix, one triangle of blocks stored.
struct BlockTarget {
  int block = 4;                        ///< 3 (x) or 4 (x, phi) unknowns a node
  double* values = nullptr;             ///< block k, row i, column j at [(k block + i) block + j]; best at 64 bytes
  const std::int32_t* slots = nullptr;  ///< block_slots() of the same order
  const std::uint8_t* fixed = nullptr;  ///< one a node, bit i: leave out row and column i; null: none
};

/// Positions whose volumes are asked for.
struct VolumeFields {
  const double* X = nullptr;   ///< reference positions
  const double* x = nullptr;   ///< positions
  const double* dx = nullptr;  ///< direction; null: no derivatives along one
  const double* V = nullptr;   ///< V_e where they are known already; null: from X
};

/// What `volumes` gives for each element; null pointers are skipped. With a direction (dx) also the derivatives.
struct VolumeTargets {
  double* reference = nullptr;  ///< V_e
  double* J = nullptr;          ///< J_e = (1/V_e) int det F dV, exact
  double* gradient = nullptr;   ///< g_e = dJ_e/dx, [element][8][3]
  double* dJ = nullptr;         ///< g_e . dx
  double* dgradient = nullptr;  ///< H_e dx, [element][8][3]
};

/// Integrals over the elements of a call.
struct ElementEnergies {
  double elastic = 0.0;
  double electric = 0.0;     ///< enthalpy: -1/2 C U^2 (numerics C16)
  double dissipation = 0.0;  ///< power of the viscous stress
  double kinetic = 0.0;      ///< 1/2 v.M v
  double volume = 0.0;       ///< deformed

  ElementEnergies& operator+=(const ElementEnergies& b) {
    elastic += b.elastic;
    electric += b.electric;
    dissipation += b.dissipation;
    kinetic += b.kinetic;
    volume += b.volume;
    return *this;
  }
};

/// One Gauss point as `point_values` writes it.
struct PointValues {
  double X[3];       ///< reference position
  double F[9];       ///< by rows
  double P[9];       ///< first Piola-Kirchhoff stress: elastic, volumetric, electric, viscous, element pressure
  double cauchy[6];  ///< xx, yy, zz, yz, xz, xy
  double field[3];   ///< true field e
  double D[3];       ///< nominal electric displacement
  double J;
  double volume;  ///< reference volume that the point stands for
};

/// Mean over the reference volume of the eight points of an element.
PointValues mean_of(std::span<const PointValues, 8> points);

using ElementRange = ElementOrder::Range;

/// The functions of one instruction set.
struct ElementKernels {
  Isa isa;
  const char* name;
  int lanes;

  /// Adds forces; returns the smallest entry of least_J.
  double (*forces)(const MaterialLaws&, const ElementRange&, const ElementFields&, const ForceTargets&);
  /// Adds the exact derivative of `forces` along the direction (least_J is left alone).
  void (*action)(const MaterialLaws&, const ElementRange&, const ElementFields&, const FieldDirections&,
                 const ForceTargets&);
  /// Adds the weighted symmetric tangent to the matrix.
  void (*tangent)(const MaterialLaws&, const ElementRange&, const ElementFields&, const ElementTangentWeights&,
                  const BlockTarget&);
  /// Writes it as element matrices, [element][32][32], unknown 4 a + i of local node a.
  void (*dense)(const MaterialLaws&, const ElementRange&, const ElementFields&, const ElementTangentWeights&,
                double* matrices);
  /// Adds weight dF_vis/dx at fixed v, which is not symmetric, to the same.
  void (*viscous_by_position)(const MaterialLaws&, const ElementRange&, const ElementFields&, double weight,
                              double* matrices);
  void (*volumes)(const ElementRange&, const VolumeFields&, const VolumeTargets&);
  ElementEnergies (*energies)(const MaterialLaws&, const ElementRange&, const ElementFields&);
  /// Writes [element][8] Gauss points.
  void (*point_values)(const MaterialLaws&, const ElementRange&, const ElementFields&, PointValues*);
  /// Writes int N_a N_b dV, [element][8][8].
  void (*mass)(const ElementRange&, const double* X, double* matrices);
  /// Adds int N_a b dV to `nodal` (`width` entries a node) for b given at the Gauss points, [element][8][width], in the
  /// order of point_values; null b with width 1: b = 1, the nodal volumes.
  void (*loads)(const ElementRange&, const double* X, const double* b, int width, double* nodal);
};

/// The best set that this processor has.
Isa best_isa();
/// Whether this processor can run the set.
bool runs(Isa isa);
/// The kernels for a set, by default the best one.
const ElementKernels& element_kernels(Isa isa = best_isa());

}  // namespace muldi::fem
