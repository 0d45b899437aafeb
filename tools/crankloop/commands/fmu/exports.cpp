// The functions of an FMU of `crankloop fmu`: one shared object for each scene and arithmetic, which the build names as
// CRANKLOOP_FMU_SCENE and CRANKLOOP_FMU_REAL.
#include <crankloop/scenes.hpp>

#include "engine_source.hpp"

namespace crankloop::fmi {
using ExportedSupply = program::FileSupply<CRANKLOOP_FMU_REAL, scenes::CRANKLOOP_FMU_SCENE>;
}  // namespace crankloop::fmi

#include <crankloop/fmi/fmi2_exports.inc>
#include <crankloop/fmi/fmi3_exports.inc>

#ifdef __GLIBCXX__
// The C++ library's emergency memory for exceptions: this object has its own copy.
namespace __gnu_cxx {
void __freeres();
}  // namespace __gnu_cxx
[[gnu::destructor]] static void free_exceptions_memory() { __gnu_cxx::__freeres(); }
#endif
