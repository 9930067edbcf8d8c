"""Who may include whom in lib/ and app/: the one copy of the table that check_includes.py enforces.

`base` is the ground floor: every folder may use it. `build` and `pipeline` see `math` and `model` through the folders that they
assemble. Where a right side has a slash it is a file pattern and allows these files only.
"""

# folder -> folders or file patterns of lib/ that it may include, besides itself and base.
FOLDERS = {
    "base": [],
    "math": [],
    "model": ["math"],
    "fem": ["math", "model"],
    "multibody": ["math", "model"],
    "muscles": ["math", "model"],
    "variational": ["math", "model"],
    "statics": ["math", "model"],
    "control": ["math", "model", "variational", "results/recorder.hpp"],
    "results": ["math"],
    "scene": ["*/registry.hpp"],
    "build": ["math", "scene", "model", "fem", "multibody", "muscles"],
    "pipeline": ["math", "model", "scene", "multibody", "results", "build", "variational", "statics", "control"],
    "app": ["pipeline", "scene", "results"],
}

# files that may include more than their folder.
FILES = {
    "muscles/attachment*": ["fem", "multibody"],
}

# Libraries: which headers, which link targets, which folders may use them. `pairs` is the number of wrapper files (a header and a
# source file of one name count as one) that may include them; None is any number. `files` narrows the folders to a file pattern.
LIBRARIES = [
    {"name": "Eigen", "headers": r"(unsupported/)?Eigen/", "targets": r"Eigen3::Eigen", "pairs": None,
     "folders": ["math", "model", "fem", "multibody", "muscles", "variational", "statics", "control", "results", "build", "pipeline"]},
    {"name": "SuiteSparse, BLAS and METIS", "pairs": None, "folders": ["math"], "files": r"math/(sparse_\w+|\w*linear_solver\w*)\.",
     "headers": r"(suitesparse/|klu\.h|btf\.h|amd\.h|colamd\.h|camd\.h|ccolamd\.h|cholmod\.h|umfpack\.h|SuiteSparse|cblas|lapack|metis\.h"
                r"|Eigen/(KLU|Cholmod|UmfPack|Metis)Support)",
     "targets": r"(suitesparse::\w+|BLAS::\w+|LAPACK::\w+|[Mm]etis(::\w+)?)"},
    {"name": "fmt", "headers": r"fmt/", "targets": r"fmt::[\w-]+", "pairs": 1, "folders": ["base"]},
    {"name": "spdlog", "headers": r"spdlog/", "targets": r"spdlog::\w+", "pairs": 1, "folders": ["base"]},
    {"name": "UDUNITS-2", "headers": r"(udunits2?/)?(udunits2|converter)\.h", "targets": r"udunits2::\w+", "pairs": 1, "folders": ["base"]},
    {"name": "yaml-cpp", "headers": r"yaml-cpp/", "targets": r"yaml-cpp(::[\w-]+)?", "pairs": 1, "folders": ["scene"]},
    {"name": "muParser", "headers": r"muParser", "targets": r"PkgConfig::muparser|muparser::\w+", "pairs": 1,
     "folders": ["base", "math", "scene"]},
    {"name": "HDF5", "headers": r"(hdf5(_hl)?\.h|H5\w*\.h|hdf5/)", "targets": r"(HDF5::HDF5|hdf5::[\w-]+)", "pairs": 3, "folders": ["results"]},
    {"name": "Ipopt", "headers": r"(coin/)?Ip\w+\.hpp", "targets": r"([Ii]popt::\w+|PkgConfig::ipopt)", "pairs": 1, "folders": ["control"]},
    {"name": "CLI11", "headers": r"CLI/", "targets": r"CLI11::CLI11", "pairs": 1, "folders": ["app"]},
    {"name": "the operating system", "headers": r"(unistd|fcntl|dlfcn|signal|poll|termios|sched|execinfo|malloc)\.h|sys/\w+\.h|linux/", "targets": r"dl|Threads::Threads",
     "pairs": None, "folders": ["base", "math", "control", "results", "scene", "pipeline", "app"]},
]

# Link targets of our own that are not folders.
OWN_TARGETS = {"muldi_warnings", "muldi_build_info"}

# Headers that the build writes.
GENERATED = {"base/build_commit.hpp", "base/build_facts.hpp"}

# Headers of the C++20 standard library (the C++23 ones and the .h forms of C are left out on purpose).
STANDARD = set("""
algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes climits clocale cmath
codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib cstring ctime
cuchar cwchar cwctype deque exception execution filesystem forward_list fstream functional future initializer_list iomanip ios
iosfwd iostream istream iterator latch limits list locale map memory memory_resource mutex new numbers numeric optional ostream
queue random ratio regex scoped_allocator semaphore set shared_mutex source_location span sstream stack stdexcept stop_token
streambuf string string_view strstream syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map
unordered_set utility valarray variant vector version
""".split())

# Standard headers that one of our compilers cannot read (GCC 12 has no <format>, Clang 14 fails on libstdc++'s <ranges>).
UNUSABLE = {"format": "GCC 12 has none: use base/text.hpp", "ranges": "Clang 14 cannot read libstdc++'s"}
