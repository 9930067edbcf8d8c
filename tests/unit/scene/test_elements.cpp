/// The battery that every type of spring and every model of muscles passes, and what scenes may say of them.
#include <gtest/gtest.h>

#include "reading.hpp"
#include "scene/schema.hpp"
#include "support/plausible.hpp"
#include "support/types_of.hpp"

namespace muldi::scene {
namespace {

class Names {
 public:
  template <class Component>
  static std::string GetName(int) {  // NOLINT(readability-identifier-naming): GoogleTest asks for this name
    return std::string(Component::name);
  }
};

/// A scene with what an element needs around it.
const std::string around =
    arm +
    "materials: {silicone: {density: 1, elastic: {model: neo_hookean, young: 1, poisson: 0.5}}}\n"
    "controls: {e: {field: 1}}\n";
const Attachment tip{.body = {.name = "arm"}, .at = {.name = "tip", .position = {1, 0, 0}}};
const Attachment origin{.body = {.name = "ground"}, .at = {.position = {0, 0, 0}}};

void expect_round_trip(const Scene& scene) {
  const std::string text = resolved_text(scene);
  const Scene again = read_scene_text(text, "resolved.yaml");
  EXPECT_TRUE(again == scene) << text;
  EXPECT_EQ(resolved_text(again), text);
}

template <class Type>
class SpringTypeTest : public testing::Test {};
TYPED_TEST_SUITE(SpringTypeTest, test::TypesOf<muscles::SpringTypes>::type, Names);

TYPED_TEST(SpringTypeTest, IsReadAsItIsWritten) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Scene scene = scene_of(around, {"controls={}"});
    scene.springs.add({.name = "s", .value = {.from = tip, .to = origin, .type = test::plausible<TypeParam>(seed)}});
    expect_round_trip(scene);
  }
}

template <class Model>
class MuscleModelTest : public testing::Test {};
TYPED_TEST_SUITE(MuscleModelTest, test::TypesOf<muscles::MuscleModels>::type, Names);

TYPED_TEST(MuscleModelTest, IsReadAsItIsWritten) {
  int n_read = 0;
  for (unsigned seed = 0; seed < 16; ++seed) {
    const auto options = test::plausible<TypeParam>(seed);
    if (options.fault()) continue;
    ++n_read;
    Muscle muscle;
    muscle.model = muscle_model<TypeParam>;
    muscle.from = tip;
    muscle.to = origin;
    muscle.section = {muscles::RoundSection{.diameter = 3}};
    muscle.material = {.name = "silicone"};
    muscle.layer_thickness = 1.0;
    std::get<std::optional<TypeParam>>(muscle.options) = options;
    const bool driven = options.is_driven(false);
    Scene scene = scene_of(around, {driven ? "controls={e: {" + std::string(TypeParam::quantities[0]) + ": 1}}"
                                           : std::string("controls={}")});
    if (driven) muscle.control = ControlName{.name = "e"};
    scene.muscles.add({.name = "m", .value = muscle});
    expect_round_trip(scene);
  }
  EXPECT_GT(n_read, 0);
}

TYPED_TEST(MuscleModelTest, IsDrivenByQuantitiesThatScenesKnow) {
  for (const std::string_view quantity : TypeParam::quantities) {
    bool known = false;
    for (const auto& word : words(ControlQuantity{})) known = known || (word.word == quantity);
    EXPECT_TRUE(known) << quantity;
  }
}

std::string spring(const std::string& fields) {
  return arm + "springs: {s: {from: {body: arm, at: tip}, to: {body: ground, at: [0, 0, 0]}, " + fields + "}}\n";
}

TEST(Springs, AreLinearUnlessTheirTypeIsSaid) {
  const Scene scene = scene_of(spring("stiffness: 2 N/m, damping: 1 N s/m"));
  const muscles::LinearSpring expected{.stiffness = 2e-3, .damping = 1.0};
  EXPECT_EQ(std::get<muscles::LinearSpring>(scene.springs[0].value.type), expected);
  EXPECT_EQ(scene, scene_of(spring("type: linear, stiffness: 2 N/m, damping: 1 N s/m")));
  EXPECT_NE(resolved_text(scene).find("type: linear"), std::string::npos);
}

TEST(Springs, MayBeCables) {
  const Scene scene = scene_of(spring("type: cable, stiffness: 2, rest_length: 1 cm, transition: 0.5"));
  const muscles::CableSpring expected{.stiffness = 2.0, .rest_length = 10.0, .transition = 0.5};
  EXPECT_EQ(std::get<muscles::CableSpring>(scene.springs[0].value.type), expected);
}

TEST(Springs, SchemaAsksForTheFieldsOfTheFirstTypeWithoutTheKey) {
  const Node tree = schema_tree();
  const Node& spring = *tree.find("properties")->find("springs")->find("additionalProperties");
  EXPECT_EQ(spring.find("properties")->find("type")->find("default")->text, "linear");
  const Node& conditions = *spring.find("allOf");
  ASSERT_EQ(conditions.items.size(), muscles::SpringTypes::size);
  EXPECT_EQ(conditions.items[0].find("if")->find("required"), nullptr);
  EXPECT_EQ(conditions.items[0].find("then")->find("required")->items[0].text, "stiffness");
  EXPECT_EQ(conditions.items[1].find("if")->find("required")->items[0].text, "type");
  for (const Node& key : spring.find("required")->items) EXPECT_NE(key.text, "type");
}

TEST(Muscles, ModelHasItsDefaultsWithoutOptions) {
  const Scene scene = scene_of(around +
                                   "muscles: {m: {model: lumped, from: {body: arm, at: tip}, to: {body: ground, at: "
                                   "[0, 0, 0]}, section: {shape: round, diameter: 1}, material: silicone}}\n",
                               {"controls={}"});
  EXPECT_EQ(std::get<std::optional<muscles::LumpedModel>>(scene.muscles[0].value.options), muscles::LumpedModel{});
  EXPECT_NE(resolved_text(scene).find("lumped: {inertia: consistent, end_factor: 0}"), std::string::npos);
}

}  // namespace
}  // namespace muldi::scene
