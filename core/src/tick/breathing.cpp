// The ready-made scene Breathing, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::Breathing>;
template class crankloop::Engine<double, crankloop::scenes::Breathing>;
