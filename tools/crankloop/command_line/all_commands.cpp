#include "commands.hpp"

namespace crankloop::program {

const std::vector<const Command*>& commands() {
  static const std::vector<const Command*> all = {
      &kShow, &kNew, &kMasses, &kKinematics, &kForces, &kBalance, &kLift, &kCam,   &kValve,  &kRedline,
      &kRun,  &kMap, &kStudy,  &kLive,       &kTables, &kFmu,     &kPage, &kBench, &kStress, &kPack};
  return all;
}

}  // namespace crankloop::program
