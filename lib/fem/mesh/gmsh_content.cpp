#include "fem/mesh/gmsh_content.hpp"

#include <algorithm>
#include <bit>

#include "base/text.hpp"
#include "fem/mesh/gmsh_source.hpp"

namespace muldi::fem {
namespace {

constexpr GmshElementType types[] = {
    {1, 1, 2, "lines"},
    {2, 2, 3, "triangles"},
    {3, 2, 4, "quadrangles"},
    {4, 3, 4, "tetrahedra"},
    {5, 3, 8, "hexahedra"},
    {6, 3, 6, "prisms"},
    {7, 3, 5, "pyramids"},
    {8, 1, 3, "lines of 3 nodes"},
    {9, 2, 6, "triangles of 6 nodes"},
    {10, 2, 9, "quadrangles of 9 nodes"},
    {11, 3, 10, "tetrahedra of 10 nodes"},
    {12, 3, 27, "hexahedra of 27 nodes"},
    {13, 3, 18, "prisms of 18 nodes"},
    {14, 3, 14, "pyramids of 14 nodes"},
    {15, 0, 1, "points"},
    {16, 2, 8, "quadrangles of 8 nodes"},
    {17, 3, 20, "hexahedra of 20 nodes"},
    {18, 3, 15, "prisms of 15 nodes"},
    {19, 3, 13, "pyramids of 13 nodes"},
};

bool is_read(int type) {
  return type == gmsh_type::line || type == gmsh_type::quadrangle || type == gmsh_type::hexahedron ||
         type == gmsh_type::point;
}

class SectionReader {
 public:
  SectionReader(GmshSource& source, GmshContent& content) : source_(source), content_(content) {}

  void run() {
    read_format();
    for (std::string_view word = source_.word(); !word.empty(); word = source_.word()) {
      if (word.front() != '$') source_.fail("needs a section that starts with $, got " + base::in_quotes(word));
      const std::string section(word.substr(1));
      source_.enter(section);
      read_section(section);
    }
  }

  bool has_nodes() const { return has_nodes_; }

 private:
  void read_section(const std::string& section) {
    if (section == "PhysicalNames") {
      read_group_names();
    } else if (section == "Entities" && version_4_) {
      source_.line();
      read_entities();
    } else if (section == "Nodes") {
      has_nodes_ = true;
      source_.line();
      version_4_ ? read_nodes_4() : read_nodes_2();
    } else if (section == "Elements") {
      source_.line();
      version_4_ ? read_elements_4() : read_elements_2();
    } else {
      if (!source_.skip_past("$End" + section)) source_.fail_file("ends within $" + section);
      return;
    }
    source_.expect_end();
  }

  void read_format() {
    const std::string_view first = source_.word();
    if (first != "$MeshFormat") {
      source_.fail_file("no mesh of Gmsh: it starts with " + base::in_quotes(first) + ", not with '$MeshFormat'");
    }
    source_.enter("MeshFormat");
    const std::string version(source_.word());
    version_4_ = version == "4.1";
    if (!version_4_ && version != "2.2") {
      source_.fail("format " + base::in_quotes(version) + " is not read: write 4.1 or 2.2 (gmsh -format msh41)");
    }
    const long kind = source_.text_integer();
    if (source_.text_integer() != 8) source_.fail("needs numbers of 8 bytes");
    if (kind == 1) {
      source_.line();
      source_.set_binary(false);
      const long one = source_.integer();
      constexpr long one_swapped = 0x01000000;
      if (one == one_swapped) source_.set_binary(true);
      if (one != 1 && one != one_swapped) source_.fail("the binary file has no valid mark of its byte order");
    }
    source_.expect_end();
  }

  void read_group_names() {
    const long n = source_.text_integer();
    for (long i = 0; i < n; ++i) {
      const long dimension = source_.text_integer();
      const long number = source_.text_integer();
      const std::string_view quoted = source_.line();
      if (quoted.size() < 2 || quoted.front() != '"' || quoted.back() != '"') {
        source_.fail("$PhysicalNames needs a name in quotes, got " + base::in_quotes(quoted));
      }
      content_.group_names[{static_cast<int>(dimension), static_cast<int>(number)}] =
          quoted.substr(1, quoted.size() - 2);
    }
  }

  void read_entities() {
    long n[4];
    for (long& count : n) count = source_.count_of(source_.size(), "entities", 4);
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (long i = 0; i < n[dimension]; ++i) {
        const long tag = source_.integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) source_.real();
        std::vector<int>& groups = groups_of_entity_[{dimension, tag}];
        for (long k = source_.count_of(source_.size(), "groups", 2); k > 0; --k) {
          groups.push_back(static_cast<int>(std::abs(source_.integer())));  // negative: turned round
        }
        if (dimension == 0) continue;
        for (long k = source_.count_of(source_.size(), "boundaries", 2); k > 0; --k) source_.integer();
      }
    }
  }

