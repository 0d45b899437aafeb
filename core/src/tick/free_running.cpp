// The ready-made scene FreeRunning, compiled with the house flags.
#include <crankloop/tick/step.hpp>
#include <crankloop/scenes.hpp>

template class crankloop::Engine<float, crankloop::scenes::FreeRunning>;
template class crankloop::Engine<double, crankloop::scenes::FreeRunning>;
