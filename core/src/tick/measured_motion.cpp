// The ready-made scene MeasuredMotion, compiled with the house flags.
#include <crankloop/tick/engine_step.hpp>
#include <crankloop/tick/scenes.hpp>

template class crankloop::Engine<float, crankloop::scenes::MeasuredMotion>;
template class crankloop::Engine<double, crankloop::scenes::MeasuredMotion>;
