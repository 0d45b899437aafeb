// The ready-made scene TorqueByPressure, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::TorqueByPressure>;
template class crankloop::Engine<double, crankloop::scenes::TorqueByPressure>;
