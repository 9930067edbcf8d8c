/// What failed runs say to people; whole messages of the program are compared in tests/unit/app/test_failures.py.
#include "pipeline/advice.hpp"

#include <gtest/gtest.h>

namespace muldi::pipeline {
namespace {

using variational::Status;

TEST(Advice, EveryFailureOfTheNumericsSaysWhyAndWhatToTry) {
  for (const Status status :
       {Status::no_convergence, Status::loss_of_equilibrium, Status::muscle_collapse, Status::inverted_element,
        Status::breakdown, Status::step_too_large, Status::rank_change, Status::infeasible, Status::iteration_limit}) {
    for (const Task task :
         {Task::statics, Task::dynamics, Task::explicit_dynamics, Task::optimal_control, Task::replay}) {
      const Advice advice = advice_on(status, task);
      EXPECT_FALSE(advice.meaning.empty()) << variational::name_of(status);
      EXPECT_FALSE(advice.remedy.empty()) << variational::name_of(status);
      EXPECT_FALSE(advice.meaning.ends_with('.') || advice.remedy.ends_with('.')) << variational::name_of(status);
    }
  }
}

TEST(Advice, EndsThatAreNoFailureNeedNone) {
  for (const Status status : {Status::running, Status::completed, Status::interrupted, Status::write_error}) {
    EXPECT_TRUE(advice_on(status, Task::dynamics).meaning.empty()) << variational::name_of(status);
  }
}

TEST(Advice, OfTheSameStatusDependsOnTheTask) {
  EXPECT_NE(advice_on(Status::step_too_large, Task::dynamics).meaning,
            advice_on(Status::step_too_large, Task::explicit_dynamics).meaning);
  EXPECT_EQ(
      advice_on(Status::no_convergence, Task::optimal_control).remedy,
      "a stage {minimise: {feasibility: 1}} first, another guess (a simulation, random starts), or a smaller step");
}

}  // namespace
}  // namespace muldi::pipeline
