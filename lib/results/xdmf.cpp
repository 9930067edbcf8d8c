#include "results/xdmf.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/special_file.hpp"
#include "base/text.hpp"
#include "results/hdf5_file.hpp"
#include "results/xdmf_drawing.hpp"

namespace muldi::results {
namespace {

/// One field of a solid.
struct Field {
  std::string name;
  Shape shape;  // rows first
  bool at_nodes = false;
};

/// The group of a solid in the file.
struct Fields {
  std::string folder;  // without slashes at the ends
  std::size_t n_nodes = 0;
  std::size_t n_cells = 0;
  std::vector<double> times = {};
  std::vector<Field> fields = {};
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string joined(const Shape& shape) {
  std::string text;
  for (const std::size_t extent : shape) text += (text.empty() ? "" : " ") + std::to_string(extent);
  return text;
}

/// A curve that turns back, as past a limit point, is numbered instead: readers sort by time.
void make_rising(std::vector<double>& times) {
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end()) return;
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i);
}

/// All groups with cells and rows whose path begins with `prefix`.
std::vector<Fields> fields_below(const hdf5::File& file, const std::string& prefix) {
  std::vector<Fields> all;
  const std::vector<std::string> paths = file.data_sets();
  for (const std::string& path : paths) {
    if (!path.starts_with(prefix + "solids/") || !path.ends_with("/cells")) continue;
    Fields one{.folder = path.substr(0, path.size() - 6)};
    one.n_cells = file.data_set(path).shape()[0];
    one.n_nodes = file.data_set(one.folder + "/reference").shape()[0];
    for (const std::string& other : paths) {
      if (!other.starts_with(one.folder + "/") || !file.data_set(other).grows()) continue;
      const hdf5::DataSet set = file.data_set(other);
      if (file.attribute(other, "axis")) {
        one.times = set.read();
      } else {
        const auto located = file.attribute(other, "located");
        one.fields.push_back({.name = other.substr(one.folder.size() + 1),
                              .shape = set.shape(),
                              .at_nodes = located == AttributeValue(std::string("at the nodes"))});
      }
    }
    make_rising(one.times);
    if (!one.times.empty()) all.push_back(std::move(one));
  }
  return all;
}

class Writer {
 public:
  explicit Writer(std::string file) : file_(std::move(file)) {}

  std::string text(const std::vector<Fields>& all, const std::string& drawn) {
    text_ = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n";
    for (const Fields& fields : all) {
      ++collection_;
      const std::string name = fields.folder.substr(fields.folder.rfind('/') + 1);
      text_ +=
          base::format("    <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", escaped(name));
      for (std::size_t row = 0; row < fields.times.size(); ++row) add_grid(fields, name, row);
      text_ += "    </Grid>\n";
    }
    return text_ + drawn + "  </Domain>\n</Xdmf>\n";
  }

