#include "fem/solid/solid_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "fem/solid/solid_action.hpp"
#include "math/check_numbers.hpp"

namespace muldi::fem {
namespace {

using Eigen::VectorXd;

/// Unknowns of a solid, or a direction: positions, velocities, potentials, pressures.
struct Unknowns {
  VectorXd x, v, phi, p;

  Unknowns moved(double s, const Unknowns& d) const {
    return {.x = x + s * d.x, .v = v + s * d.v, .phi = phi + s * d.phi, .p = p + s * d.p};
  }
};

class SolidCheck {
 public:
  SolidCheck(const Solid& solid, const SolidProbe& probe, const DerivativeSink& sink)
      : solid_(solid),
        elements_(solid.elements()),
        probe_(probe),
        sink_(sink),
        u_(probe.u),
        dt_(probe.dt),
        q_(probe.q),
        y_(probe.y) {
    const double edge = shortest_edge();
    const Eigen::Index n = 3 * elements_.n_nodes();
    distortion_ = 0.02 * edge;
    step_ = 2e-3 * edge;
    at_ = {.x = solid.positions(q_) + distortion_ * numbers_.vector(n),
           .v = distortion_ / dt_ * numbers_.vector(n),
           .phi = VectorXd::Zero(solid.n_potentials()),
           .p = VectorXd::Zero(solid.n_pressures())};
    if (solid.n_potentials() > 0) set_potentials();
    keep_bonds(at_);
    settle_pressures(0.0);
    solid.positions(q_) = at_.x;
  }

  void run() {
    check_energy();
    check_elements();
    check_matrix();
    check_equations(0.0);
    check_equations(dt_);
    check_controls();
  }

 private:
  double shortest_edge() const {
    constexpr int edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                  {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& cell : elements_.cells()) {
      for (const auto& edge : edges) {
        const Eigen::Index a = 3 * cell[static_cast<std::size_t>(edge[0])];
        const Eigen::Index b = 3 * cell[static_cast<std::size_t>(edge[1])];
        const VectorXd& X = elements_.reference();
        least = std::min(least, (X.segment<3>(a) - X.segment<3>(b)).norm());
      }
    }
    return least;
  }

  /// Those of the scene, or such that their energy is that of the distortion where it has none; rough either way.
  void set_potentials() {
    const VectorXd rough = numbers_.vector(solid_.n_potentials());
    Unknowns probe = at_;
    probe.phi = rough;
    const ElementEnergies unit = energies(probe);
    const double natural = unit.electric != 0.0 ? std::sqrt(std::abs(unit.elastic / unit.electric)) : 1.0;
    VectorXd q = q_;
    VectorXd y = y_;
    solid_.place({.u = u_, .u_end = u_}, q, y);
    at_.phi = solid_.potentials(y);
    volt_ = std::max(natural, 0.1 * at_.phi.lpNorm<Eigen::Infinity>());
    at_.phi += volt_ * rough;
  }

  /// U' of mean dilatations, so that what Newton's matrix leaves out is zero; of the other formulations rough.
  void settle_pressures(double dt) {
    if (!solid_.has_pressures()) return;
    if (solid_.is_incompressible()) {
      if (at_.p.isZero(0.0)) at_.p = solid_.shear_modulus() * numbers_.vector(at_.p.size());
      return;
    }
    const Volumes begin = solid_.volumes_at(at_.x - dt * at_.v);
    const Volumes end = solid_.volumes_at(at_.x);
    for (int cell = 0; cell < elements_.n_cells(); ++cell) {
      at_.p[cell] = solid_.dilation(cell, 0.5 * (begin.J[cell] + end.J[cell])).pressure;
    }
  }

  ElementFields fields(const Unknowns& at) const {
    ElementFields fields{.x = at.x.data()};
    if (solid_.is_viscous()) fields.v = at.v.data();
    if (at.phi.size() > 0) fields.phi = at.phi.data();
    if (at.p.size() > 0) fields.pressure = at.p.data();
    return fields;
  }
  ElementEnergies energies(const Unknowns& at) const {
    ElementFields without = fields(at);
    without.pressure = nullptr;
    return elements_.energies(without);
  }

