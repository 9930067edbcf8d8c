#pragma once
/// Study files: many runs of one scene (`sweep: 1`), or parameters of a scene fitted to data (`calibrate: 1`).
///
/// Both name a scene and keys of it, written as with --set; `*` stands for every name of a section.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "scene/entries.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace muldi::scene {

inline constexpr int study_version = 1;

enum class StudyVerb { run, optimise };
std::span<const base::Word<StudyVerb>> words(StudyVerb);

/// How the points of a sweep follow from the values of its keys.
enum class Design { grid, list, lhs };
std::span<const base::Word<Design>> words(Design);

/// The values of one key.
struct VariedValues {
  enum class Kind { values, linspace, logspace, range };
  Kind kind = Kind::values;
  std::vector<std::string> texts = {};  ///< of `values`, each YAML
  std::string from = {};                ///< first, or smallest
  std::string to = {};                  ///< last, or largest
  int count = 0;                        ///< of linspace and logspace
  bool logarithmic = false;             ///< of a range
};

struct VariedKey {
  std::string path = {};
  Origin origin = {};
  VariedValues values = {};
};
struct VariedKeys {
  std::vector<VariedKey> items = {};
};

/// A quantity that is put into the table, e.g. `max(joints.hinge.coordinate)`.
struct SweepOutput {
  std::string name = {};
  Origin origin = {};
  std::string expression = {};
};
struct SweepOutputs {
  std::vector<SweepOutput> items = {};
};

/// Entries of the scene that hold for the whole study, as --set.
struct SetEntry {
  std::string path = {};
  Origin origin = {};
  std::string text = {};  ///< YAML
};
struct SetEntries {
  std::vector<SetEntry> items = {};
};

struct SweepStudy {
  std::string file = {};
  Origin origin = {};
  int version = study_version;
  std::string scene = {};
  SetEntries set = {};
  StudyVerb verb = StudyVerb::run;
  Design design = Design::grid;
  std::optional<int> samples = {};
  int seed = 1;
  VariedKeys vary = {};
  SweepOutputs outputs = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    constexpr auto optional = base::Need::optional;
    visit(Field{.key = "sweep", .doc = "format version", .range = {.min = study_version, .max = study_version}},
          self.version);
    visit(Field{.key = "scene", .doc = "scene file, from the folder of this file"}, self.scene);
    visit(
        Field{.key = "set", .doc = "entries of the scene for the whole study, as --set", .need = base::Need::optional},
        self.set);
    visit(Field{.key = "verb", .doc = "what is done with every point", .need = optional}, self.verb);
    visit(Field{.key = "design", .doc = "how the values make points", .need = optional}, self.design);
    visit(Field{.key = "samples", .doc = "points of a latin hypercube", .range = {.min = 1}, .need = optional},
          self.samples);
    visit(Field{.key = "seed", .doc = "of a latin hypercube", .range = base::non_negative, .need = optional},
          self.seed);
    visit(Field{.key = "vary", .doc = "values by key of the scene"}, self.vary);
    visit(Field{.key = "outputs", .doc = "columns of the table by name: a data set of the result, reduced to a number"},
          self.outputs);
  }
};

/// Bounds and start of one fitted parameter.
struct FitRange {
  std::string min = {};
  std::string max = {};
  std::optional<std::string> start = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    visit(Field{.key = "min", .doc = "lower bound, a quantity of the key"}, self.min);
    visit(Field{.key = "max", .doc = "upper bound"}, self.max);
    visit(Field{.key = "start", .doc = "first guess; default: the scene's value", .need = base::Need::optional},
          self.start);
  }
};
struct FittedKey {
  std::string path = {};
  Origin origin = {};
  FitRange range = {};
};
struct FittedKeys {
  std::vector<FittedKey> items = {};
};

