// The scenes of a page in float, compiled with the house flags.
#include "page_scenes.hpp"

#include <crankloop/tick/step.hpp>

template class crankloop::Engine<float, crankloop::page::Held>;
template class crankloop::Engine<float, crankloop::page::HeldBreathing>;
template class crankloop::Engine<float, crankloop::page::Free>;
template class crankloop::Engine<float, crankloop::page::FreeBreathing>;