  /// Force rows, then charge rows, of the elements.
  VectorXd forces(const Unknowns& at) const {
    VectorXd rows = VectorXd::Zero(at.x.size() + at.phi.size());
    elements_.forces(fields(at),
                     {.force = rows.data(), .charge = at.phi.size() > 0 ? rows.data() + at.x.size() : nullptr});
    return rows;
  }
  VectorXd action(const Unknowns& d) const {
    VectorXd rows = VectorXd::Zero(d.x.size() + d.phi.size());
    const bool electric = d.phi.size() > 0;
    elements_.action(fields(at_),
                     {.x = d.x.data(),
                      .v = solid_.is_viscous() ? d.v.data() : nullptr,
                      .phi = electric ? d.phi.data() : nullptr,
                      .pressure = d.p.size() > 0 ? d.p.data() : nullptr},
                     {.force = rows.data(), .charge = electric ? rows.data() + d.x.size() : nullptr});
    return rows;
  }

  void keep_bonds(Unknowns& at) const {
    solid_.bonds().follow(3, at.x);
    solid_.bonds().follow(3, at.v);
    if (at.phi.size() > 0) solid_.bonds().follow(1, at.phi);
  }

  Unknowns direction(bool x, bool v, bool phi, bool p) {
    const Eigen::Index n = at_.x.size();
    Unknowns d{
        .x = x ? VectorXd(step_ * numbers_.vector(n)) : VectorXd::Zero(n),
        .v = v ? VectorXd(step_ / dt_ * numbers_.vector(n)) : VectorXd::Zero(n),
        .phi = phi ? VectorXd(0.1 * volt_ * numbers_.vector(at_.phi.size())) : VectorXd::Zero(at_.phi.size()),
        .p = p ? VectorXd(0.1 * solid_.shear_modulus() * numbers_.vector(at_.p.size())) : VectorXd::Zero(at_.p.size())};
    keep_bonds(d);
    return d;
  }

  void add(const std::string& what, const std::function<VectorXd(double)>& f, const VectorXd& given) const {
    std::string where;
    for (const Member& member : solid_.members()) where += (where.empty() ? "" : ", ") + solid_.part(member);
    sink_(where + ": " + what, f, given);
  }

  /// Elastic energy, electric enthalpy, and p V J of pressures that are held.
  void check_energy() {
    const auto check = [&](const char* what, const Unknowns& d) {
      Unknowns still = at_;
      still.v.setZero();
      VectorXd along(d.x.size() + d.phi.size());
      along << d.x, d.phi;
      const VectorXd given = VectorXd::Constant(1, forces(still).dot(along));
      add(
          what,
          [&](double s) -> VectorXd {
            const Unknowns at = still.moved(s, d);
            const ElementEnergies energy = energies(at);
            double sum = energy.elastic + energy.electric;
            if (at.p.size() > 0) {
              sum += at.p.cwiseProduct(solid_.cell_volumes()).dot(solid_.volumes_at(at.x).J);
            }
            return VectorXd::Constant(1, sum);
          },
          given);
    };
    check("energy by positions (stress)", direction(true, false, false, false));
    if (at_.phi.size() > 0) check("electric enthalpy by potentials (charge)", direction(false, false, true, false));
  }

  /// Slopes of stress and charge. Rows of the two have sizes of their own.
  void check_elements() {
    const auto check = [&](const char* what, const Unknowns& d, bool charge) {
      const Eigen::Index first = charge ? at_.x.size() : 0;
      const Eigen::Index n = charge ? at_.phi.size() : at_.x.size();
      const VectorXd given = action(d).segment(first, n);
      add(
          what, [&](double s) -> VectorXd { return forces(at_.moved(s, d)).segment(first, n); }, given);
    };
    const Unknowns by_x = direction(true, false, false, false);
    check("stress by positions", by_x, false);
    if (solid_.is_viscous()) check("viscous stress by velocities", direction(false, true, false, false), false);
    if (at_.p.size() > 0) check("force by pressures", direction(false, false, false, true), false);
    if (at_.phi.size() == 0) return;
    const Unknowns by_phi = direction(false, false, true, false);
    check("stress by potentials", by_phi, false);
    check("charge by positions", by_x, true);
    check("charge by potentials", by_phi, true);
  }

