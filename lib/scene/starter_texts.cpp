// The scenes of `new`.
#include <array>

#include "scene/starter.hpp"

namespace muldi::scene {
namespace {

/// Texts one after the other, as one text.
template <const std::string_view&... parts>
struct Joined {
  static constexpr auto letters = [] {
    std::array<char, (parts.size() + ...)> all{};
    std::size_t at = 0;
    for (const std::string_view part : {parts...}) {
      for (const char letter : part) all[at++] = letter;
    }
    return all;
  }();
  static constexpr std::string_view text{letters.data(), letters.size()};
};

// What the joint and its optimal control share.
constexpr std::string_view hinge = R"yaml(materials:
  silicone:
    density: 1 g/cm^3
    elastic: {model: neo_hookean, young: 0.7 MPa, poisson: 0.5}
    electric: {model: ideal_dielectric, relative_permittivity: 3.1}
    viscous: {model: kelvin_voigt, viscosity: 10 g/(ms*mm)}

bodies:
  bar:
    mass: 40 g
    inertia: [1.0e+5, 3.17e+5, 3.17e+5]
    position: [46, 0, 0]
    points: {pivot: [-46, 0, 0], upper: [44, 15, 0], lower: [44, -15, 0]}

joints:
  hinge:
    type: revolute
    from: {body: ground, at: [0, 0, 0]}
    to: {body: bar, at: pivot}
    axis: [0, 0, 1]

controls:
  agonist: {field: 30 kV/mm}
  antagonist: {field: 0}

muscles:
  upper: &muscle
    model: lumped
    from: {body: ground, at: [-10, 15, 0]}
    to: {body: bar, at: upper}
    section: {shape: round, diameter: 11}
    material: silicone
    control: agonist
  lower: {<<: *muscle, from: {body: ground, at: [-10, -15, 0]}, to: {body: bar, at: lower}, control: antagonist}

)yaml";

constexpr std::string_view joint_head = R"yaml(# yaml-language-server: $schema=../schemas/scene.schema.json
# A hinged bar between two antagonistic muscles. The first pulls from t = 0; without a field the bar stays where it is.
# Run it:     muldi-sim run joint.yaml        Look at it:  muldi-sim report joint.h5 -o joint.html
# Any key:    muldi-sim explain muscles.upper.section
muldi: 1
title: Hinge with two muscles

)yaml";
constexpr std::string_view joint_tasks = R"yaml(statics:
  steps: 6

dynamics:
  duration: 1 s
  step: 1 ms

record:
  every: 5
  points: [bar.upper]
)yaml";

constexpr std::string_view muscle = R"yaml(# yaml-language-server: $schema=../schemas/scene.schema.json
# An actuator with free ends under a field that rises slowly, then under one that is switched on at once.
# Run it:     muldi-sim run muscle.yaml       Look at it:  muldi-sim plot muscle.h5 --what muscles -o muscle.svg
muldi: 1
title: Free actuator

materials:
  silicone:
    density: 1 g/cm^3
    elastic: {model: neo_hookean, young: 0.7 MPa, poisson: 0.5}
    electric: {model: ideal_dielectric, relative_permittivity: 3.7}
    viscous: {model: kelvin_voigt, viscosity: 10 g/(ms*mm)}

controls:
  supply: {field: 30 kV/mm}

muscles:
  actuator:
    model: lumped
    ends: free
    axis: [0, 0, 1]
    length: 40
    section: {shape: round, diameter: 10}
    material: silicone
    control: supply

statics:
  control: supply
  from: 0
  to: 40 kV/mm
  steps: 20

dynamics:
  duration: 100 ms
  step: 0.1 ms
)yaml";

constexpr std::string_view trunk = R"yaml(# yaml-language-server: $schema=../schemas/scene.schema.json
# A trunk of three segments, each turned by a pair of muscles; the odd ones pull. Every segment is turned by 90 degrees
# against the one before, so that the trunk bends both ways.
# Run it:     muldi-sim run trunk.yaml        Look at it:  muldi-sim report trunk.h5 -o trunk.html
muldi: 1
title: Trunk of three segments

materials:
  silicone:
    density: 1 g/cm^3
    elastic: {model: neo_hookean, young: 0.7 MPa, poisson: 0.5}
    electric: {model: ideal_dielectric, relative_permittivity: 3.7}
    viscous: {model: kelvin_voigt, viscosity: 100 g/(ms*mm)}

bodies:
  first: &segment
    mass: 61 g
    inertia: [15036, 2524, 14940]
    position: [0, 37, 0]
    points: {below: [0, -37, 0], left: [-7.5, 8, 0], right: [7.5, 8, 0], front: [0, 9, 7.5], back: [0, 9, -7.5], above: [0, 14, 0]}
  second: {<<: *segment, position: [0, 88, 0], orientation: {axis: [0, 1, 0], angle: 90 deg}}
  third: {<<: *segment, position: [0, 139, 0]}

joints:
  bend1: &bend
    type: revolute
    frame: to
    axis: [0, 0, 1]
    from: {body: ground, at: [0, 0, 0]}
    to: {body: first, at: below}
  bend2: {<<: *bend, from: {body: first, at: above}, to: {body: second, at: below}}
  bend3: {<<: *bend, from: {body: second, at: above}, to: {body: third, at: below}}

