// What scene values compute from themselves.
#include <cmath>
#include <limits>

#include "scene/scene.hpp"

namespace muldi::scene {
namespace {

/// Shear modulus and Poisson's ratio of a pair of elastic constants; NaN for any other number of constants.
struct ShearAndPoisson {
  double mu = std::numeric_limits<double>::quiet_NaN();
  double nu = std::numeric_limits<double>::quiet_NaN();
};

ShearAndPoisson with_young(double young, const ElasticConstants& law) {
  if (law.poisson) return {.mu = young / (2 * (1 + *law.poisson)), .nu = *law.poisson};
  if (law.mu) return {.mu = *law.mu, .nu = young / (2 * *law.mu) - 1};
  if (law.kappa) return {.mu = 3 * *law.kappa * young / (9 * *law.kappa - young), .nu = 0.5 - young / (6 * *law.kappa)};
  const double lambda = *law.lambda;
  const double root = std::sqrt(young * young + 9 * lambda * lambda + 2 * young * lambda);
  return {.mu = (young - 3 * lambda + root) / 4, .nu = 2 * lambda / (young + lambda + root)};
}

ShearAndPoisson with_poisson(double nu, const ElasticConstants& law) {
  if (law.mu) return {.mu = *law.mu, .nu = nu};
  if (law.kappa) return {.mu = 3 * *law.kappa * (1 - 2 * nu) / (2 * (1 + nu)), .nu = nu};
  return {.mu = *law.lambda * (1 - 2 * nu) / (2 * nu), .nu = nu};
}

ShearAndPoisson shear_and_poisson(const ElasticConstants& law) {
  const int n_given = int{law.young.has_value()} + int{law.poisson.has_value()} + int{law.mu.has_value()} +
                      int{law.lambda.has_value()} + int{law.kappa.has_value()};
  if (n_given != 2) return {};
  if (law.young) return with_young(*law.young, law);
  if (law.poisson) return with_poisson(*law.poisson, law);
  if (law.mu && law.lambda) return {.mu = *law.mu, .nu = *law.lambda / (2 * (*law.lambda + *law.mu))};
  if (law.mu) return {.mu = *law.mu, .nu = (3 * *law.kappa - 2 * *law.mu) / (2 * (3 * *law.kappa + *law.mu))};
  return {.mu = 1.5 * (*law.kappa - *law.lambda), .nu = *law.lambda / (3 * *law.kappa - *law.lambda)};
}

}  // namespace

double ElasticConstants::shear_modulus() const { return shear_and_poisson(*this).mu; }
double ElasticConstants::poisson_ratio() const { return shear_and_poisson(*this).nu; }

std::string ElasticConstants::why_invalid() const {
  const ShearAndPoisson constants = shear_and_poisson(*this);
  if (std::isnan(constants.mu) || std::isnan(constants.nu)) {
    return "needs two constants of young, poisson, mu, lambda, kappa that determine the others";
  }
  if (!(constants.mu > 0.0) || !std::isfinite(constants.mu)) return "the constants give no positive shear modulus";
  if (!(constants.nu > -1.0 && constants.nu <= 0.5)) return "the constants give a Poisson's ratio outside (-1, 0.5]";
  return {};
}

double poisson_of(double mu, const std::optional<double>& poisson, const std::optional<double>& kappa) {
  return ElasticConstants{.poisson = poisson, .mu = mu, .kappa = kappa}.poisson_ratio();
}

std::string why_no_bulk(double mu, const std::optional<double>& poisson, const std::optional<double>& kappa) {
  if (poisson.has_value() == kappa.has_value()) return "needs one of poisson and kappa";
  return ElasticConstants{.poisson = poisson, .mu = mu, .kappa = kappa}.why_invalid();
}

std::span<const Coordinate> Joint::coordinates() const {
  return std::visit([](const auto& joint) { return std::span<const Coordinate>(joint.coordinates); }, type);
}

const Drive* Joint::drive(std::size_t i) const {
  const std::span<const Coordinate> kinds = coordinates();
  const std::vector<Drive>& drives = kinds[i] == Coordinate::slide ? force : torque;
  if (drives.empty()) return nullptr;
  std::size_t n_before = 0;
  for (std::size_t j = 0; j < i; ++j) n_before += kinds[j] == kinds[i] ? 1 : 0;
  return &drives[n_before];
}

int OptimalControl::n_steps() const {
  return steps ? *steps : static_cast<int>(std::lround(duration.max / step.value_or(duration.max)));
}

long Dynamics::n_steps() const { return std::lround(duration / step); }

std::string path_of_file(const Scene& scene, const std::string& file) {
  const std::string& own = scene.origin.place.file;
  const std::size_t slash = own.rfind('/');
  if (file.front() == '/' || slash == std::string::npos) return file;
  return own.substr(0, slash + 1) + file;
}

}  // namespace muldi::scene