  /// The assembled stiffness, coupled where there is a field.
  void check_matrix() {
    const Eigen::Index n_nodes = elements_.n_nodes();
    const int block = at_.phi.size() > 0 ? 4 : 3;
    const Bonds& bonds = solid_.bonds();
    const math::SymmetricBlockPattern pattern(elements_.n_nodes(), block, elements_.cells(),
                                              bonds.pairs(elements_.cells()));
    const std::vector<std::int32_t> slots = elements_.slots_in(pattern);
    math::SymmetricBlockMatrix K(pattern);
    Unknowns still = at_;
    still.v.setZero();
    ElementFields where = fields(still);
    where.v = where.pressure = nullptr;
    ElementTangentWeights weights;
    if (at_.p.size() > 0) weights.curvature = at_.p.data();
    elements_.tangent(where, weights, {}, slots, K);
    BondFold(bonds, pattern).apply(K);
    const Unknowns d = direction(true, false, true, false);
    VectorXd packed(block * n_nodes);
    VectorXd product(block * n_nodes);
    for (Eigen::Index node = 0; node < n_nodes; ++node) {
      packed.segment<3>(block * node) = d.x.segment<3>(3 * node);
      if (block == 4) packed[4 * node + 3] = d.phi[node];
    }
    K.multiply(packed, product);
    for (const bool charge : {false, true}) {
      if (charge && block == 3) continue;
      VectorXd given(charge ? n_nodes : 3 * n_nodes);
      for (Eigen::Index node = 0; node < n_nodes; ++node) {
        if (charge) {
          given[node] = product[4 * node + 3];
        } else {
          given.segment<3>(3 * node) = product.segment<3>(block * node);
        }
      }
      add(
          charge ? "matrix, rows of potentials" : "matrix, rows of positions",
          [&](double s) -> VectorXd {
            const VectorXd all = forces(still.moved(s, d));
            VectorXd rows = charge ? VectorXd(all.tail(n_nodes)) : VectorXd(all.head(3 * n_nodes));
            bonds.collect(charge ? 1 : 3, rows);
            return rows;
          },
          given);
    }
  }

  /// Momentum balance and stage rows of a step that ends at `at` (dt > 0), or of rest there.
  VectorXd rows(const Unknowns& at, double dt, const std::vector<double>& u) {
    VectorXd q1 = q_;
    VectorXd y = y_;
    solid_.positions(q1) = at.x;
    if (at.phi.size() > 0) solid_.potentials(y) = at.phi;
    if (at.p.size() > 0) solid_.pressures(y) = at.p;
    return rows(q1, y, dt, u);
  }
  VectorXd rows(const VectorXd& q1, const VectorXd& y, double dt, const std::vector<double>& u) {
    VectorXd q0 = q1;
    if (dt > 0.0) solid_.positions(q0) = at_.x - dt * at_.v;
    const VectorXd q = 0.5 * (q0 + q1);
    const VectorXd v = dt > 0.0 ? VectorXd((q1 - q0) / dt) : VectorXd::Zero(q.size());
    const VectorXd zero = VectorXd::Zero(q.size());
    model::IntervalForces out{.force = zero, .momentum = zero, .begin = zero, .end = zero};
    out.stage = VectorXd::Zero(y.size());
    const model::IntervalPoint point{.q0 = q0, .q1 = q1, .q = q, .v = v, .u = u, .dt = dt, .y = &y};
    solid_.add_forces(point, out);
    if (action_ != nullptr) action_->linearise(point);
    VectorXd balance = dt > 0.0 ? VectorXd(0.5 * dt * out.force - out.momentum + out.begin) : VectorXd(out.force);
    solid_.bonds().collect(3, solid_.positions(balance));
    VectorXd all(at_.x.size() + at_.phi.size() + at_.p.size());
    all << solid_.positions(balance), VectorXd(out.stage.segment(solid_.y_slice().first, solid_.y_slice().size));
    return all;
  }

  void check_equations(double dt) {
    settle_pressures(dt);
    Unknowns d = direction(true, false, true, true);
    SolidAction action(solid_);
    action_ = &action;
    rows(at_, dt, u_);
    action_ = nullptr;
    SolidVector along(solid_);
    SolidVector out(solid_);
    along.x = d.x;
    if (d.phi.size() > 0) along.phi = d.phi;
    along.p = d.p;
    action.apply(along, out);
    if (d.phi.size() > 0) solid_.unknowns().keep_solved_potentials(out.phi);
    const auto check = [&](const char* rest, const char* step, Eigen::Index first, const VectorXd& derivative) {
      if (derivative.size() == 0) return;
      add(
          dt > 0.0 ? step : rest,
          [&](double s) -> VectorXd { return rows(at_.moved(s, d), dt, u_).segment(first, derivative.size()); },
          -derivative);
    };
    check("equilibrium, rows of positions", "step, rows of positions", 0, out.x);
    if (d.phi.size() > 0) check("equilibrium, rows of potentials", "step, rows of potentials", d.x.size(), out.phi);
    check("equilibrium, rows of pressures", "step, rows of pressures", d.x.size() + d.phi.size(), out.p);
  }

