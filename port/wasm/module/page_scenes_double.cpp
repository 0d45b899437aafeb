// The scenes of a page in double, compiled with the house flags.
#include "page_scenes.hpp"

#include <crankloop/tick/step.hpp>

template class crankloop::Engine<double, crankloop::page::Held>;
template class crankloop::Engine<double, crankloop::page::HeldBreathing>;
template class crankloop::Engine<double, crankloop::page::Free>;
template class crankloop::Engine<double, crankloop::page::FreeBreathing>;
