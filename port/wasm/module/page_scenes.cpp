// The scenes of a page, compiled with the house flags.
#include "page_scenes.hpp"

#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::page::Held>;
template class crankloop::Engine<double, crankloop::page::Held>;
template class crankloop::Engine<float, crankloop::page::HeldBreathing>;
template class crankloop::Engine<double, crankloop::page::HeldBreathing>;
template class crankloop::Engine<float, crankloop::page::Free>;
template class crankloop::Engine<double, crankloop::page::Free>;
template class crankloop::Engine<float, crankloop::page::FreeBreathing>;
template class crankloop::Engine<double, crankloop::page::FreeBreathing>;
