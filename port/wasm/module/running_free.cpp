// Engines whose gas, friction, starter and load turn the crank.
#include "running_scene.hpp"

namespace crankloop::page {

std::unique_ptr<Running> start_free(const program::EngineFile& file, const StartRequest& request) {
  return program::breathes(file.definition()) ? running_of<FreeBreathing>(file, request)
                                              : running_of<Free>(file, request);
}

std::unique_ptr<Running> start_running(const program::EngineFile& file, const StartRequest& request) {
  return request.crank_is_free ? start_free(file, request) : start_held(file, request);
}

}  // namespace crankloop::page