controls:
  pull: {field: {ramp: {from: 0, to: 30 kV/mm, start: 0, over: 200 ms}}}
  rest: {field: 0}

muscles:
  m1: &muscle
    model: lumped
    from: {body: ground, at: [-7.5, -5, 0]}
    to: {body: first, at: left}
    section: {shape: round, diameter: 8}
    rest_length: 50
    material: silicone
    control: pull
  m2: {<<: *muscle, from: {body: ground, at: [7.5, -5, 0]}, to: {body: first, at: right}, control: rest}
  m3: {<<: *muscle, from: {body: first, at: front}, to: {body: second, at: left}, control: pull}
  m4: {<<: *muscle, from: {body: first, at: back}, to: {body: second, at: right}, control: rest}
  m5: {<<: *muscle, from: {body: second, at: back}, to: {body: third, at: left}, control: pull}
  m6: {<<: *muscle, from: {body: second, at: front}, to: {body: third, at: right}, control: rest}

dynamics:
  duration: 2 s
  step: 1 ms

record:
  every: 10
  points: [third.above]
)yaml";

constexpr std::string_view solid = R"yaml(# yaml-language-server: $schema=../schemas/scene.schema.json
# A block of finite elements on rollers with an electrode on one half of its upper face.
# Run it:     muldi-sim run solid.yaml        Look at it:  open solid.xdmf in ParaView, or muldi-sim report solid.h5
muldi: 1
title: Block with half an electrode

materials:
  silicone:
    density: 1 g/cm^3
    elastic: {model: neo_hookean, mu: 0.233 MPa, poisson: 0.5}
    electric: {model: ideal_dielectric, relative_permittivity: 3.7}
    viscous: {model: kelvin_voigt, viscosity: 0.5 g/(ms*mm)}

controls:
  supply: {potential: {ramp: {from: 0, to: 60 kV, start: 0, over: 1 ms}}}

solids:
  block:
    mesh: {box: {size: [2, 2, 2], cells: [4, 4, 4], centre: [0, 0, 0]}}
    material: silicone
    conditions:
      - {where: x-, displacement: [0, ~, ~]}
      - {where: y-, displacement: [~, 0, ~], potential: 0 V}
      - {where: z-, displacement: [~, ~, 0]}
    electrodes:
      upper: {where: {face: y+, x: [~, 0]}, potential: {control: supply}}

dynamics:
  duration: 4 ms
  step: 0.02 ms

record:
  every: 4
  fields: {block: [position, potential, pressure, stress]}
  probes: {height: {distance: ["block@[-1, -1, 0]", "block@[-1, 1, 0]"], along: [0, 1, 0]}}
)yaml";

constexpr std::string_view optimal_head = R"yaml(# yaml-language-server: $schema=../schemas/scene.schema.json
# A hinged bar is to turn by 7 degrees in 200 ms and be at rest there. Which fields of its two muscles take the least
# effort, if the bar never turns beyond 7.5 degrees and the field in the deformed muscles stays below 50 kV/mm? The replay
# runs what was found in finer steps and holds the bar afterwards.
# Run it:     muldi-sim optimise optimal.yaml       Look at it:  muldi-sim plot optimal.h5 --what joints,controls,optimum
# Any key:    muldi-sim explain optimal_control.limits
muldi: 1
title: Hinge with two muscles, least effort

)yaml";
constexpr std::string_view optimal_tasks = R"yaml(optimal_control:
  duration: 200 ms
  step: 10 ms
  controls:
    agonist: {min: 0, max: 50 kV/mm}
    antagonist: {min: 0, max: 50 kV/mm}
  initial: {pose: scene, momentum: rest}
  final: {joints: {hinge: 7 deg}, momentum: rest}
  limits:
    joints: {hinge: [-1 deg, 7.5 deg]}
    true_field: 50 kV/mm
  guess: scene
  stages:
    - {minimise: {feasibility: 1}}
    - {minimise: {effort: {scale: 1.0e-14}}}
  replay:
    step: 1 ms
    then: {duration: 300 ms, controls: {agonist: 28.73 kV/mm, antagonist: 0}}

record:
  every: 10
  points: [bar.upper]
)yaml";

constexpr std::array all{
    StarterText{.kind = "joint",
                .doc = "a hinged bar between two antagonistic muscles",
                .text = Joined<joint_head, hinge, joint_tasks>::text},
    StarterText{.kind = "muscle", .doc = "one actuator with free ends: statics and dynamics", .text = muscle},
    StarterText{.kind = "trunk", .doc = "a chain of three bodies with six muscles", .text = trunk},
    StarterText{.kind = "solid", .doc = "finite elements with an electrode, fields for ParaView", .text = solid},
    StarterText{.kind = "optimal",
                .doc = "the joint of least effort: limits, stages and a replay",
                .text = Joined<optimal_head, hinge, optimal_tasks>::text},
};

}  // namespace

std::span<const StarterText> starter_texts() { return all; }

}  // namespace muldi::scene
