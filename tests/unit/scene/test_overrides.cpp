#include "scene/overrides.hpp"

#include <gtest/gtest.h>

#include "base/text.hpp"
#include "reading.hpp"

namespace muldi::scene {
namespace {

const std::string motion = arm + "dynamics: {duration: 10, step: 1}\n";

TEST(Override, ReplacesAValue) {
  const Scene scene = scene_of(motion, {"dynamics.step=0.5 ms", "title=other"});
  EXPECT_EQ(scene.dynamics->step, 0.5);
  EXPECT_EQ(scene.title, "other");
}

TEST(Override, ReachesIntoLists) {
  EXPECT_EQ(scene_of(motion, {"bodies.arm.inertia[2]=1.5"}).bodies[0].value.inertia.tensor[2][2], 1.5);
}

TEST(Override, MakesMapsOnTheWay) {
  EXPECT_EQ(scene_of(motion, {"controls.push.force=3"}).controls.find("push")->value.value.at(0), 3.0);
  EXPECT_EQ(scene_of(motion, {"solver.tolerance=1e-8"}).solver.tolerance, 1e-8);
}

TEST(Override, TakesWholeYamlValues) {
  const Scene scene = scene_of(
      motion, {"gravity=[0, -9.81 m/s^2, 0]", "bodies.leg={mass: 2, inertia: [1, 1, 1], position: [0, 0, 0]}"});
  EXPECT_EQ(scene.gravity[1], -9.81 / 1000);
  EXPECT_EQ(scene.bodies.find("leg")->value.mass, 2.0);
}

TEST(Override, LeadsIntoNoEntryThatTheSceneLacks) {
  const std::string driven = motion + "controls: {agonist: {field: 1}, antagonist: {field: 0}}\n";
  EXPECT_EQ(errors_of(driven, {"controls.agonst.field=3"}),
            "--set controls.agonst.field=3: error: controls.agonst: the scene has no control 'agonst' (did you mean "
            "'agonist'?); a new one is set as a whole: controls.agonst={...}");
  EXPECT_EQ(errors_of(driven, {"bodies.amr.mass=3", "controls.pump.field=3"}),
            "--set bodies.amr.mass=3: error: bodies.amr: the scene has no body 'amr' (did you mean 'arm'?); a new one "
            "is set as a whole: bodies.amr={...}\n"
            "--set controls.pump.field=3: error: controls.pump: the scene has no control 'pump' (known: agonist, "
            "antagonist); a new one is set as a whole: controls.pump={...}");
  // A misspelt section is an unknown key.
  EXPECT_EQ(errors_of(driven, {"contrls.agonist.field=3"}),
            "--set contrls.agonist.field=3: error: contrls: unknown key (did you mean 'controls'?)");
}

TEST(Override, MakesAnEntryThatIsSetAsAWhole) {
  const Scene scene =
      scene_of(motion + "controls: {agonist: {field: 1}}\n", {"controls.supply={field: 2}", "controls.supply.field=3"});
  EXPECT_EQ(scene.controls.find("supply")->value.value.at(0), 3.0);
}

TEST(Override, LaterOnesWin) {
  EXPECT_EQ(scene_of(motion, {"dynamics.step=2", "dynamics.step=5"}).dynamics->step, 5.0);
}

TEST(Override, ChangesOneUseOfAMergedMapOnly) {
  const std::string text =
      "bodies:\n"
      "  a: &a {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}\n"
      "  b: {<<: *a}\n";
  const Scene scene = scene_of(text, {"bodies.b.mass=7"});
  EXPECT_EQ(scene.bodies[0].value.mass, 1.0);
  EXPECT_EQ(scene.bodies[1].value.mass, 7.0);
}

TEST(Override, MayHoldAnEqualsSign) { EXPECT_EQ(scene_of(motion, {"title=a=b"}).title, "a=b"); }

TEST(Override, BadPathsAreRefused) {
  const std::string wanted = ": error: needs path=value, such as dynamics.step=1 or loads.push.force[2]=3";
  for (const std::string text :
       {"", "=3", "a", "a..b=3", ".a=3", "a.=3", "[0]=3", "a[x]=3", "a[-1]=3", "a[0=3", "a[0]b=3"}) {
    EXPECT_EQ(errors_of(motion, {text}), base::format("--set {}{}", text, wanted));
  }
}

}  // namespace
}  // namespace muldi::scene
