#include "scene/solids.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reading.hpp"

namespace muldi::scene {
namespace {

const std::string materials =
    "materials:\n"
    "  silicone:\n"
    "    density: 1 g/cm^3\n"
    "    elastic: {model: neo_hookean, young: 0.7 MPa, poisson: 0.5}\n"
    "    electric: {model: ideal_dielectric, relative_permittivity: 3.1}\n"
    "  gel: {density: 1, elastic: {model: gent, mu: 0.1, J_m: 40, kappa: 10, volumetric: logarithmic}}\n"
    "  thesis:\n"
    "    density: 1e-3\n"
    "    elastic: {model: bonet_wood, mu: 0.233, lambda: 999.8}\n"
    "    electric: {model: vu, c1: 5e-8, c2: 1e-9}\n"
    "  rubber: {density: 1, elastic: {model: mooney_rivlin, mu_1: 0.3, mu_2: 0.1, poisson: 0.49}}\n";

/// The example of the format, and a second solid with a bit of everything else.
const std::string rich =
    materials +
    "bodies: {pendulum: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0], points: {tip: [1, 0, 0]}}}\n"
    "controls:\n"
    "  supply: {potential: 20 kV}\n"
    "  charge: {charge: 1 nC}\n"
    "  push: {displacement: {ramp: {to: 1 mm, over: 10}}}\n"
    "  load: {pressure: 1 kPa}\n"
    "solids:\n"
    "  cube:\n"
    "    mesh: {box: {size: [2, 2, 2], cells: [8, 8, 8], centre: [0, 0, 0]}}\n"
    "    position: [0, 0, 1 cm]\n"
    "    orientation: {axis: [0, 0, 1], angle: 90 deg}\n"
    "    material: thesis\n"
    "    formulation: displacement\n"
    "    conditions:\n"
    "      - {where: x-, displacement: [0, ~, {control: push}]}\n"
    "      - {where: y-, displacement: [~, 0, ~], potential: 0 V}\n"
    "      - {where: {face: y+, x: [~, 0]}, potential: {control: supply}}\n"
    "      - {where: y+, traction: [0, -1 kPa, {control: load}]}\n"
    "      - {where: z+, pressure: {control: load}, surface_charge: 1 uC/m^2}\n"
    "      - {where: {box: [[0, ~, 0], [1, 1, ~]]}, body_force: [0, 0, {ramp: {to: 1, over: 2}}]}\n"
    "      - {where: {plane: {z: 1 mm, y: 1}}, displacement: [0, 0, 0]}\n"
    "      - {where: {point: [0, 0, 1]}, displacement: [0, 0, 0]}\n"
    "      - {where: {part: solid}, body_force: [0, 0, 1]}\n"
    "      - {where: all, body_force: [0, 0, 1]}\n"
    "    electrodes:\n"
    "      e1: {where: {plane: {z: 1}}, charge: 0}\n"
    "      e2: {where: {face: x+, z: [-1, 1]}, charge: {control: charge}}\n"
    "      e3: {where: z-, potential: 5 V}\n"
    "    attach: [{where: x+, body: pendulum}, {where: {set: tip}, solid: bar, where_other: z+}]\n"
    "  bar:\n"
    "    mesh: {stack: {section: {cylinder: {diameter: 10, core: 5, rings: 11, part: quarter}}, axis: x,\n"
    "           layers: [{part: electrode, thickness: 2 um, cells: 5}, {part: film, thickness: 10 um, cells: 25}],\n"
    "           repeat: 3, close: electrode}}\n"
    "    material: {electrode: gel, film: silicone}\n"
    "    electrodes:\n"
    "      a: {alternate: layers, potentials: [0 V, {control: supply}]}\n"
    "      b: {alternate: parts, part: electrode, potentials: [0, 1, 2]}\n"
    "  rod:\n"
    "    mesh: {cylinder: {diameter: 10, length: 100, axis: y, layers: 32, section_cells: 16, rim: straight}}\n"
    "    material: rubber\n"
    "  imported: {mesh: {file: part.msh, scale: 1000}, material: {inner part: rubber}}\n"
    "initial: {solids: {cube: {velocity: [0, 0, 0], angular_velocity: [0, 0, 1 rad/s]}}}\n"
    "record:\n"
    "  fields: {cube: [position, potential, stress], rod: {fields: [position, jacobian], every: 10}}\n"
    "  probes:\n"
    "    height: {distance: [\"cube@[-1,-1,0]\", \"cube@[-1 mm,1,0]\"], along: [0, 1, 0]}\n"
    "    gap: {distance: [\"cube@[-1,-1,0]\", pendulum.tip]}\n"
    "    corner: {point: \"cube@[1, 1, 1]\", of: potential}\n"
    "    end: {average: \"rod@y+\", along: [0, 1, 0]}\n"
    "    hold: {reaction: \"cube@x-\"}\n"
    "    part: {reaction: {solid: cube, where: {plane: {x: -1}}}, along: [1, 0, 0]}\n"
    "    q: {charge: cube.e3}\n";

/// Sets of nodes are known to files only, and names of parts are names.
std::string good(std::string text) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("{where: {set: tip}, solid", "{where: {plane: {x: 1}}, solid");
  replace("where_other: z+", "where_other: x+");
  replace("inner part", "inner");
  return text;
}

TEST(Solids, ReadTheExampleOfTheFormat) {
  const Scene scene = scene_of(good(rich));
  const Solid& cube = scene.solids.find("cube")->value;
  EXPECT_EQ(std::get<fem::Box>(cube.mesh).cells, (std::array<int, 3>{8, 8, 8}));
  EXPECT_EQ(cube.position, (Vec3{0, 0, 10}));
  EXPECT_NEAR(cube.orientation.matrix[1][0], 1, 1e-15);
  EXPECT_EQ(cube.material.whole.name, "thesis");
  EXPECT_EQ(cube.formulation, Formulation::displacement);

  const Condition& roller = cube.conditions[0];
  EXPECT_EQ(std::get<fem::SelectFace>(roller.where.selector).face, "x-");
  EXPECT_EQ((*roller.displacement)[0]->value.at(3.0), 0.0);
  EXPECT_FALSE((*roller.displacement)[1].has_value());
  EXPECT_EQ((*roller.displacement)[2]->control.name, "push");
  EXPECT_FALSE(roller.potential.has_value());
  const auto& half = std::get<fem::SelectFace>(cube.conditions[2].where.selector);
  EXPECT_EQ(half.face, "y+");
  EXPECT_EQ(half.x, (fem::Interval{.low = std::nullopt, .high = 0.0}));
  EXPECT_EQ(cube.conditions[2].potential->control.name, "supply");
  EXPECT_NEAR((*cube.conditions[3].traction)[1].value.at(0.0), -1e-3, 1e-18);  // MPa
  EXPECT_NEAR(cube.conditions[4].surface_charge->value.at(0.0), 1e-9, 1e-24);  // mC/mm^2
  EXPECT_EQ(std::get<fem::SelectBox>(cube.conditions[5].where.selector).box[0][1], std::nullopt);
  EXPECT_EQ(std::get<fem::SelectPlane>(cube.conditions[6].where.selector).plane.z, 1.0);
  EXPECT_TRUE(std::holds_alternative<fem::SelectAll>(cube.conditions[9].where.selector));

  EXPECT_EQ(cube.electrodes.find("e1")->value.charge->value.at(0.0), 0.0);
  EXPECT_EQ(cube.electrodes.find("e2")->value.charge->control.name, "charge");
  EXPECT_EQ(cube.attach[0].body->name, "pendulum");
  EXPECT_EQ(cube.attach[1].solid->name, "bar");
}

TEST(Solids, ReadStacksCylindersAndFiles) {
  const Scene scene = scene_of(good(rich));
  const auto& stack = std::get<fem::Stack>(scene.solids.find("bar")->value.mesh);
  EXPECT_EQ(stack.layers[0].thickness, 2e-3);
  EXPECT_EQ(stack.n_cells(), 12825);  // thesis 4.5.1
  EXPECT_EQ(stack.axis, fem::Axis::x);
  EXPECT_EQ(stack.close, "electrode");
  EXPECT_EQ(scene.solids.find("bar")->value.electrodes.find("b")->value.potentials.size(), 3u);
  EXPECT_EQ(scene.solids.find("bar")->value.material.parts.find("film")->value.name, "silicone");
  const auto& rod = std::get<fem::Cylinder>(scene.solids.find("rod")->value.mesh);
  EXPECT_EQ(rod.section.rim, fem::Rim::straight);
  EXPECT_EQ(rod.n_cells(), 512);
  const auto& file = std::get<fem::MeshFile>(scene.solids.find("imported")->value.mesh);
  EXPECT_EQ(file.path, "part.msh");
  EXPECT_EQ(file.scale, 1000);
}

TEST(Solids, ReadInitialVelocitiesFieldsAndProbes) {
  const Scene scene = scene_of(good(rich));
  EXPECT_NEAR((*scene.initial.solids.find("cube")->value.angular_velocity)[2], 1e-3, 1e-18);  // rad/ms
  const RecordedFields& fields = scene.record.fields.find("rod")->value;
  EXPECT_EQ(fields.fields, (std::vector<SolidField>{SolidField::position, SolidField::jacobian}));
  EXPECT_EQ(fields.every, 10);
  EXPECT_EQ(scene.record.fields.find("cube")->value.every, 1);
  const auto& gap = std::get<DistanceProbe>(scene.record.probes.find("gap")->value);
  EXPECT_EQ(gap.distance[0].solid->name, "cube");
  EXPECT_EQ(gap.distance[0].at, (Vec3{-1, -1, 0}));
  EXPECT_EQ(gap.distance[1].point.position, (Vec3{1, 0, 0}));  // of the body's point, resolved
  const auto& end = std::get<AverageProbe>(scene.record.probes.find("end")->value);
  EXPECT_EQ(std::get<fem::SelectFace>(end.average.where.selector).face, "y+");
  EXPECT_EQ(end.of, ProbeQuantity::position);
}

TEST(Solids, ResolvedTextReadsBackEqual) {
  const Scene scene = scene_of(good(rich));
  const std::string text = resolved_text(scene);
  const Scene again = read_scene_text(text, "resolved.yaml");
  EXPECT_TRUE(again == scene) << text;
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_FALSE(scene == scene_of(good(rich), {"solids.cube.mesh.box.cells[1]=9"}));
}

TEST(Solids, ResolvedTextHoldsTheDefaults) {
  const std::string text = resolved_text(
      scene_of(materials + "solids: {rod: {mesh: {cylinder: {diameter: 10, length: 100, layers: 2, section_cells: 4}}, "
                           "material: gel, conditions: [{where: {face: z-, x: [~, 0]}, pressure: 1}]}}\n"));
  EXPECT_NE(text.find("solids:\n"
                      "  rod:\n"
                      "    mesh:\n"
                      "      cylinder:\n"
                      "        diameter: 10\n"
                      "        section_cells: 4\n"
                      "        part: full\n"
                      "        rim: circle\n"
                      "        length: 100\n"
                      "        axis: z\n"
                      "        layers: 2\n"
                      "    position: [0, 0, 0]\n"
                      "    orientation: {matrix: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}\n"
                      "    material: gel\n"
                      "    conditions: [{where: {face: \"z-\", x: [~, 0]}, pressure: 1}]\n"),
            std::string::npos)
      << text;
}

TEST(Solids, FormulationFollowsTheMaterial) {
  const Scene scene = scene_of(good(rich));
  const auto of = [&](const char* solid, const char* material) {
    return formulation_of(scene.solids.find(solid)->value.formulation, scene.materials.find(material)->value);
  };
  EXPECT_EQ(of("bar", "silicone"), Formulation::incompressible);
  EXPECT_EQ(of("bar", "gel"), Formulation::mean_dilatation);
  EXPECT_EQ(of("cube", "thesis"), Formulation::displacement);
}

TEST(Solids, KnowWhetherTheyHaveAField) {
  const Scene scene = scene_of(good(rich));
  EXPECT_TRUE(has_field(scene.solids.find("cube")->value));
  EXPECT_TRUE(has_field(scene.solids.find("bar")->value));
  EXPECT_FALSE(has_field(scene.solids.find("rod")->value));
}

TEST(Solids, WarnAboutTheLegacyLaw) {
  const Scene scene = scene_of(good(rich));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(to_string(scene.warnings[0]),
            "test.yaml:11:15: warning: materials.thesis.electric: the law vu only serves to reproduce earlier work, "
            "whose constants mean a negative permittivity; to predict, take ideal_dielectric");
}

TEST(ElasticLaws, KnowTheirModuliAtRest) {
  const Scene scene = scene_of(materials);
  const Elastic& gent = scene.materials.find("gel")->value.elastic;
  EXPECT_EQ(gent.shear_modulus(), 0.1);
  EXPECT_NEAR(gent.bulk_modulus(), 10, 1e-10);
  EXPECT_EQ(std::get<Gent>(gent.law).volumetric, Volumetric::logarithmic);
  const Elastic& mooney = scene.materials.find("rubber")->value.elastic;
  EXPECT_DOUBLE_EQ(mooney.shear_modulus(), 0.4);
  EXPECT_EQ(mooney.poisson_ratio(), 0.49);
  const Elastic& bonet = scene.materials.find("thesis")->value.elastic;
  EXPECT_DOUBLE_EQ(bonet.shear_modulus(), 0.233);
  EXPECT_NEAR(bonet.bulk_modulus(), 999.8 + 2 * 0.233 / 3, 1e-6);  // kappa = lambda + 2/3 mu
  EXPECT_FALSE(bonet.incompressible());
  const Elastic& silicone = scene.materials.find("silicone")->value.elastic;
  EXPECT_TRUE(silicone.incompressible());
  EXPECT_TRUE(std::isinf(silicone.bulk_modulus()));
}

TEST(MeshFiles, HaveTheirNamesCheckedLater) {
  const Scene scene = scene_of(materials +
                               "solids: {part: {mesh: {file: a.msh}, material: {one: gel, two: rubber}, conditions: "
                               "[{where: anything, displacement: [0, 0, 0]}, {where: {set: any}, displacement: [0, 0, "
                               "0]}]}}\n");
  EXPECT_EQ(scene.solids[0].value.conditions.size(), 2u);
}

}  // namespace
}  // namespace muldi::scene