  void add_node(long tag, const base::Vec3& position) {
    content_.node_tags.push_back(tag);
    content_.nodes.push_back(position);
  }

  base::Vec3 position() {
    const double x = source_.real();
    const double y = source_.real();
    return {x, y, source_.real()};
  }

  void read_nodes_2() {
    const long n = source_.count_of(source_.text_integer(), "nodes", 8);
    if (source_.binary()) source_.line();
    for (long i = 0; i < n; ++i) {
      const long tag = source_.integer();
      add_node(tag, position());
    }
  }

  void read_nodes_4() {
    const long n_blocks = source_.size();
    for (int i = 0; i < 3; ++i) source_.size();  // number of nodes, least and largest tag
    for (long block = 0; block < n_blocks; ++block) {
      const long dimension = source_.integer();
      source_.integer();
      const bool parametric = source_.integer() != 0;
      const long n = source_.count_of(source_.size(), "nodes", 8);
      std::vector<long> tags;
      for (long i = 0; i < n; ++i) tags.push_back(source_.size());
      for (const long tag : tags) {
        add_node(tag, position());
        for (long i = 0; parametric && i < dimension; ++i) source_.real();
      }
    }
  }

  const GmshElementType& element_type(long number) {
    const GmshElementType* type = find_element_type(number);
    if (type == nullptr)
      source_.fail("$Elements has elements of type " + std::to_string(number) +
                   ": only hexahedra of 8 nodes are cells");
    return *type;
  }

  template <class ReadTag>
  void read_element(const GmshElementType& type, long tag, std::vector<int> groups, ReadTag read_tag) {
    GmshElement element{.tag = tag, .type = type.number, .groups = std::move(groups)};
    for (int i = 0; i < type.n_nodes; ++i) element.nodes.push_back(read_tag());
    if (is_read(type.number)) {
      content_.elements.push_back(std::move(element));
    } else {
      ++content_.refused[type.number];
    }
  }

  /// The first tag of an element is its physical group, 0 for none.
  void read_element_2(const GmshElementType& type, long tag, long n_tags) {
    std::vector<int> groups;
    for (long i = 0; i < n_tags; ++i) {
      const auto group = static_cast<int>(std::abs(source_.integer()));
      if (i == 0 && group != 0) groups.push_back(group);
    }
    read_element(type, tag, std::move(groups), [this] { return source_.integer(); });
  }

  void read_elements_2() {
    const long n = source_.count_of(source_.text_integer(), "elements", 8);
    if (!source_.binary()) {
      for (long i = 0; i < n; ++i) {
        const long tag = source_.integer();
        const GmshElementType& type = element_type(source_.integer());
        read_element_2(type, tag, source_.integer());
      }
      return;
    }
    source_.line();
    for (long i = 0; i < n;) {
      const GmshElementType& type = element_type(source_.integer());
      const long n_in_block = source_.count_of(source_.integer(), "elements", 8);
      const long n_tags = source_.integer();
      if (n_in_block == 0) source_.fail("$Elements has an empty block");
      for (long k = 0; k < n_in_block; ++k, ++i) {
        const long tag = source_.integer();
        read_element_2(type, tag, n_tags);
      }
    }
  }

  void read_elements_4() {
    const long n_blocks = source_.size();
    for (int i = 0; i < 3; ++i) source_.size();  // number of elements, least and largest tag
    for (long block = 0; block < n_blocks; ++block) {
      const auto dimension = static_cast<int>(source_.integer());
      const long entity = source_.integer();
      const GmshElementType& type = element_type(source_.integer());
      const long n = source_.count_of(source_.size(), "elements", 4);
      const std::vector<int> groups = groups_of_entity_[{dimension, entity}];
      for (long i = 0; i < n; ++i) {
        const long tag = source_.size();
        read_element(type, tag, groups, [this] { return source_.size(); });
      }
    }
  }

  GmshSource& source_;
  GmshContent& content_;
  bool version_4_ = false;
  bool has_nodes_ = false;
  std::map<std::pair<int, long>, std::vector<int>> groups_of_entity_;
};

}  // namespace

const GmshElementType* find_element_type(long number) {
  const auto* found =
      std::find_if(std::begin(types), std::end(types), [&](const GmshElementType& t) { return t.number == number; });
  return found == std::end(types) ? nullptr : found;
}

GmshContent read_gmsh_content(std::string_view content, const std::string& name) {
  GmshSource source(content, name);
  GmshContent result;
  SectionReader reader(source, result);
  reader.run();
  if (!reader.has_nodes()) source.fail_file("has no $Nodes");
  return result;
}

}  // namespace muldi::fem
