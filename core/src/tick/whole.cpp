// The ready-made scene Whole, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::Whole>;
template class crankloop::Engine<double, crankloop::scenes::Whole>;
