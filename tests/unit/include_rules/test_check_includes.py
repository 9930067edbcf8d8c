#!/usr/bin/env python3
"""The include checker finds each kind of offence in a small tree, and nothing else."""

import pathlib
import tempfile
import unittest

import check_includes


def problems(files):
    """What the checker says of a tree with these files (path -> text)."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check_includes.Checker(folder).run()


class IncludeRules(unittest.TestCase):
    maxDiff = None

    def test_accepts_the_folders_of_the_table(self):
        self.assertEqual(problems({
            "lib/base/error.hpp": "#include <vector>\n",
            "lib/math/newton.hpp": '#include <Eigen/Core>\n\n#include "base/error.hpp"\n',
            "lib/model/model.hpp": '#include "math/newton.hpp"\n#include "model/state.hpp"\n',
            "lib/model/state.hpp": "",
            "lib/multibody/registry.hpp": '#include "model/model.hpp"\n',
            "lib/scene/scene.hpp": '#include "multibody/registry.hpp"\n',
            "app/main.cpp": '#include <CLI/CLI.hpp>\n\n#include "base/error.hpp"\n#include "scene/scene.hpp"\n',
        }), [])

    def test_rejects_a_folder_outside_the_table(self):
        self.assertEqual(problems({
            "lib/fem/mesh.hpp": "",
            "lib/multibody/body.cpp": '#include <array>\n\n#include "fem/mesh.hpp"\n',
        }), ['lib/multibody/body.cpp:3: multibody may not include "fem/mesh.hpp"'])

    def test_allows_only_the_named_files_of_a_folder(self):
        tree = {"lib/multibody/registry.hpp": "", "lib/multibody/joint.hpp": "", "lib/results/recorder.hpp": "", "lib/results/hdf5.hpp": ""}
        self.assertEqual(problems(tree | {
            "lib/scene/scene.hpp": '#include "multibody/joint.hpp"\n#include "multibody/registry.hpp"\n',
            "lib/control/objective.hpp": '#include "results/hdf5.hpp"\n#include "results/recorder.hpp"\n',
        }), ['lib/control/objective.hpp:1: control may not include "results/hdf5.hpp"',
             'lib/scene/scene.hpp:1: scene may not include "multibody/joint.hpp"'])

    def test_gives_the_attachment_files_more_than_their_folder(self):
        tree = {"lib/multibody/body.hpp": ""}
        self.assertEqual(problems(tree | {"lib/muscles/attachment.hpp": '#include "multibody/body.hpp"\n'}), [])
        self.assertEqual(problems(tree | {"lib/muscles/muscle.hpp": '#include "multibody/body.hpp"\n'}),
                         ['lib/muscles/muscle.hpp:1: muscles may not include "multibody/body.hpp"'])

    def test_rejects_an_unknown_folder_and_a_missing_file(self):
        self.assertEqual(problems({"lib/extra/a.hpp": "", "lib/math/a.hpp": '#include "b.hpp"\n'}),
                         ["lib/extra/a.hpp:1: folder extra is not in the include table",
                          'lib/math/a.hpp:1: "b.hpp" is no file under lib/ (paths start there; libraries take <>)'])

    def test_accepts_a_library_in_both_files_of_one_pair(self):
        self.assertEqual(problems({"lib/scene/yaml.hpp": "#include <yaml-cpp/yaml.h>\n",
                                   "lib/scene/yaml.cpp": "#include <yaml-cpp/yaml.h>\n"}), [])

    def test_rejects_a_second_wrapper(self):
        self.assertEqual(problems({"lib/scene/file.cpp": "#include <yaml-cpp/yaml.h>\n", "lib/scene/reader.cpp": "\n#include <yaml-cpp/yaml.h>\n"}),
                         ["lib/scene/file.cpp:1: yaml-cpp is wrapped by one file pair, but several include it: scene/file, scene/reader",
                          "lib/scene/reader.cpp:2: yaml-cpp is wrapped by one file pair, but several include it: scene/file, scene/reader"])

    def test_rejects_a_library_in_another_folder(self):
        self.assertEqual(problems({"lib/pipeline/run.cpp": "#include <CLI/CLI.hpp>\n"}),
                         ["lib/pipeline/run.cpp:1: pipeline/run.cpp may not include <CLI/CLI.hpp> of CLI11"])

    def test_keeps_sparse_libraries_in_the_solver_files(self):
        self.assertEqual(problems({"lib/math/linear_solver.cpp": "#include <klu.h>\n"}), [])
        self.assertEqual(problems({"lib/math/tensor.cpp": "#include <klu.h>\n#include <Eigen/KLUSupport>\n"}),
                         ["lib/math/tensor.cpp:1: math/tensor.cpp may not include <klu.h> of SuiteSparse, BLAS and METIS",
                          "lib/math/tensor.cpp:2: math/tensor.cpp may not include <Eigen/KLUSupport> of SuiteSparse, BLAS and METIS"])

    def test_rejects_unknown_and_unusable_headers(self):
        self.assertEqual(problems({"lib/base/a.cpp": "#include <boost/any.hpp>\n#include <ranges>\n"}),
                         ["lib/base/a.cpp:1: <boost/any.hpp> belongs to no library of the include table",
                          "lib/base/a.cpp:2: <ranges> may not be used: Clang 14 cannot read libstdc++'s"])

    def test_ignores_includes_in_comments(self):
        self.assertEqual(problems({"lib/base/a.hpp": '// #include "fem/mesh.hpp"\n/// #include <hdf5.h>\n'}), [])

    def test_accepts_the_link_lines_of_the_table(self):
        self.assertEqual(problems({
            "lib/model/CMakeLists.txt": "muldi_library(model SOURCES model.cpp LINKS muldi_base muldi_math)\n",
            "lib/control/CMakeLists.txt": "muldi_library(control\n  SOURCES nlp.cpp\n  LINKS muldi_variational muldi_results)\n",
            "lib/muscles/CMakeLists.txt": "muldi_library(muscles LINKS muldi_model muldi_multibody)\n",
            "lib/scene/CMakeLists.txt": "muldi_library(scene SOURCES a.cpp LINKS muldi_multibody yaml-cpp)  # muldi_build\n",
            "app/CMakeLists.txt": "target_link_libraries(muldi-sim PRIVATE muldi_pipeline CLI11::CLI11 muldi_warnings)\n",
        }), [])

    def test_rejects_link_lines_outside_the_table(self):
        self.assertEqual(problems({
            "lib/model/CMakeLists.txt": "muldi_library(model SOURCES model.cpp\n  LINKS muldi_base muldi_fem HDF5::HDF5)\n",
            "lib/scene/CMakeLists.txt": "\ntarget_link_libraries(muldi_scene PUBLIC muldi_build boost)\n",
        }), ["lib/model/CMakeLists.txt:1: model may not link muldi_fem",
             "lib/model/CMakeLists.txt:1: model may not link HDF5::HDF5 of HDF5",
             "lib/scene/CMakeLists.txt:2: scene may not link muldi_build",
             "lib/scene/CMakeLists.txt:2: boost belongs to no library of the include table"])


if __name__ == "__main__":
    unittest.main()
