#include "pipeline/loop_sentence.hpp"

#include "base/text.hpp"

namespace muldi::pipeline {

std::string loop_sentence(const variational::LoopResult& result, const scene::Scene& scene) {
  if (result.status != variational::Status::breakdown || result.t_of_breach == result.t) return result.sentence;
  return base::format("in the step to t = {:.6g} {} {}", result.t_of_breach, scene.units.time(), result.sentence);
}

}  // namespace muldi::pipeline
