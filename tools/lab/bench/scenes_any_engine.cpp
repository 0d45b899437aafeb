// The benchmark's scenes: any number of cylinders and valves.
#include <crankloop/tick/step.hpp>

#include "scenes.hpp"

template class crankloop::Engine<float, crankloop::program::bench::AnyMotion>;
template class crankloop::Engine<float, crankloop::program::bench::AnyElastic>;
