#include "commands.hpp"

namespace crankloop::program {

const std::vector<const Command*>& commands() {
  static const std::vector<const Command*> all = {&kShow,    &kMasses, &kKinematics, &kForces, &kBalance, &kLift,  &kValve,
                                                  &kRedline, &kRun,    &kLive,       &kBench,  &kStress,  &kTables};
  return all;
}

}  // namespace crankloop::program
