// The ready-made scene BreathingFree, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::BreathingFree>;
template class crankloop::Engine<double, crankloop::scenes::BreathingFree>;