/// How one data set of the result is compared with the reference.
struct Comparison {
  double weight = 1.0;
  std::optional<double> scale = {};
  std::optional<int> column = {};
  std::optional<std::string> unit = {};
  std::optional<std::string> data_set = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    constexpr auto optional = base::Need::optional;
    visit(Field{.key = "weight", .doc = "factor of the residuals", .range = base::positive, .need = optional},
          self.weight);
    visit(Field{.key = "scale",
                .doc = "what residuals are divided by, in the unit of the result; default: the largest reference value",
                .range = base::positive,
                .need = optional},
          self.scale);
    visit(Field{.key = "column", .doc = "column of a CSV reference, from 1", .range = {.min = 1}, .need = optional},
          self.column);
    visit(Field{.key = "unit", .doc = "of that column; default: that of the result", .need = optional}, self.unit);
    visit(Field{.key = "data_set",
                .doc = "path in the reference's result file, with dots; default: the same as here",
                .need = optional},
          self.data_set);
  }
};
struct ComparedKey {
  std::string path = {};  ///< data set with dots, perhaps [component] behind it
  Origin origin = {};
  Comparison comparison = {};
};
struct ComparedKeys {
  std::vector<ComparedKey> items = {};
};

struct CalibrateStudy {
  std::string file = {};
  Origin origin = {};
  int version = study_version;
  std::string scene = {};
  SetEntries set = {};
  std::string reference = {};
  std::optional<std::string> time_unit = {};
  FittedKeys fit = {};
  ComparedKeys compare = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using base::Field;
    visit(Field{.key = "calibrate", .doc = "format version", .range = {.min = study_version, .max = study_version}},
          self.version);
    visit(Field{.key = "scene", .doc = "scene file, from the folder of this file"}, self.scene);
    visit(
        Field{.key = "set", .doc = "entries of the scene for the whole study, as --set", .need = base::Need::optional},
        self.set);
    visit(Field{.key = "reference", .doc = "what is fitted to: a result (.h5) or a table (.csv)"}, self.reference);
    visit(Field{.key = "time_unit",
                .doc = "of the first column of a CSV reference; default: that of the scene",
                .need = base::Need::optional},
          self.time_unit);
    visit(Field{.key = "fit", .doc = "bounds by key of the scene"}, self.fit);
    visit(Field{.key = "compare", .doc = "data sets of the result that are compared, by path with dots"}, self.compare);
  }
};

/// Read a study file. InputError with every diagnostic that was found.
SweepStudy read_sweep_study(const std::string& path);
CalibrateStudy read_calibrate_study(const std::string& path);

/// The path of a file that the study names: from the study's folder unless it is absolute.
std::string path_of_file(const Origin& study, const std::string& file);

/// The JSON Schema (draft-07) of study files.
std::string study_schema_text();

/// The scene of a study as text, from which points are read with overrides.
class SceneText {
 public:
  /// `overrides`: of the command line, before those of the study. InputError if the file cannot be read or the scene is
  /// wrong.
  SceneText(const std::string& path, std::vector<std::string> overrides);

  const std::string& path() const { return path_; }
  /// The scene with further overrides; InputError as read_scene().
  Scene read(const std::vector<std::string>& overrides) const;
  /// The keys that `path` stands for: `*` is every name there. Errors, located at `origin`, for a name that its section
  /// does not have.
  std::vector<std::string> keys(const std::string& path, const Origin& origin,
                                std::vector<base::Diagnostic>& errors) const;
  /// The text of the file with these entries replaced, comments kept where that gives the wanted scene; else the tree
  /// without comments. `heading`: comment lines put first.
  std::string replaced(const std::vector<std::string>& overrides, const std::string& heading) const;

 private:
  std::string path_;
  std::string text_;
  std::vector<std::string> overrides_;
  Node root_;
};

/// The scene that a study names, with its `set:` and then the overrides of the command line. InputError, located in the
/// study where `set:` is to blame.
SceneText scene_of_study(const Origin& study, const std::string& scene, const SetEntries& set,
                         const std::vector<std::string>& overrides);

/// The number at `path` of the scene in its own units; nothing if there is none.
std::optional<double> number_at(const Scene& scene, const std::string& path);
/// The same of a resolved tree.
std::optional<double> number_at(const Node& resolved, const std::string& path);
/// resolved_text() as a tree.
Node resolved_tree(const Scene& scene);

}  // namespace muldi::scene
