#include "results/xdmf_drawing.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "base/text.hpp"

namespace muldi::results {
namespace {

constexpr std::size_t max_frames = 250;
constexpr int digits = 7;

struct Motion {
  std::vector<double> position;       // rows of 3
  std::vector<double> orientation;    // rows of 3 x 3, directors as columns
  std::vector<double> velocity = {};  // rows of 3; empty in statics
};

/// A scalar of a line, row by row.
struct LineField {
  std::string name;
  std::vector<std::vector<double>> values = {};  // by line
};

std::vector<std::size_t> frames_of(std::size_t n_rows) {
  const std::size_t stride = std::max<std::size_t>(1, (n_rows + max_frames - 2) / (max_frames - 1));
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < n_rows; row += stride) rows.push_back(row);
  if (!rows.empty() && rows.back() != n_rows - 1) rows.push_back(n_rows - 1);
  return rows;
}

void append(std::string& text, const DrawnVector& v) {
  for (const double value : v) text += base::number_text(value, digits) + " ";
}

class Grids {
 public:
  Grids(const hdf5::File& file, const Drawing& drawing, std::string prefix)
      : file_(file), drawing_(drawing), prefix_(std::move(prefix)) {
    const std::string axis = prefix_.empty() ? "time" : prefix_ + "load";
    if (!file_.contains(axis)) return;
    times_ = file_.data_set(axis).read();
    n_rows_ = times_.size();
    for (const DrawnBody& body : drawing_.bodies) motions_.push_back(motion_of(prefix_ + "bodies/" + body.name + "/"));
  }

  std::string text() {
    std::map<std::string, std::vector<const DrawnLine*>> families;
    for (const DrawnLine& line : drawing_.lines) {
      if (has_rows(line)) families[line.folder.substr(0, line.folder.find('/'))].push_back(&line);
    }
    for (const auto& [family, lines] : families) read_fields(family, lines);
    // Rows of all sets that a running file already holds.
    const std::vector<std::size_t> rows = frames_of(n_rows_);
    if (rows.empty()) return {};
    number_turning_curve();
    if (!motions_.empty()) add_collection("bodies", rows, [&](std::size_t row) { add_bodies(row); });
    for (const auto& [family, lines] : families) {
      add_collection(family, rows, [&, &name = family, &all = lines](std::size_t row) { add_lines(name, all, row); });
    }
    return std::move(text_);
  }

 private:
  std::vector<double> rows_of(const std::string& path, std::size_t width) {
    if (!file_.contains(path)) return {};
    std::vector<double> values = file_.data_set(path).read();
    n_rows_ = std::min(n_rows_, values.size() / width);
    return values;
  }

  Motion motion_of(const std::string& folder) {
    Motion motion{.position = rows_of(folder + "position", 3), .orientation = rows_of(folder + "orientation", 9)};
    if (prefix_.empty()) motion.velocity = rows_of(folder + "velocity", 3);
    return motion;
  }

  bool has_rows(const DrawnLine& line) const { return file_.contains(prefix_ + line.folder + "/length"); }

  /// The scalars that all lines of a family have.
  void read_fields(const std::string& family, const std::vector<const DrawnLine*>& lines) {
    const std::string first = prefix_ + lines.front()->folder;
    for (const std::string& path : file_.data_sets(first)) {
      const std::string name = path.substr(path.rfind('/') + 1);
      const hdf5::DataSet set = file_.data_set(path);
      if (!set.grows() || set.shape().size() != 1 || file_.attribute(path, "axis")) continue;
      const bool shared = std::all_of(lines.begin() + 1, lines.end(), [&](const DrawnLine* line) {
        return file_.contains(prefix_ + line->folder + "/" + name);
      });
      if (!shared) continue;
      LineField field{.name = name};
      for (const DrawnLine* line : lines) field.values.push_back(rows_of(prefix_ + line->folder + "/" + name, 1));
      fields_[family].push_back(std::move(field));
    }
  }

  /// A curve that turns back, as past a limit point, is numbered instead: readers sort by time.
  void number_turning_curve() {
    if (std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>()) == times_.end()) return;
    for (std::size_t i = 0; i < times_.size(); ++i) times_[i] = static_cast<double>(i);
  }

  DrawnVector placed(const DrawnPoint& point, std::size_t row) const {
    if (point.body < 0) return point.at;
    const Motion& motion = motions_[static_cast<std::size_t>(point.body)];
    DrawnVector world{};
    for (std::size_t i = 0; i < 3; ++i) {
      world[i] = motion.position[3 * row + i];
      for (std::size_t k = 0; k < 3; ++k) world[i] += motion.orientation[9 * row + 3 * i + k] * point.at[k];
    }
    return world;
  }

