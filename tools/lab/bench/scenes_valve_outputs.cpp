// The benchmark's scenes: eight valves with their forces, and with the record of their cycles.
#include <crankloop/tick/step.hpp>

#include "scenes.hpp"

template class crankloop::Engine<float, crankloop::program::bench::FourElasticForces>;
template class crankloop::Engine<float, crankloop::program::bench::FourElasticResults>;
