// crankloop: crank-resolved engine mechanics in real time. This is what a user includes.
//
//     define    ->   tabulate   ->   tick
//     (structs)      (set-up time)    (real time)
#pragma once

#include <crankloop/define/engine_definition.hpp>
#include <crankloop/engine.hpp>
#include <crankloop/scenes.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/state/saved_state.hpp>
