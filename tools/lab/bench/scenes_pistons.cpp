// The benchmark's scenes: four cylinders without valves.
#include <crankloop/tick/step.hpp>

#include "scenes.hpp"

template class crankloop::Engine<float, crankloop::program::bench::FourTorque>;
template class crankloop::Engine<float, crankloop::program::bench::FourMotion>;
template class crankloop::Engine<double, crankloop::program::bench::FourMotion>;
template class crankloop::Engine<float, crankloop::program::bench::FourForces>;
