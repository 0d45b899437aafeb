// The scenes of `live`, compiled with the house flags.
#include "live_scenes.hpp"

#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::program::LiveRunning>;
template class crankloop::Engine<double, crankloop::program::LiveRunning>;
template class crankloop::Engine<float, crankloop::program::LiveBreathing>;
template class crankloop::Engine<double, crankloop::program::LiveBreathing>;
