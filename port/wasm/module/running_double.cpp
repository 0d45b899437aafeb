// Engines of a page in double, a part of the module by itself (double_part.cmake).
#include "running_scene.hpp"

namespace crankloop::page {

template std::unique_ptr<Running> start_running<double>(const program::EngineFile&, const StartRequest&);
template HashedRun hash_held_run<double>(const program::EngineFile&, const program::Operation&, int);
template HashedRun hash_free_run<double>(const program::EngineFile&, const StartRequest&, double);

}  // namespace crankloop::page
