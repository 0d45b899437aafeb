// The ready-made scene MeasuredMotion, compiled with the house flags.
#include <crankloop/scenes.hpp>
#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::scenes::MeasuredMotion>;
template class crankloop::Engine<double, crankloop::scenes::MeasuredMotion>;
