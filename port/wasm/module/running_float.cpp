// Engines of a page in float.
#include "running_scene.hpp"

namespace crankloop::page {

template std::unique_ptr<Running> start_running<float>(const program::EngineFile&, const StartRequest&);
template HashedRun hash_held_run<float>(const program::EngineFile&, const program::Operation&, int);
template HashedRun hash_free_run<float>(const program::EngineFile&, const StartRequest&, double);

}  // namespace crankloop::page
