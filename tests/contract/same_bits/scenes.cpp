#include "scenes.hpp"

#include <crankloop/tick/step.hpp>

namespace crankloop {

template class Engine<float, Everything>;
template class Engine<double, Everything>;
template class Engine<float, TorqueOnly>;
template class Engine<double, TorqueOnly>;
template class Engine<float, MeasuredPhaseAndPressure>;
template class Engine<double, MeasuredPhaseAndPressure>;
template class Engine<float, ElasticValves>;
template class Engine<double, ElasticValves>;

}  // namespace crankloop
