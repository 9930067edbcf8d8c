/// Lumped scenes in Simbody, another general multibody library: the rival of our own general program, built with
/// MULDI_PEERS where libsimbody-dev is installed. The muscles are forces without mass.
///
/// Arguments: joint or trunk, merson or cpodes, accuracy, end (ms), time between samples (ms). Prints the processor
/// seconds, the least of several runs, and the joint angles of all samples.
#include <Simbody.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "bench/work_precision/published_systems.hpp"

namespace {

using namespace muldi;
using SimTK::Vec3;

Vec3 vector(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// Pulls two stations together as a muscle does.
class Pull final : public SimTK::Force::Custom::Implementation {
 public:
  Pull(const SimTK::MobilizedBody& from, const Vec3& from_station, const SimTK::MobilizedBody& to,
       const Vec3& to_station, const bench::UniformMuscle& law)
      : from_(from), to_(to), from_station_(from_station), to_station_(to_station), law_(law) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    const Vec3 line =
        to_.findStationLocationInGround(state, to_station_) - from_.findStationLocationInGround(state, from_station_);
    const Vec3 rate =
        to_.findStationVelocityInGround(state, to_station_) - from_.findStationVelocityInGround(state, from_station_);
    const double z = line.norm();
    const Vec3 direction = line / z;
    const Vec3 force = law_.force(z, SimTK::dot(direction, rate)) * direction;
    to_.applyForceToBodyPoint(state, to_station_, force, forces);
    from_.applyForceToBodyPoint(state, from_station_, -force, forces);
  }
  double calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  const SimTK::MobilizedBody& from_;
  const SimTK::MobilizedBody& to_;
  Vec3 from_station_;
  Vec3 to_station_;
  bench::UniformMuscle law_;
};

class System {
 public:
  explicit System(const bench::ChainParts& parts) : matter_(system_), forces_(system_) {
    joints_.reserve(parts.links.size());
    Vec3 pivot(0);
    for (const bench::ChainLink& link : parts.links) {
      SimTK::Mat33 place;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) place(i, j) = link.place(i, j);
      }
      const Vec3 centre = vector(link.centre);
      const Vec3 moments = vector(link.inertia);
      const SimTK::Inertia inertia = SimTK::Inertia(moments).shiftFromMassCenter(-centre, link.mass);
      const SimTK::Body::Rigid body(SimTK::MassProperties(link.mass, centre, inertia));
      SimTK::MobilizedBody& before =
          joints_.empty() ? static_cast<SimTK::MobilizedBody&>(matter_.updGround()) : joints_.back();
      joints_.push_back(
          SimTK::MobilizedBody::Pin(before, SimTK::Transform(SimTK::Rotation(place), pivot), body, SimTK::Transform()));
      pivots_.push_back(pivot);
      pivot = vector(link.next_joint);
    }
    for (const bench::ChainMuscle& muscle : parts.muscles) {
      const auto i = static_cast<std::size_t>(muscle.joint);
      const SimTK::MobilizedBody& before =
          i == 0 ? static_cast<const SimTK::MobilizedBody&>(matter_.getGround()) : joints_[i - 1];
      SimTK::Force::Custom(
          forces_, new Pull(before, pivots_[i] + vector(muscle.from), joints_[i], vector(muscle.to), muscle.law));
    }
    start_ = system_.realizeTopology();
  }

  std::vector<double> run(bool explicitly, double accuracy, double end, double sample) const {
    std::unique_ptr<SimTK::Integrator> integrator;
    if (explicitly) {
      integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
    } else {
      integrator = std::make_unique<SimTK::CPodesIntegrator>(system_, SimTK::CPodes::BDF, SimTK::CPodes::Newton);
    }
    integrator->setAccuracy(accuracy);
    SimTK::TimeStepper stepper(system_, *integrator);
    stepper.initialize(start_);
    std::vector<double> angles;
    for (int i = 1; i <= std::lround(end / sample); ++i) {
      stepper.stepTo(i * sample);
      const SimTK::Vector& q = stepper.getState().getQ();
      for (int k = 0; k < q.size(); ++k) angles.push_back(q[k]);
    }
    return angles;
  }

 private:
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  std::vector<SimTK::MobilizedBody::Pin> joints_;
  std::vector<Vec3> pivots_;
  SimTK::State start_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const System system(std::string(argv[1]) == "joint" ? bench::joint_parts(10.0, 0.0) : bench::trunk_parts(0.0));
  const bool explicitly = std::string(argv[2]) == "merson";
  std::vector<double> angles;
  double least = 1e9;
  double spent = 0.0;
  for (int i = 0; i < 20 && (i < 2 || spent < 0.05); ++i) {
    const std::clock_t start = std::clock();
    angles = system.run(explicitly, std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5]));
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    least = std::min(least, seconds);
    spent += seconds;
  }
  std::printf("%.6g\n", least);
  for (const double angle : angles) std::printf("%.15g\n", angle);
}
