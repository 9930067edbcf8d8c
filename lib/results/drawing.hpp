#pragma once
/// What a result looks like: boxes for bodies, lines for muscles and springs, places of joints; it moves with the
/// recorded positions and orientations.
#include <array>
#include <string>
#include <vector>

namespace muldi::results {

using DrawnVector = std::array<double, 3>;

/// A body as a box in body axes.
struct DrawnBody {
  std::string name = {};
  DrawnVector centre = {};  ///< of the box, from the centre of mass
  DrawnVector half = {};    ///< half of its edges
};

/// A point fixed to a body or to the ground.
struct DrawnPoint {
  int body = -1;        ///< index in the bodies; -1: ground
  DrawnVector at = {};  ///< body axes from the centre of mass; world for the ground
};

/// A line between two points: a muscle or a spring.
struct DrawnLine {
  std::string folder = {};  ///< its group in the file, e.g. `muscles/upper`
  std::array<DrawnPoint, 2> ends = {};
  double radius = 0.0;    ///< of the undeformed section; 0 where it has none
  bool isolated = false;  ///< an actuator about the origin along `axis`, as long as its recorded length
  DrawnVector axis = {};  ///< of unit length
};

/// A joint at its connector on the first body.
struct DrawnJoint {
  std::string name = {};
  std::string type = {};
  DrawnPoint at = {};
};

struct Drawing {
  std::vector<DrawnBody> bodies = {};
  std::vector<DrawnLine> lines = {};
  std::vector<DrawnJoint> joints = {};

  bool empty() const { return bodies.empty() && lines.empty(); }
};

/// The drawing as one JSON object with the names of the members above.
std::string to_json(const Drawing& drawing);

}  // namespace muldi::results
