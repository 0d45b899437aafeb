// The benchmark's scenes: one valve.
#include <crankloop/tick/step.hpp>

#include "scenes.hpp"

template class crankloop::Engine<float, crankloop::program::bench::LoneElastic>;
template class crankloop::Engine<double, crankloop::program::bench::LoneElastic>;
template class crankloop::Engine<float, crankloop::program::bench::LoneFollowing>;
template class crankloop::Engine<double, crankloop::program::bench::LoneFollowing>;
