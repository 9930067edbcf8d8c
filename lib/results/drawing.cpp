#include "results/drawing.hpp"

#include "base/text.hpp"

namespace muldi::results {
namespace {

std::string json(const DrawnVector& v) {
  return "[" + base::number_text(v[0]) + ", " + base::number_text(v[1]) + ", " + base::number_text(v[2]) + "]";
}

std::string json(const DrawnPoint& point) {
  return base::format("{{\"body\": {}, \"at\": {}}}", point.body, json(point.at));
}

// Names are those of scenes, which need no escapes.
std::string json(const DrawnBody& body) {
  return base::format("{{\"name\": \"{}\", \"centre\": {}, \"half\": {}}}", body.name, json(body.centre),
                      json(body.half));
}

std::string json(const DrawnLine& line) {
  return base::format(R"({{"folder": "{}", "ends": [{}, {}], "radius": {}, "isolated": {}, "axis": {}}})", line.folder,
                      json(line.ends[0]), json(line.ends[1]), base::number_text(line.radius), line.isolated,
                      json(line.axis));
}

std::string json(const DrawnJoint& joint) {
  return base::format(R"({{"name": "{}", "type": "{}", "at": {}}})", joint.name, joint.type, json(joint.at));
}

template <class T>
std::string list(const std::vector<T>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const T& value : values) texts.push_back(json(value));
  return "[" + base::joined(texts, ",\n  ") + "]";
}

}  // namespace

std::string to_json(const Drawing& drawing) {
  return base::format("{{\"bodies\": {},\n\"lines\": {},\n\"joints\": {}}}\n", list(drawing.bodies),
                      list(drawing.lines), list(drawing.joints));
}

}  // namespace muldi::results
