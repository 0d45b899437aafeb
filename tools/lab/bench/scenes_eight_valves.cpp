// The benchmark's scenes: four cylinders, two valves each.
#include <crankloop/tick/step.hpp>

#include "scenes.hpp"

template class crankloop::Engine<float, crankloop::program::bench::FourElastic<2>>;
template class crankloop::Engine<double, crankloop::program::bench::FourElastic<2>>;
template class crankloop::Engine<float, crankloop::program::bench::FourFollowing<2>>;
template class crankloop::Engine<float, crankloop::program::bench::FourTorqueElastic>;