  template <class AddFrame>
  void add_collection(const std::string& name, const std::vector<std::size_t>& rows, const AddFrame& add_frame) {
    text_ += base::format("    <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", name);
    for (const std::size_t row : rows) {
      text_ += base::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n        <Time Value=\"{}\"/>\n", name,
                            times_[row]);
      add_frame(row);
      text_ += "      </Grid>\n";
    }
    text_ += "    </Grid>\n";
  }

  void begin_item(const char* type, const std::string& dimensions) {
    text_ +=
        base::format("<DataItem Format=\"XML\" NumberType=\"{}\" Precision=\"8\" Dimensions=\"{}\">", type, dimensions);
  }

  void begin_attribute(const std::string& name, const char* type, const std::string& dimensions) {
    text_ += base::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Cell\">", name, type);
    begin_item("Float", dimensions);
  }

  void add_bodies(std::size_t row) {
    const std::size_t n = motions_.size();
    text_ += base::format("        <Topology TopologyType=\"Hexahedron\" NumberOfElements=\"{}\">", n);
    begin_item("Int", base::format("{} 8", n));
    for (std::size_t i = 0; i < 8 * n; ++i) text_ += std::to_string(i) + " ";
    text_ += "</DataItem></Topology>\n        <Geometry GeometryType=\"XYZ\">";
    begin_item("Float", base::format("{} 3", 8 * n));
    for (std::size_t body = 0; body < n; ++body) add_corners(static_cast<int>(body), row);
    text_ += "</DataItem></Geometry>\n";
    begin_attribute("body", "Scalar", std::to_string(n));
    for (std::size_t body = 0; body < n; ++body) text_ += std::to_string(body) + " ";
    text_ += "</DataItem></Attribute>\n";
    if (!prefix_.empty()) return;
    begin_attribute("velocity", "Vector", base::format("{} 3", n));
    for (const Motion& motion : motions_) {
      append(text_, {motion.velocity[3 * row], motion.velocity[3 * row + 1], motion.velocity[3 * row + 2]});
    }
    text_ += "</DataItem></Attribute>\n";
  }

  void add_corners(int body, std::size_t row) {
    // Around the lower face, then around the upper one.
    static constexpr double signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                           {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
    const DrawnBody& box = drawing_.bodies[static_cast<std::size_t>(body)];
    for (const auto& sign : signs) {
      DrawnPoint corner{.body = body, .at = box.centre};
      for (std::size_t i = 0; i < 3; ++i) corner.at[i] += sign[i] * box.half[i];
      append(text_, placed(corner, row));
    }
  }

  void add_lines(const std::string& family, const std::vector<const DrawnLine*>& lines, std::size_t row) {
    const std::size_t n = lines.size();
    text_ +=
        base::format("        <Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"{}\">", n);
    begin_item("Int", base::format("{} 2", n));
    for (std::size_t i = 0; i < 2 * n; ++i) text_ += std::to_string(i) + " ";
    text_ += "</DataItem></Topology>\n        <Geometry GeometryType=\"XYZ\">";
    begin_item("Float", base::format("{} 3", 2 * n));
    for (std::size_t i = 0; i < n; ++i) add_ends(family, *lines[i], i, row);
    text_ += "</DataItem></Geometry>\n";
    for (const LineField& field : fields_[family]) {
      begin_attribute(field.name, "Scalar", std::to_string(n));
      for (std::size_t i = 0; i < n; ++i) text_ += base::number_text(field.values[i][row], digits) + " ";
      text_ += "</DataItem></Attribute>\n";
    }
  }

  void add_ends(const std::string& family, const DrawnLine& line, std::size_t index, std::size_t row) {
    if (!line.isolated) {
      for (const DrawnPoint& end : line.ends) append(text_, placed(end, row));
      return;
    }
    const auto& fields = fields_[family];
    const auto length =
        std::find_if(fields.begin(), fields.end(), [](const LineField& field) { return field.name == "length"; });
    for (const double side : {-0.5, 0.5}) {
      DrawnVector end = line.axis;
      for (double& value : end) value *= side * length->values[index][row];
      append(text_, end);
    }
  }

  const hdf5::File& file_;
  const Drawing& drawing_;
  std::string prefix_;
  std::vector<double> times_;
  std::size_t n_rows_ = 0;
  std::vector<Motion> motions_;
  std::map<std::string, std::vector<LineField>> fields_;
  std::string text_;
};

}  // namespace

std::string drawing_grids(const hdf5::File& file, const Drawing& drawing, const std::string& prefix) {
  if (drawing.empty()) return {};
  return Grids(file, drawing, prefix).text();
}

}  // namespace muldi::results
