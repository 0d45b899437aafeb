// The ready-made scene TorqueByTable, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::TorqueByTable>;
template class crankloop::Engine<double, crankloop::scenes::TorqueByTable>;
