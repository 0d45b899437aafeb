// The subcommands. To add one: write commands/NAME.cpp that defines its Command, declare that below, and add it
// to the list in all_commands.cpp:
//
//     constexpr Option kOptions[] = {number("--rpm", "N", above(0).up_to(100000), "engine speed in rpm")};
//     int run_forces(const Arguments& arguments) { ... return kSuccess; }
//     const Command kForces{"forces", "forces of one cylinder over the cycle", "FILE --rpm N [...]",
//                           "crankloop forces diesel_495.ini --rpm 2000 --csv forces.csv", 1, kOptions, run_forces};
#pragma once

#include <vector>

#include "arguments.hpp"

namespace crankloop::program {

/// Of this program, in the order in which its help lists them; the first gives the example. all_commands.cpp has them
/// all, table_commands.cpp those of the program that crankloop_add_scene builds to make its tables.
const std::vector<const Command*>& commands();

extern const Command kBalance;
extern const Command kBench;
extern const Command kCam;
extern const Command kFmu;
extern const Command kForces;
extern const Command kKinematics;
extern const Command kLift;
extern const Command kLive;
extern const Command kMap;
extern const Command kMasses;
extern const Command kNew;
extern const Command kPack;
extern const Command kPage;
extern const Command kRedline;
extern const Command kRun;
extern const Command kTables;
extern const Command kShow;
extern const Command kStress;
extern const Command kStudy;
extern const Command kValve;

}  // namespace crankloop::program
