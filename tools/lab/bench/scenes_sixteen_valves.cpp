// The benchmark's scenes: four cylinders, four different valves each.
#include <crankloop/tick/step.hpp>

#include "scenes.hpp"

template class crankloop::Engine<float, crankloop::program::bench::FourElastic<4>>;
template class crankloop::Engine<double, crankloop::program::bench::FourElastic<4>>;
