// The ready-made scene FreeRunning, compiled with the house flags.
#include <crankloop/tick/engine_step.hpp>
#include <crankloop/tick/scenes.hpp>

template class crankloop::Engine<float, crankloop::scenes::FreeRunning>;
template class crankloop::Engine<double, crankloop::scenes::FreeRunning>;
