/// Solids that are fixed to a body at one point or along one line are hinges, and the user is told (numerics 5 no. 29).
#include <gtest/gtest.h>

#include "build/built_model.hpp"
#include "scene/read_scene.hpp"

namespace muldi {
namespace {

/// What the builder notes of a cube between ground and a plate, fixed to the plate at `where`.
std::vector<std::string> notes_of(const std::string& where) {
  const scene::Scene scene = scene::read_scene_text(
      "muldi: 1\n"
      "materials: {m: {density: 1e-3, elastic: {model: neo_hookean, mu: 0.2, poisson: 0.45}}}\n"
      "solids:\n"
      "  cube:\n"
      "    mesh: {box: {size: [2, 2, 2], cells: [2, 2, 2], centre: [0, 0, 0]}}\n"
      "    material: m\n"
      "    attach: [{where: x-, body: ground}, {where: " +
          where +
          ", body: plate}]\n"
          "bodies: {plate: {mass: 2, inertia: [3, 4, 5], position: [1.5, 0, 0]}}\n",
      "cube.yaml");
  std::vector<std::string> notes;
  for (const base::Diagnostic& note : build::build_model(scene).notes) notes.push_back(note.message);
  return notes;
}

const std::string firmly = ": choose nodes that are not in one line if it is to hold firmly";

TEST(HingedSolids, AreToldOf) {
  EXPECT_EQ(notes_of("{point: [1, 1, 1]}"),
            std::vector<std::string>{"solid 'cube' is fixed to 'plate' at one point, which is a ball joint" + firmly});
  EXPECT_EQ(notes_of("{plane: {x: 1, z: 1}}"),
            std::vector<std::string>{"solid 'cube' is fixed to 'plate' along one line, which is a hinge" + firmly});
  EXPECT_EQ(notes_of("x+"), std::vector<std::string>{});
}

}  // namespace
}  // namespace muldi