 private:
  void add_grid(const Fields& fields, const std::string& name, std::size_t row) {
    text_ += base::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n        <Time Value=\"{}\"/>\n",
                          escaped(name), fields.times[row]);
    text_ += base::format("        <Topology TopologyType=\"Hexahedron\" NumberOfElements=\"{}\">\n", fields.n_cells);
    add_whole(fields.folder + "/cells", {fields.n_cells, 8}, "Int");
    text_ += "        </Topology>\n        <Geometry GeometryType=\"XYZ\">\n";
    const auto is_position = [](const Field& field) { return field.name == "position"; };
    const auto position = std::find_if(fields.fields.begin(), fields.fields.end(), is_position);
    if (position != fields.fields.end()) {
      // By reference: ParaView complains about a geometry that is cut out of a data set, though it reads it.
      text_ +=
          base::format("          <DataItem Reference=\"XML\">/Xdmf/Domain/Grid[{}]/Grid[{}]/DataItem</DataItem>\n",
                       collection_, row + 1);
      text_ += "        </Geometry>\n";
      add_row(fields.folder + "/position", position->shape, row);
    } else {
      add_whole(fields.folder + "/reference", {fields.n_nodes, 3}, "Float");
      text_ += "        </Geometry>\n";
    }
    for (const Field& field : fields.fields) {
      if (is_position(field)) continue;
      begin_attribute(field.name, type_of(field), field.at_nodes);
      add_row(fields.folder + "/" + field.name, field.shape, row);
      text_ += "        </Attribute>\n";
    }
    if (position != fields.fields.end()) {
      begin_attribute("reference", "Vector", true);
      add_whole(fields.folder + "/reference", {fields.n_nodes, 3}, "Float");
      text_ += "        </Attribute>\n";
      begin_attribute("displacement", "Vector", true);
      text_ += base::format("          <DataItem ItemType=\"Function\" Function=\"$0 - $1\" Dimensions=\"{} 3\">\n",
                            fields.n_nodes);
      add_row(fields.folder + "/position", position->shape, row);
      add_whole(fields.folder + "/reference", {fields.n_nodes, 3}, "Float");
      text_ += "          </DataItem>\n        </Attribute>\n";
    }
    text_ += "      </Grid>\n";
  }

  /// Six components stay a plain matrix: ParaView shows their order, xx, yy, zz, xy, yz, zx, by itself; that of XDMF's
  /// Tensor6 is another.
  static const char* type_of(const Field& field) {
    if (field.shape.size() == 2) return "Scalar";
    return field.shape[2] == 3 ? "Vector" : "Matrix";
  }

  void begin_attribute(const std::string& name, const char* type, bool at_nodes) {
    text_ += base::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n", escaped(name), type,
                          at_nodes ? "Node" : "Cell");
  }

  void add_whole(const std::string& path, const Shape& shape, const char* type) {
    text_ += base::format(
        "          <DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"8\" Dimensions=\"{}\">{}:/{}</DataItem>\n",
        type, joined(shape), escaped(file_), path);
  }

  /// One row of a data set made of rows.
  void add_row(const std::string& path, const Shape& shape, std::size_t row) {
    const Shape value(shape.begin() + 1, shape.end());
    Shape selection(3 * shape.size(), 0);  // start, stride, count
    selection[0] = row;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      selection[shape.size() + i] = 1;
      selection[2 * shape.size() + i] = i == 0 ? 1 : shape[i];
    }
    text_ += base::format("          <DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\">\n", joined(value));
    text_ += base::format("            <DataItem Format=\"XML\" NumberType=\"Int\" Dimensions=\"3 {}\">{}</DataItem>\n",
                          shape.size(), joined(selection));
    text_ += base::format(
        "            <DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
        "Dimensions=\"{}\">{}:/{}</DataItem>\n",
        joined(shape), escaped(file_), path);
    text_ += "          </DataItem>\n";
  }

  std::string file_;
  std::string text_;
  std::size_t collection_ = 0;
};

void write_file(const std::filesystem::path& path, const std::string& text) {
  base::refuse_special_output(path.string());
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) throw base::EnvironmentError("cannot write '" + path.string() + "'");
}

}  // namespace

std::vector<std::string> write_xdmf(const std::string& result_path, const Drawing& drawing) {
  const std::filesystem::path result(result_path);
  const hdf5::File file = hdf5::File::open(result_path, hdf5::Access::read);
  std::vector<std::string> written;
  for (const std::string& prefix : {std::string(), std::string("statics/")}) {
    const std::vector<Fields> all = fields_below(file, prefix);
    const std::string drawn = drawing_grids(file, drawing, prefix);
    if (all.empty() && drawn.empty()) continue;
    std::filesystem::path path = result;
    path.replace_extension(written.empty() ? ".xdmf" : ".statics.xdmf");
    write_file(path, Writer(result.filename().string()).text(all, drawn));
    written.push_back(path.string());
  }
  return written;
}

}  // namespace muldi::results