  /// At rest: loads, prescribed positions and potentials along every control.
  void check_controls() {
    settle_pressures(0.0);
    for (std::size_t c = 0; c < u_.size(); ++c) {
      const auto placed = [&](double s) {
        std::vector<double> u = u_;
        u[c] += s * rate_of(c);
        VectorXd q = q_;
        VectorXd y = y_;
        solid_.positions(q) = at_.x;
        if (at_.phi.size() > 0) solid_.potentials(y) = at_.phi;
        if (at_.p.size() > 0) solid_.pressures(y) = at_.p;
        solid_.place({.u = u, .u_end = u}, q, y);
        return std::tuple{q, y, u};
      };
      const auto [q, y, u] = placed(0.0);
      std::vector<double> du(u_.size(), 0.0);
      du[c] = rate_of(c);
      VectorXd force = VectorXd::Zero(q.size());
      VectorXd stage = VectorXd::Zero(y.size());
      const VectorXd zero = force;
      solid_.add_load_rate({.q0 = q, .q1 = q, .q = q, .v = zero, .u = u, .y = &y}, du, force, stage);
      solid_.bonds().collect(3, solid_.positions(force));
      VectorXd given(at_.x.size() + at_.phi.size() + at_.p.size());
      given << solid_.positions(force), VectorXd(stage.segment(solid_.y_slice().first, solid_.y_slice().size));
      const auto f = [&](double s) -> VectorXd {
        const auto [q_s, y_s, u_s] = placed(s);
        return rows(q_s, y_s, 0.0, u_s);
      };
      if (given.isZero(0.0) && (f(1.0) - f(0.0)).isZero(0.0)) continue;
      const std::string what = "equilibrium by control " + probe_.control_names[c];
      const Eigen::Index sizes[] = {at_.x.size(), at_.phi.size(), at_.p.size()};
      const char* const of_rows[] = {", rows of positions", ", rows of potentials", ", rows of pressures"};
      Eigen::Index first = 0;
      for (std::size_t k = 0; k < 3; first += sizes[k++]) {
        const VectorXd part = given.segment(first, sizes[k]);
        if (part.isZero(0.0)) continue;
        const Eigen::Index begin = first;
        add(
            what + of_rows[k], [&](double s) -> VectorXd { return f(s).segment(begin, part.size()); }, part);
      }
    }
  }
  /// A change of a control that matters: the rows are quadratic in potentials and linear in loads.
  double rate_of(std::size_t control) const {
    std::vector<double> u = u_;
    u[control] += 1.0;
    VectorXd q0 = q_, q1 = q_, y0 = y_, y1 = y_;
    solid_.place({.u = u_, .u_end = u_}, q0, y0);
    solid_.place({.u = u, .u_end = u}, q1, y1);
    const double moved = (q1 - q0).lpNorm<Eigen::Infinity>();
    const double charged = (y1 - y0).lpNorm<Eigen::Infinity>();
    if (moved == 0.0 && charged == 0.0) return std::max(1.0, std::abs(u_[control]));
    const double by_position = moved > 0.0 ? step_ / moved : std::numeric_limits<double>::infinity();
    const double by_potential = charged > 0.0 ? volt_ / charged : std::numeric_limits<double>::infinity();
    return std::min(by_position, by_potential);
  }

  const Solid& solid_;
  const ElementSet& elements_;
  const SolidProbe& probe_;
  const DerivativeSink& sink_;
  std::vector<double> u_;
  double dt_;
  VectorXd q_;  // of the whole system, with the distorted solid
  VectorXd y_;
  math::CheckNumbers numbers_;
  double distortion_ = 0.0;
  double step_ = 0.0;
  double volt_ = 1.0;
  Unknowns at_;
  SolidAction* action_ = nullptr;  // linearised by rows() where one is wanted
};

}  // namespace

void check_solid(const Solid& solid, const SolidProbe& probe, const DerivativeSink& sink) {
  SolidCheck(solid, probe, sink).run();
}

}  // namespace muldi::fem
