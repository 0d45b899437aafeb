// The ready-made scene FreeRunning, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::FreeRunning>;
template class crankloop::Engine<double, crankloop::scenes::FreeRunning>;
