#pragma once
/// How elements take their controls from those of the model, for values and for derivatives.
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

#include "model/expansion.hpp"
#include "muscles/axial_expansion.hpp"

namespace muldi::muscles {

/// Where an element takes a control value from: a control of the model, or a constant.
struct ControlInput {
  int control = -1;       ///< index in the model's controls; -1: `constant`
  double constant = 0.0;  ///< in the element's unit
  double factor = 1.0;    ///< from the control's unit to the element's, e.g. 1/t from layer voltage to field

  double value(std::span<const double> u) const {
    return control < 0 ? constant : factor * u[static_cast<std::size_t>(control)];
  }
};

/// The controls of one element in an expansion: which of the model they are, and how they count.
template <int n>
struct ControlSlots {
  std::array<int, static_cast<std::size_t>(n)> controls{};   ///< of the model; -1: constant
  std::array<double, static_cast<std::size_t>(n)> factor{};  ///< of derivatives by the model's control, or its square
  std::array<double, static_cast<std::size_t>(n)> reference{};  ///< of the element's control; 0 where plain
  bool any_squared = false;

  ControlSlots(const std::array<ControlInput, static_cast<std::size_t>(n)>& inputs, std::span<const double> squared) {
    for (std::size_t c = 0; c < inputs.size(); ++c) {
      controls[c] = inputs[c].control;
      factor[c] = inputs[c].factor;
      if (controls[c] < 0) continue;
      const double of_model = squared[static_cast<std::size_t>(controls[c])];
      if (of_model == 0.0) continue;
      any_squared = true;
      reference[c] = std::abs(inputs[c].factor) * of_model;
      factor[c] = inputs[c].factor * inputs[c].factor;
    }
  }

  /// Where one control counts by its square, constants do too: the forces are affine in the squares of all of them.
  template <AxialElement Element>
  AxialForces<2 + n> axial_forces(const Element& element, double z, double zd, const Controls<double, n>& e,
                                  bool second) const {
    if constexpr (n > 0) {
      if (any_squared) {
        auto all = reference;
        for (std::size_t c = 0; c < all.size(); ++c) {
          if (all[c] == 0.0) all[c] = e[c] != 0.0 ? e[c] : 1.0;
        }
        return squared_axial_forces(element, z, zd, e, all, second);
      }
    }
    return muscles::axial_forces<2 + n>(element, z, zd, e, second);
  }

  /// Columns from `first` on: from the element's controls to the model's.
  void scale(Eigen::MatrixXd& tangent, int first) const {
    for (int c = 0; c < n; ++c) tangent.col(first + c) *= factor[static_cast<std::size_t>(c)];
  }
  void scale_both(Eigen::MatrixXd& hessian, int first) const {
    for (int c = 0; c < n; ++c) {
      hessian.col(first + c) *= factor[static_cast<std::size_t>(c)];
      hessian.row(first + c) *= factor[static_cast<std::size_t>(c)];
    }
  }
};

/// An element whose field and stiffness can be limited.
template <class E>
concept LimitedElement = E::n_controls == 1 && requires(const E& element, math::Jet2<1> z) {
  { element.true_field(1.0, 1.0) } -> std::convertible_to<double>;
  { element.potential_zz(z, z) } -> std::convertible_to<math::Jet2<1>>;
  { element.length } -> std::convertible_to<double>;
};

template <LimitedElement Element>
model::LimitedMuscle limited_muscle(const Element& element, const ControlInput& input) {
  model::LimitedMuscle muscle{.control = input.control,
                              .control_factor = input.factor,
                              .constant_field = input.constant,
                              .rest_length = element.length};
  muscle.stiffness = [element](double z) {
    using Jet = math::Jet2<1>;
    const Jet stretch = Jet::variable(z, 0) / element.length;
    const Jet uncharged = element.potential_zz(stretch, Jet(0.0));
    // The law is quadratic in the field: any one gives its factor.
    constexpr double field = 1e5;
    const Jet charged = element.potential_zz(stretch, Jet(field));
    const double scale = 1.0 / element.potential_zz(1.0, 0.0);
    model::LimitedMuscle::Stiffness out;
    out.elastic = {scale * uncharged.value, scale * uncharged.d(0), scale * uncharged.dd(0, 0)};
    const Jet share = (charged - uncharged) * (scale / (field * field));
    out.electric = {share.value, share.d(0), share.dd(0, 0)};
    return out;
  };
  return muscle;
}

}  // namespace muldi::muscles
